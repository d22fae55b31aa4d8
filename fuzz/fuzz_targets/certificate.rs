//! Arbitrary text as a certificate: refused, or written and read again as itself. Whether a claim holds is not asked.

#![no_main]

use fspid_study::certify::{from_text, to_text};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok((certificate, origin)) = from_text(text) {
        let written = to_text(&certificate, &origin);
        let (again, origin) = from_text(&written).expect("what is written can be read");
        assert_eq!(to_text(&again, &origin), written);
    }
});
