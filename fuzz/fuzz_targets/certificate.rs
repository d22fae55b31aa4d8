//! Arbitrary text as a certificate: refused, or written and read again as itself. Whether a claim holds is not asked.

use fspid_certify::{from_text, to_text};

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let (certificate, origin) = from_text(std::str::from_utf8(bytes).ok()?).ok()?;
    let written = to_text(&certificate, &origin);
    let (again, origin) = from_text(&written).expect("what is written can be read");
    assert_eq!(to_text(&again, &origin), written);
    Some(())
}
