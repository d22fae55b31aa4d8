//! Arbitrary bytes as packets of MAVLink: every line has a time and finite numbers, and what is remembered is bounded.

use fspid_mavlink::Listener;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let mut listener = Listener::default();
    let told = listener.hear(bytes);
    // Each frame has eight bytes or more.
    assert!(told.len() <= bytes.len() / 8 + 1, "{told:?}");
    let lines: Vec<_> = told.iter().flatten().collect();
    for line in &lines {
        assert!(line.first().is_some_and(|(name, _)| *name == "time_s"), "{line:?}");
        assert!(line.len() <= 32 && line.iter().all(|(_, value)| value.is_finite()), "{line:?}");
    }
    let counts = listener.counts();
    assert!(counts.unused + counts.others + lines.len() as u64 <= counts.frames, "{counts:?}");
    (!lines.is_empty()).then_some(())
}
