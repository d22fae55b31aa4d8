//! The contests that come with the program: what is tuned on, what designs are chosen by, and what they are judged on.

use fspid_data::AIRCRAFT_CLASSES;
use fspid_scenario::file::{self, Study};
use fspid_scenario::tuning::Case;

use crate::file::repository;

fn contest(name: &str) -> Study {
    file::load(&repository("scenarios/contest").join(name), &[]).expect("no problems")
}

fn trained(study: &Study) -> &[Case] {
    &study.tuning.as_ref().expect("a tuning").cases
}

fn judged(study: &Study) -> &[Case] {
    &study.contest.as_ref().expect("a contest").cases
}

/// What a case changes, in whatever order it is written.
fn changes(case: &Case) -> Vec<&str> {
    let mut changes: Vec<&str> = case.set.iter().map(String::as_str).collect();
    changes.sort_unstable();
    changes
}

/// Names of the aircraft of the cases; every case of these contests names its own.
fn aircraft(cases: &[Case]) -> Vec<&str> {
    let named = |case: &'_ Case| {
        let at = case.set.iter().position(|it| it.starts_with("aircraft.name="));
        at.unwrap_or_else(|| panic!("{} names no aircraft", case.name))
    };
    cases.iter().map(|case| &case.set[named(case)]["aircraft.name=".len()..]).collect()
}

fn assert_apart(name: &str, some: &[Case], others: &[Case]) {
    for case in some {
        let twin = others.iter().find(|other| changes(other) == changes(case));
        let twin = twin.map(|twin| &twin.name);
        assert_eq!(twin, None, "{name}: {} is flown there and here", case.name);
    }
}

/// Fewer would be trained on one kind and judged on the same, which says little about a class.
#[test]
fn the_contests_of_six_train_and_judge_on_all_six_kinds_of_their_class_and_on_no_other() {
    for (name, class) in [
        ("light-six.toml", "light"),
        ("light-six-choose.toml", "light"),
        ("transport-six.toml", "transport"),
        ("transport-six-choose.toml", "transport"),
        ("uav.toml", "uav"),
        ("light-steps.toml", "light"),
        ("transport-steps.toml", "transport"),
        ("uav-steps.toml", "uav"),
        ("light-network.toml", "light"),
        ("uav-network.toml", "uav"),
        ("transport-damped.toml", "transport"),
    ] {
        let study = contest(name);
        let (_, kinds) = AIRCRAFT_CLASSES.iter().find(|it| it.0 == class).expect("a class");
        let kind_of = |aircraft: &str| kinds.iter().position(|kind| kind.contains(&aircraft));
        for cases in [trained(&study), judged(&study)] {
            let mut found: Vec<usize> = aircraft(cases)
                .iter()
                .map(|it| kind_of(it).unwrap_or_else(|| panic!("{name}: {it} is not {class}")))
                .collect();
            found.sort_unstable();
            found.dedup();
            assert_eq!(found.len(), 6, "{name}: kinds {found:?} of {class}");
        }
        assert_apart(name, judged(&study), trained(&study));
    }
}

/// The same training to the last byte is what lets the contest fly designs on the judged set that were chosen on the other one.
#[test]
fn designs_are_chosen_on_cases_that_are_neither_trained_on_nor_judged_on() {
    for class in ["light", "transport"] {
        let name = format!("{class}-six.toml");
        let judge = contest(&name);
        let choose = contest(&format!("{class}-six-choose.toml"));
        assert_eq!(choose.tuning, judge.tuning, "{class}");
        assert_apart(&name, judged(&choose), judged(&judge));
        let before = |name: &str| {
            let text = crate::file::text(&format!("scenarios/contest/{name}"));
            let (_, rest) = text.split_once("schema = 1").expect("a schema");
            rest.split_once("[contest]").expect("a contest").0.to_owned()
        };
        assert_eq!(before(&format!("{class}-six-choose.toml")), before(&name), "{class}");
    }
}

#[test]
fn flights_that_a_proved_design_is_judged_on_were_judged_by_no_other() {
    for (name, before) in [
        ("light-steps.toml", ["light-six.toml", "light-six-choose.toml"]),
        ("transport-steps.toml", ["transport-six.toml", "transport-six-choose.toml"]),
        ("uav-steps.toml", ["uav.toml", "uav-commands.toml"]),
        ("transport-damped.toml", ["transport-six.toml", "transport-six-choose.toml"]),
        ("transport-damped.toml", ["transport-commands.toml", "transport-steps.toml"]),
    ] {
        let judge = contest(name);
        for other in before {
            assert_apart(name, judged(&judge), judged(&contest(other)));
        }
    }
}

/// Eight flights of light aircraft stand in `light-six.toml` too, which nobody chose a network by.
#[test]
fn flights_that_a_network_is_judged_on_are_none_that_it_was_chosen_by() {
    for (name, chosen_by) in [
        ("light-network.toml", ["light-six-choose.toml", "light-steps.toml"]),
        ("uav-network.toml", ["uav-commands.toml", "uav-steps.toml"]),
    ] {
        let judge = contest(name);
        for other in chosen_by {
            assert_apart(name, judged(&judge), judged(&contest(other)));
        }
    }
}
