//! Keys that exclude each other.

use crate::file::document::Member;
use crate::file::report::Report;
use crate::file::section::Section;
use crate::file::spec::{Choice, Way};

/// Exactly one of the ways must be used, and completely.
pub(super) fn check(report: &mut Report, section: &Section, members: &[Member], choice: &Choice) {
    let present = |name: &str| members.iter().find(|member| member.name == name);
    let keys = |way: &'static Way| way.required.iter().chain(way.optional);
    let used: Vec<(&'static Way, &Member)> = choice
        .ways
        .iter()
        .filter_map(|way| keys(way).find_map(|name| present(name)).map(|m| (way, m)))
        .collect();
    match used.as_slice() {
        [] => {
            let allowed = words(choice);
            let message = match choice.ways {
                [first, ..] => format!("missing: {}", way_in_words(first)),
                [] => return,
            };
            report.missing(section.place, &section.path, message, allowed);
        }
        [(way, _)] => {
            let given = keys(way).find(|name| present(name).is_some());
            for name in way.required.iter().filter(|name| present(name).is_none()) {
                let partner = given.copied().unwrap_or_default();
                let message = format!("missing key; it goes with `{partner}`");
                report.missing(section.place, &section.path(name), message, words(choice));
            }
        }
        [(_, first), others @ ..] => {
            for (_, member) in others {
                let path = section.path(&member.name);
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

fn way_in_words(way: &Way) -> String {
    let names: Vec<String> = way
        .required
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    names.join(" with ").replacen(" with ", " with ", 1)
}
