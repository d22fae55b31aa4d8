//! Arbitrary lines of a pitch loop, as `fly` hears them: each command that is told is a finite number.

use fspid_scenario::file::parse;
use fspid_study::fly::{Angles, Pilot, fly};

const SCENARIO: &str = include_str!("../../scenarios/747-pitch-step.toml");

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let study = parse(SCENARIO, "fuzz.toml", None, &[]).expect("a shipped scenario");
    let mut commands = 0;
    for name in ["CPID", "FSPID"] {
        let mut pilot =
            Pilot::new(&study.scenario, Some(name), Angles::Degrees).expect("of the scenario");
        let mut out = Vec::new();
        fly(&mut pilot, &mut &*bytes, &mut out, |_| {}).expect("streams in memory");
        for line in String::from_utf8(out).expect("text").lines().filter(|line| *line != "ok") {
            assert!(line.parse::<f64>().expect("a number").is_finite(), "{line}");
            commands += 1;
        }
    }
    (commands > 0).then_some(())
}
