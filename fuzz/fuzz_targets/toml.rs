//! Arbitrary text as a fuzzy system in TOML: refused, or written and read again as itself.

#![no_main]

use fspid_scenario::fuzzy_system::{parse, write};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(system) = parse(text, "fuzz.toml") {
        let written = write(system.parts());
        let again = parse(&written, "fuzz.toml").expect("what is written can be read");
        assert_eq!(again.parts(), system.parts());
    }
});
