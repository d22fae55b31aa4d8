//! Arbitrary text as a scenario: refused with its problems, or read twice as the same.

#![no_main]

use fspid_scenario::file::parse;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match parse(text, "fuzz.toml", None, &[]) {
        Ok(study) => {
            let again = parse(text, "fuzz.toml", None, &[]).expect("the same text");
            assert_eq!(again.digest, study.digest);
        }
        Err(problems) => assert!(problems.to_string().contains("fuzz.toml")),
    }
});
