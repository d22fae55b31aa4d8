//! Loops that are bad by construction, shown to everybody who judges: none may be called good.
//!
//! Shared by the tests and by the example of that name, which shows a hundred thousand.

pub(crate) mod bad;

use bad::{Bad, Drawn};
use fspid_campaign::engine;

use fspid_certify::{Certification, Effort};
use fspid_scenario::file::{self, Study};
use fspid_study::analysis::{Analysis, AtRest, Question, Stability};
use fspid_study::metrics::Verdict;
use fspid_study::simulation::Simulation;

/// A proof takes a hundred times what a flight takes: it is looked for in one of so many loops.
const CERTIFY_EVERY: u64 = 100;
/// And of one of more states than this it takes half a minute.
const CERTIFY_STATES: usize = 12;

/// What was shown, and what was said.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Loops.
    pub(crate) loops: u64,
    /// Verdicts on them.
    pub(crate) verdicts: u64,
    /// Of these, those that nobody could decide, and said so.
    pub(crate) undecided: u64,
    /// Loops of each family.
    pub(crate) families: std::collections::BTreeMap<&'static str, u64>,
    /// What was called good, by whom: the scenario with it.
    pub(crate) called_good: Vec<String>,
    /// What was not answered at all.
    pub(crate) refused: Vec<String>,
}

impl Found {
    fn say(&mut self, bad: &Bad, who: &str, is_good: bool) {
        self.verdicts += 1;
        if is_good {
            self.called_good.push(format!("{who}: {}\n{}", bad.family, bad.text));
        }
    }

    fn refuse(&mut self, bad: &Bad, who: &str, reason: &dyn std::fmt::Display) {
        self.refused.push(format!("{who}: {}: {reason}\n{}", bad.family, bad.text));
    }
}

/// Shows so many loops of a seed.
pub(crate) fn battery(seed: u64, count: u64) -> Found {
    let mut found = Found::default();
    for number in 0..count {
        let mut drawn = Drawn(seed.wrapping_mul(0x2545_f491_4f6c_dd1d).wrapping_add(number << 20));
        let bad = bad::any(&mut drawn);
        found.loops += 1;
        *found.families.entry(bad.family).or_default() += 1;
        match file::parse(&bad.text, "bad.toml", None, &[]) {
            Ok(study) => ask(&mut found, &bad, &study, number.is_multiple_of(CERTIFY_EVERY)),
            Err(problems) => found.refuse(&bad, "check", &problems),
        }
    }
    found
}

/// True for a verdict that says nothing is wrong.
fn is_good(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Settled | Verdict::NotSettled { .. } | Verdict::Flown)
}

fn ask(found: &mut Found, bad: &Bad, study: &Study, certifies: bool) {
    fly(found, bad, study);
    campaign(found, bad, study);
    if !bad.at_rest {
        return;
    }
    let question = Question { map_points: 0, ..Question::default() };
    match Analysis::of(study, question) {
        Ok(analysis) => found.say(bad, "analyse", analysis.stability() == Stability::Stable),
        // Of a long way it says so by name.
        Err(fspid_sim::SimError::LongWay { .. }) => found.undecided += 1,
        Err(reason) => found.refuse(bad, "analyse", &reason),
    }
    let fast = Effort { halvings: 0, frozen_points: 5, ..Effort::default() };
    let late = study.scenario.actuator.delay_samples();
    if certifies && late <= CERTIFY_STATES && bad.family != "late sensor" {
        match Certification::of(study, None, &fast) {
            Ok(proofs) => found.say(bad, "certify", proofs.all_proved()),
            Err(reason) => found.refuse(bad, "certify", &reason),
        }
    }
}

fn fly(found: &mut Found, bad: &Bad, study: &Study) {
    let flown = match Simulation::of(study) {
        Ok(flown) => flown,
        Err(reason) => return found.refuse(bad, "simulate", &reason),
    };
    let result = &flown.results[0];
    let undecided = u64::from(is_undecided(&result.at_rest));
    found.undecided += undecided;
    found.say(bad, "simulate", undecided == 0 && is_good(result.verdict()));
    if bad.at_rest {
        found.say(bad, "a requirement", flown.requirements_met());
        found.say(bad, "at rest", result.at_rest.stability_word() == Some("stable"));
    }
}

/// Whether it is said that nobody knows.
fn is_undecided(at_rest: &AtRest) -> bool {
    at_rest.undecided.is_some() || at_rest.not_asked.is_some()
}

fn campaign(found: &mut Found, bad: &Bad, study: &Study) {
    // Side by side with itself: the lanes of a campaign.
    let studies = vec![study.clone(); engine::at_once(study).min(3)];
    for flights in engine::fly(&studies) {
        match flights {
            Ok(flights) => {
                let is_good = flights.iter().all(|flight| !flight.is_failed());
                let undecided = flights.iter().any(|flight| is_undecided(&flight.at_rest));
                found.say(bad, "campaign", is_good && !undecided);
            }
            Err(reason) => found.refuse(bad, "campaign", &reason),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_is_bad_by_construction_is_called_good_by_anybody() {
        let found = battery(20_261_123, 150);
        assert!(found.called_good.is_empty(), "{}", found.called_good.join("\n"));
        assert!(found.refused.is_empty(), "{}", found.refused.join("\n"));
        assert_eq!(found.families.len(), bad::FAMILIES.len(), "{:?}", found.families);
        // What is left open is little: the others are called bad.
        assert!(20 * found.undecided < found.verdicts, "{} {}", found.undecided, found.verdicts);
    }

    /// The limit of what a held command may do to its gains is the closed form's, from both sides: else the family beyond it
    /// would tell nothing. What a step of that size comes to is another question: some swing on.
    #[test]
    fn held_commands_within_the_limit_of_the_closed_form_are_stable() {
        for number in 0..40 {
            let within = bad::held_command_within(&mut Drawn(number));
            let study = file::parse(&within.text, "good.toml", None, &[]).expect("allowed");
            let scenario = &study.scenario;
            let at_rest = AtRest::of(scenario, &scenario.controllers[0].controller);
            assert_eq!(at_rest.stability_word(), Some("stable"), "{}", within.text);
        }
    }

    /// The same questions of a loop that holds, or they would find nothing bad.
    #[test]
    fn a_good_loop_is_called_good_by_everybody() {
        let mut bad = bad::FAMILIES[4](&mut Drawn(1));
        let good = "ki = 0.1";
        let ki =
            bad.text.lines().find(|line| line.starts_with("ki = ")).expect("a gain").to_owned();
        bad.text = bad.text.replace(&ki, good);
        let study = file::parse(&bad.text, "good.toml", None, &[]).expect("allowed");
        let mut found = Found::default();
        ask(&mut found, &bad, &study, true);
        let good = found.called_good.len() as u64;
        assert!(good == found.verdicts && good >= 6, "{good} of {}: {}", found.verdicts, bad.text);
    }
}
