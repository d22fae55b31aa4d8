//! Keys that exclude each other.

use super::value;
use crate::keyed::document::Member;
use crate::keyed::{Choice, KeyName, KeyRow, Section, Way, join};
use fspid_diagnostics::Report;

/// Exactly one of the ways must be used, and completely; keys that were meant by other names are not missed.
pub(super) fn check(
    report: &mut Report,
    (section, known): (&Section, &[KeyRow]),
    (members, meant): (&[Member], &[&str]),
    choice: &Choice,
) {
    let is_meant = |name: &&KeyName| meant.contains(&name.as_str());
    let present = |name: &KeyName| members.iter().find(|member| member.name == name.as_str());
    let keys = |way: &'static Way| way.required.iter().chain(way.optional);
    let used: Vec<(&'static Way, &Member)> = choice
        .ways
        .iter()
        .filter_map(|way| keys(way).find_map(present).map(|m| (way, m)))
        .collect();
    match used.as_slice() {
        [] => match choice.ways.iter().find(|way| keys(way).any(|name| is_meant(&name))) {
            Some(way) => {
                let given = keys(way).find(is_meant);
                let missing = way.required.iter().filter(|name| !is_meant(name));
                incomplete(report, (section, known), given, missing);
            }
            None => report.missing(section.place, &section.path, "a key is missing", words(choice)),
        },
        [(way, _)] => {
            let given = keys(way).find(|name| present(name).is_some());
            let is_missing = |name: &&KeyName| present(name).is_none() && !is_meant(name);
            let missing = way.required.iter().filter(is_missing);
            incomplete(report, (section, known), given, missing);
        }
        [(_, first), others @ ..] => {
            for (_, member) in others {
                let path = join(&section.path, &member.name);
                let message = format!("not together with `{}`", first.name);
                report.missing(member.place, &path, message, words(choice));
            }
        }
    }
}

/// Reports the keys that go with one that is given.
fn incomplete<'a>(
    report: &mut Report,
    (section, known): (&Section, &[KeyRow]),
    given: Option<&KeyName>,
    missing: impl Iterator<Item = &'a KeyName>,
) {
    let partner = given.map_or("", |name| name.as_str());
    for name in missing {
        let message = format!("missing key; it goes with `{partner}`");
        let key = known.iter().find(|key| key.name() == *name);
        let allowed = key.map(|key| value::allowed(key.kind())).unwrap_or_default();
        report.missing(section.place, &section.path(*name), message, allowed);
    }
}

fn words(choice: &Choice) -> String {
    let ways: Vec<String> = choice.ways.iter().map(way_in_words).collect();
    format!("one of: {}", ways.join("; or "))
}

/// `numerator` with `denominator` and `elevator_sign`.
fn way_in_words(way: &Way) -> String {
    let names = way.required.iter().map(|name| format!("`{name}`"));
    let names: Vec<String> = names.collect();
    match names.as_slice() {
        [first, middle @ .., last] => {
            let middle: String = middle.iter().map(|name| format!("{name} and ")).collect();
            format!("{first} with {middle}{last}")
        }
        _ => names.concat(),
    }
}
