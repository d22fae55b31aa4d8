//! Arbitrary text as a fuzzy system in TOML: refused, or written and read again as itself.

use fspid_scenario::fuzzy_system::{parse, write};

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let system = parse(std::str::from_utf8(bytes).ok()?, "fuzz.toml").ok()?;
    let written = write(system.parts());
    let again = parse(&written, "fuzz.toml").expect("what is written can be read");
    assert_eq!(again.parts(), system.parts());
    Some(())
}
