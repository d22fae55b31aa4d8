//! Arbitrary lines as overrides of a scenario, as `--set` takes them: refused by name, or the same study twice.

use fspid_scenario::file::parse;

const SCENARIO: &str = include_str!("../../scenarios/campaign.toml");

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let set: Vec<String> = std::str::from_utf8(bytes).ok()?.lines().map(str::to_owned).collect();
    match parse(SCENARIO, "fuzz.toml", None, &set) {
        Ok(study) => {
            let again = parse(SCENARIO, "fuzz.toml", None, &set).expect("the same overrides");
            assert_eq!(again.digest, study.digest);
            Some(())
        }
        Err(problems) => {
            assert!(!problems.to_string().is_empty());
            None
        }
    }
}
