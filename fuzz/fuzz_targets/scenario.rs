//! Arbitrary text as a scenario: refused with its problems, or read twice as the same.

use fspid_scenario::file::parse;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let text = std::str::from_utf8(bytes).ok()?;
    match parse(text, "fuzz.toml", None, &[]) {
        Ok(study) => {
            let again = parse(text, "fuzz.toml", None, &[]).expect("the same text");
            assert_eq!(again.digest, study.digest);
            Some(())
        }
        Err(problems) => {
            assert!(problems.to_string().contains("fuzz.toml"));
            None
        }
    }
}
