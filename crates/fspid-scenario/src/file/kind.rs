//! What a TOML file without anything of a scenario is.

use std::path::Path;

use super::read_text;
use super::spec::AircraftKind;
use crate::keyed::document::{self, Item, Value};
use crate::keyed::word::Word as _;
use fspid_diagnostics::Report;

/// Keys of scenarios, which no other file has.
const OF_SCENARIOS: [&str; 4] = ["controller", "loop", "setpoint", "schema"];

/// An aircraft, and what reads it.
const AIRCRAFT: (&str, &str) = (
    "an aircraft",
    "a scenario, which flies this one by `aircraft = { file = \"…\", … }`; `fspid check FILE` checks it, `fspid aircraft show FILE` tells what is in it",
);

/// Keys by which another kind is known, what it is, and what reads it.
const KINDS: [(&[&str], &str, &str); 3] = [
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
    if has_all(&["geometry", "longitudinal"]) || names_an_aircraft(document) {
        return Some(AIRCRAFT);
    }
    let (_, what, allowed) = KINDS.iter().find(|(keys, ..)| has_all(keys))?;
    Some((what, allowed))
}

/// True for a document that says of which kind of aircraft it is.
fn names_an_aircraft(document: &Item) -> bool {
    let kind = document.member("kind").map(|it| &it.value);
    matches!(kind, Some(Value::Text(word)) if AircraftKind::from_word(word).is_some())
}

/// True for a `.toml` file, or standard input, with an aircraft in it.
#[must_use]
pub fn is_aircraft_file(path: &Path) -> bool {
    let document = |text: String| document::read(&mut Report::default(), None, &text);
    let document = read_text(path).ok().and_then(document);
    document.is_some_and(|it| other(&it) == Some(AIRCRAFT))
}
