//! The check of a document against its specification; it collects every problem.

mod choice;
mod foreign;
mod grid;
mod hint;
pub(crate) mod number_grid;
mod unit;
mod value;

pub(crate) use grid::grid_text;
pub(crate) use hint::FIXED;
pub(crate) use value::allowed;

use crate::keyed::document::{Item, Member, Value};
use crate::keyed::{Checked, Entry, KeyRow, Section, Table, Variant, join};
use fspid_diagnostics::{Report, Span, excerpt, nearest};

/// Checks a table. What comes back holds the sound values and says whether all were.
pub(crate) fn table(
    report: &mut Report,
    spec: &'static Table,
    item: &Item,
    path: &str,
) -> Option<Section> {
    let Value::Table(members) = &item.value else {
        let found = item.value.type_name();
        let allowed = in_words(spec);
        report.value(item.place, path, format!("expected a table, not {found}"), allowed);
        return None;
    };
    let before = report.count();
    let mut checker = Checker {
        report,
        members,
        section: Section {
            path: path.to_owned(),
            place: item.place,
            spec,
            kind: "",
            entries: Vec::new(),
            sound: false,
        },
    };
    checker.check(spec);
    let mut section = checker.section;
    section.sound = report.count() == before;
    Some(section)
}

struct Checker<'a> {
    report: &'a mut Report,
    members: &'a [Member],
    section: Section,
}

impl<'a> Checker<'a> {
    fn check(&mut self, spec: &'static Table) {
        let mut keys: Vec<KeyRow> = spec.keys().collect();
        let mut choices: Vec<_> = spec.choices.iter().collect();
        if !spec.variants.is_empty() {
            let Some(variant) = self.variant(spec) else {
                // Which other keys belong here is unknown.
                keys.iter().for_each(|key| self.key(*key, &[]));
                return;
            };
            self.section.kind = variant.name;
            keys.extend(variant.table.keys());
            choices.extend(variant.table.choices);
        }
        let meant = self.unknown_keys(spec, &keys);
        for key in &keys {
            self.key(*key, &meant);
        }
        for choice in choices {
            let (report, section) = (&mut *self.report, &self.section);
            choice::check(report, (section, &keys), (self.members, &meant), choice);
        }
    }

    fn member(&self, name: &str) -> Option<&'a Member> {
        self.members.iter().find(|member| member.name == name)
    }

    /// The variant that `kind` names.
    fn variant(&mut self, spec: &'static Table) -> Option<&'static Variant> {
        let known: Vec<&str> = spec.variants.iter().map(|v| v.name).collect();
        let path = join(&self.section.path, "kind");
        let Some(item) = self.member("kind").map(|member| &member.item) else {
            let place = self.section.place;
            let allowed = quoted(&known);
            self.report.missing(place, &path, "missing key", allowed);
            return None;
        };
        let word = value::word(self.report, item, &path, &known, "kind")?;
        spec.variants.iter().find(|variant| variant.name == word)
    }

    /// Reports the keys that are not known; returns those that were probably meant.
    fn unknown_keys(&mut self, spec: &'static Table, keys: &[KeyRow]) -> Vec<&'static str> {
        let mut known: Vec<&'static str> = keys.iter().map(|key| key.name().as_str()).collect();
        if !spec.variants.is_empty() {
            known.insert(0, "kind");
        }
        let mut all_meant = Vec::new();
        for member in self.members {
            let name = member.name.as_str();
            if known.contains(&name) {
                continue;
            }
            if self.report.is_full() {
                self.report.missing(member.place, "", "", "");
                continue;
            }
            let (message, meant) = self.unknown(spec, member, (keys, &known));
            all_meant.extend(meant);
            let path = join(&self.section.path, &excerpt(name));
            self.report.missing(member.place, &path, message, known.join(", "));
        }
        all_meant
    }

    /// What is told of a key that is not known here, and the key that was meant by it.
    fn unknown(
        &self,
        spec: &'static Table,
        member: &Member,
        (keys, known): (&[KeyRow], &[&'static str]),
    ) -> (String, Option<&'static str>) {
        let name = member.name.as_str();
        let within = || hint::in_table(name, keys).map(|path| format!("did you mean `{path}`?"));
        let owners = owners(spec, name);
        if !owners.is_empty() {
            let kind = self.section.kind;
            let near = hint::singular_or_plural(name, keys).map(hint::of_key).or_else(within);
            let near = near.map(|told| format!("; {told}")).unwrap_or_default();
            let owners = quoted_or(&owners);
            return (format!("belongs to kind {owners}, not to kind \"{kind}\"{near}"), None);
        }
        let other_unit = || {
            let found = unit::other_unit(name, &member.item.value, &unit::numbers(keys));
            found.map(|(meant, told)| (Some(meant), told))
        };
        let nearest = || {
            let meant = nearest(name, known)?;
            Some((Some(meant), format!("did you mean `{meant}`?")))
        };
        let told = foreign::of_key(name, self.members, known)
            .or_else(other_unit)
            .or_else(|| within().map(|told| (None, told)))
            .or_else(nearest);
        match told {
            Some((meant, told)) => (format!("unknown key; {told}"), meant),
            None => ("unknown key".to_owned(), None),
        }
    }

    /// Checks a key; one that is there under a mistyped name is not missed as well.
    fn key(&mut self, key: KeyRow, mistyped: &[&str]) {
        let (name, path) = (key.name().as_str(), self.section.path(key.name()));
        let Some(member) = self.member(name) else {
            if !mistyped.contains(&name) {
                self.absent(key, &path);
            }
            return;
        };
        if let Some(value) = value::check(self.report, key.kind(), &member.item, &path) {
            let place = value_place(member);
            self.put(key, place, value, true);
        }
    }

    fn absent(&mut self, key: KeyRow, path: &str) {
        if let Some(value) = key.default() {
            self.put(key, self.section.place, value, false);
        } else if key.is_required() {
            let allowed = value::allowed(key.kind());
            self.report.missing(self.section.place, path, "missing key", allowed);
        }
    }

    fn put(&mut self, key: KeyRow, place: Span, value: Checked, given: bool) {
        let name = key.name();
        self.section.entries.push(Entry { name, place, value, given });
    }
}

/// The place of the value; that of the key where the value is a table without a place of its own.
fn value_place(member: &Member) -> Span {
    let place = member.item.place;
    if place.end > place.start { place } else { member.place }
}

/// The kinds of the table that have a key of this name.
fn owners(spec: &'static Table, name: &str) -> Vec<&'static str> {
    let has = |variant: &&Variant| variant.table.keys().any(|key| key.name().as_str() == name);
    spec.variants.iter().filter(has).map(|v| v.name).collect()
}

/// What a table holds.
pub(super) fn in_words(spec: &Table) -> String {
    if !spec.variants.is_empty() {
        let kinds: Vec<&str> = spec.variants.iter().map(|v| v.name).collect();
        return format!("a table whose `kind` is one of {}", quoted(&kinds));
    }
    let names: Vec<&str> = spec.keys().map(|key| key.name().as_str()).collect();
    format!("a table of {}", names.join(", "))
}

/// Words in quotes, the last after "or".
fn quoted_or(words: &[&str]) -> String {
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or \"{last}\"", quoted(rest)),
        _ => quoted(words),
    }
}

/// Words in quotes, joined by commas.
pub(crate) fn quoted(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    quoted.join(", ")
}
