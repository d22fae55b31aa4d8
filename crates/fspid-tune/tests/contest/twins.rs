//! Cases that fly the same are evidence once.

use fspid_tune::contest::Options;

use super::{marked, place};

/// Fourteen copies of a case made a winner of whom nobody was.
#[test]
fn copies_of_a_case_are_refused_however_they_are_written() {
    let copy = "\n[[contest.case]]\nname = \"copy\"\nset = [\"setpoint.amplitude_deg=2.00\"]\n";
    let told = place(&(marked() + copy)).refused(&Options::default());
    let expected = "case \"copy\" flies what case \"2 deg\" flies, and would count twice";
    assert!(told.contains(expected), "{told}");
}

/// A limit that never acts, moved, is another scenario and the same flight; so is what is written with a delay that a
/// controller was tuned on. Twelve of them made a winner with p = 0.0005.
#[test]
fn cases_that_are_flown_alike_are_evidence_once_and_those_of_the_tuning_never() {
    let idle = |place: usize| {
        format!(
            "\n[[contest.case]]\nname = \"idle {place}\"\nset = [\"setpoint.amplitude_deg=1.0\", \"actuator.position_limit_deg={}\"]\n",
            40 + place
        )
    };
    let trained =
        "\n[[contest.case]]\nname = \"trained\"\nset = [\"actuator.position_limit_deg=90.0\"]\n";
    let text = marked() + &idle(0) + &idle(1) + &idle(2) + trained;
    let held = place(&text).held();
    let judged = &held.judged;
    let at = |name: &str| judged.cases.iter().position(|it| it.name == name).expect("a case");
    assert_eq!(judged.twin_of[at("idle 0")], None);
    assert_eq!(judged.twin_of[at("idle 1")], Some(at("idle 0")));
    assert_eq!(judged.twin_of[at("idle 2")], Some(at("idle 0")));
    assert_eq!(judged.trained_as[at("trained")].as_deref(), Some("as written"));
    assert_eq!(judged.trained_as[at("idle 0")], None);
    let said = held.text();
    assert!(said.contains("\"idle 1\" as \"idle 0\""), "{said}");
    assert!(said.contains("\"trained\" as \"as written\" of the tuning"), "{said}");
    // The ratio is that of the contest without them.
    let alone = place(&(marked() + &idle(0))).held();
    let ratio = |outcome: &fspid_tune::contest::Outcome| outcome.comparison(1).map(|it| it.ratio);
    assert_eq!(ratio(&held), ratio(&alone));
}

/// Five seeds of one candidate each are the start, five times.
#[test]
fn seeds_that_find_the_same_are_one_tuning_and_nobody_wins() {
    let once = marked().replace("budget = 24", "budget = 1");
    let held = place(&once).held();
    assert!(held.judged.is_tuned_once());
    let said = held.text();
    assert!(said.starts_with("every seed found the same: no winner can be named"), "{said}");
}
