//! Keys that exclude each other.

use super::value;
use crate::keyed::document::Member;
use crate::keyed::{Choice, KeyName, KeyRow, Section, Way, join};
use fspid_diagnostics::Report;

/// Exactly one of the ways must be used, and completely.
pub(super) fn check(
    report: &mut Report,
    (section, known): (&Section, &[KeyRow]),
    members: &[Member],
    choice: &Choice,
) {
    let present = |name: &KeyName| members.iter().find(|member| member.name == name.as_str());
    let keys = |way: &'static Way| way.required.iter().chain(way.optional);
    let used: Vec<(&'static Way, &Member)> = choice
        .ways
        .iter()
        .filter_map(|way| keys(way).find_map(present).map(|m| (way, m)))
        .collect();
    match used.as_slice() {
        [] => report.missing(section.place, &section.path, "a key is missing", words(choice)),
        [(way, _)] => {
            let given = keys(way).find(|name| present(name).is_some());
            for name in way.required.iter().filter(|name| present(name).is_none()) {
                let partner = given.map_or("", |name| name.as_str());
                let message = format!("missing key; it goes with `{partner}`");
                let key = known.iter().find(|key| key.name() == *name);
                let allowed = key.map(|key| value::allowed(key.kind()));
                report.missing(
                    section.place,
                    &section.path(*name),
                    message,
                    allowed.unwrap_or_default(),
                );
            }
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
