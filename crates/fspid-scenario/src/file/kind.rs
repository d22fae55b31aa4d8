//! What a TOML file without anything of a scenario is.

use crate::keyed::document::{Item, Value};

/// Keys of scenarios, which no other file has.
const OF_SCENARIOS: [&str; 4] = ["controller", "loop", "setpoint", "schema"];

/// Keys by which another kind is known, what it is, and what reads it.
const KINDS: [(&[&str], &str, &str); 4] = [
    (
        &["geometry", "longitudinal"],
        "an aircraft",
        "a scenario, which flies this one by `aircraft = { file = \"…\", … }`; `fspid aircraft show FILE` tells what is in it",
    ),
    (
        &["numerator", "denominator"],
        "a plant",
        "a scenario, which flies this one by `plant = { file = \"…\" }`",
    ),
    (
        &["requirement"],
        "a file of requirements",
        "a scenario; `fspid verify SCENARIO --requirements FILE` judges one by these",
    ),
    (
        &["line", "title"],
        "a set of requirements",
        "a scenario, which asks for a ready set by its name: `set = \"…\"` in a `[[requirement]]`",
    ),
];

/// What the document is and what reads it, if it is evidently no scenario.
pub(super) fn other(document: &Item) -> Option<(&'static str, &'static str)> {
    if OF_SCENARIOS.iter().any(|key| document.member(key).is_some()) {
        return None;
    }
    if matches!(&document.value, Value::Table(members) if members.is_empty()) {
        return Some(("an empty file", "a scenario; `fspid init FILE` writes one to begin with"));
    }
    let has_all = |keys: &[&str]| keys.iter().all(|key| document.member(key).is_some());
    let (_, what, allowed) = KINDS.iter().find(|(keys, ..)| has_all(keys))?;
    Some((what, allowed))
}
