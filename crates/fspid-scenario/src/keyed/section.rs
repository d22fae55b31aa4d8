//! A table of the text after the check: every value of the right kind, defaults filled in.

use fspid_diagnostics::{Report, Span};
use fspid_fuzzy::{Defuzzifier, Grid};

use super::document::Item;
use super::held::Held;
use super::key::{Key, KeyName};
use super::table::Table;
use super::word::Word;

/// A checked table.
pub(crate) struct Section {
    /// Path in the file.
    pub(crate) path: String,
    /// Where it begins.
    pub(crate) place: Span,
    /// What it was checked against.
    pub(crate) spec: &'static Table,
    /// Its kind, if it has kinds; empty otherwise.
    pub(crate) kind: &'static str,
    /// Values by key.
    pub(crate) entries: Vec<Entry>,
    /// Nothing in it was wrong.
    pub(crate) sound: bool,
}

/// A checked value.
pub(crate) struct Entry {
    pub(crate) name: KeyName,
    pub(crate) place: Span,
    pub(crate) value: Checked,
    /// Written in the file, not a default.
    pub(crate) given: bool,
}

/// A value of a kind that its key allows.
pub(crate) enum Checked {
    Number(f64),
    Integer(i64),
    Boolean(bool),
    Text(String),
    Numbers(Vec<(f64, Span)>),
    Grid(Grid),
    /// The cells of a grid of numbers, row by row.
    NumberGrid(Vec<(f64, Span)>),
    Defuzzifier(Defuzzifier),
    /// As written; its reader checks it.
    Item(Item),
    Section(Section),
    Sections(Vec<Section>),
}

impl Section {
    pub(crate) fn entry(&self, name: impl Into<KeyName>) -> Option<&Entry> {
        let name = name.into();
        let found = self.entries.iter().find(|entry| entry.name == name);
        debug_assert!(
            found.is_some() || self.spec.all_keys().any(|key| key.name() == name),
            "\"{}\" has no key `{name}`",
            self.spec.doc
        );
        found
    }

    /// What a key holds: what is written, or its default.
    pub(crate) fn get<V: Held + ?Sized>(&self, key: Key<V>) -> Option<V::Got<'_>> {
        let entry = self.entry(key)?;
        let got = V::got(&entry.value);
        debug_assert!(got.is_some(), "{} is of another type", self.path(entry.name));
        got
    }

    /// True if the key stands in the file.
    pub(crate) fn given(&self, name: impl Into<KeyName>) -> bool {
        self.entry(name).is_some_and(|entry| entry.given)
    }

    /// Where the value stands; the table's own place if it does not.
    pub(crate) fn at(&self, name: impl Into<KeyName>) -> Span {
        self.entry(name).map_or(self.place, |entry| entry.place)
    }

    /// The path of a key.
    pub(crate) fn path(&self, name: impl Into<KeyName>) -> String {
        join(&self.path, name.into().as_str())
    }

    /// Reports what is wrong with the value of a key, which is told as well.
    pub(crate) fn wrong(
        &self,
        report: &mut Report,
        key: impl Into<KeyName>,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) {
        let key = key.into();
        report.value(self.at(key), &self.path(key), message, allowed);
    }

    /// Reports what is wrong at a key, whose value would not explain it.
    pub(crate) fn problem(
        &self,
        report: &mut Report,
        key: impl Into<KeyName>,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) {
        let key = key.into();
        report.missing(self.at(key), &self.path(key), message, allowed);
    }

    /// The table's kind, as what it stands for.
    pub(crate) fn variant<W: Word>(&self) -> Option<W> {
        W::from_word(self.kind)
    }

    /// What the table calls itself; empty where it has no name.
    pub(crate) fn own_name(&self) -> &str {
        let name = self.entries.iter().find(|entry| entry.name.as_str() == "name");
        name.and_then(|entry| str::got(&entry.value)).unwrap_or_default()
    }

    /// The numbers of a list, without their places.
    pub(crate) fn numbers(&self, key: Key<[f64]>) -> Option<Vec<f64>> {
        Some(self.get(key)?.iter().map(|(number, _)| *number).collect())
    }

    /// The tables of a list; none where it is left out.
    pub(crate) fn sections(&self, key: Key<[Self]>) -> &[Self] {
        self.get(key).unwrap_or_default()
    }
}

/// The path of a name in a table.
pub(crate) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}
