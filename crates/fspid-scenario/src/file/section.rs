//! A table of the file after the check: every value of the right kind, defaults filled in.

use fspid_fuzzy::{Defuzzifier, Grid};

use crate::file::document::Item;
use crate::file::spec::word::Word;
use fspid_diagnostics::Span;

/// A checked table.
#[derive(Debug)]
pub(crate) struct Section {
    /// Path in the file.
    pub(crate) path: String,
    /// Where it begins.
    pub(crate) place: Span,
    /// Its kind, if it has kinds; empty otherwise.
    pub(crate) kind: &'static str,
    /// Values by key.
    pub(crate) entries: Vec<Entry>,
    /// Nothing in it was wrong.
    pub(crate) sound: bool,
}

/// A checked value.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) place: Span,
    pub(crate) value: Checked,
    /// Written in the file, not a default.
    pub(crate) given: bool,
}

/// A value of a kind that its key allows.
#[derive(Debug)]
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
    pub(crate) fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// True if the key stands in the file.
    pub(crate) fn given(&self, name: &str) -> bool {
        self.entry(name).is_some_and(|entry| entry.given)
    }

    /// Where the value stands; the table's own place if it does not.
    pub(crate) fn at(&self, name: &str) -> Span {
        self.entry(name).map_or(self.place, |entry| entry.place)
    }

    /// The path of a key.
    pub(crate) fn path(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        match self.entry(name)?.value {
            Checked::Number(number) => Some(number),
            _ => None,
        }
    }

    pub(crate) fn integer(&self, name: &str) -> Option<i64> {
        match self.entry(name)?.value {
            Checked::Integer(integer) => Some(integer),
            _ => None,
        }
    }

    pub(crate) fn boolean(&self, name: &str) -> Option<bool> {
        match self.entry(name)?.value {
            Checked::Boolean(boolean) => Some(boolean),
            _ => None,
        }
    }

    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match &self.entry(name)?.value {
            Checked::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The word of a key, as what it stands for.
    pub(crate) fn word<W: Word>(&self, name: &str) -> Option<W> {
        self.text(name).and_then(known)
    }

    /// The table's kind, as what it stands for.
    pub(crate) fn variant<W: Word>(&self) -> Option<W> {
        known(self.kind)
    }

    /// Numbers with their places.
    pub(crate) fn placed_numbers(&self, name: &str) -> Option<&[(f64, Span)]> {
        match &self.entry(name)?.value {
            Checked::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    pub(crate) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let placed = self.placed_numbers(name)?;
        Some(placed.iter().map(|(number, _)| *number).collect())
    }

    /// The two numbers of an interval.
    pub(crate) fn interval(&self, name: &str) -> Option<(f64, f64)> {
        match *self.placed_numbers(name)? {
            [(lower, _), (upper, _)] => Some((lower, upper)),
            _ => None,
        }
    }

    pub(crate) fn grid(&self, name: &str) -> Option<Grid> {
        match self.entry(name)?.value {
            Checked::Grid(grid) => Some(grid),
            _ => None,
        }
    }

    /// The cells of a grid of numbers with their places, row by row.
    pub(crate) fn number_grid(&self, name: &str) -> Option<&[(f64, Span)]> {
        match &self.entry(name)?.value {
            Checked::NumberGrid(cells) => Some(cells),
            _ => None,
        }
    }

    pub(crate) fn defuzzifier(&self, name: &str) -> Option<Defuzzifier> {
        match self.entry(name)?.value {
            Checked::Defuzzifier(defuzzifier) => Some(defuzzifier),
            _ => None,
        }
    }

    /// A value that its reader checks.
    pub(crate) fn item(&self, name: &str) -> Option<&Item> {
        match &self.entry(name)?.value {
            Checked::Item(item) => Some(item),
            _ => None,
        }
    }

    pub(crate) fn section(&self, name: &str) -> Option<&Self> {
        match &self.entry(name)?.value {
            Checked::Section(section) => Some(section),
            _ => None,
        }
    }

    pub(crate) fn sections(&self, name: &str) -> &[Self] {
        match self.entry(name).map(|entry| &entry.value) {
            Some(Checked::Sections(sections)) => sections,
            _ => &[],
        }
    }
}

/// The check let the words of the specification pass alone, and these are the type's.
fn known<W: Word>(word: &str) -> Option<W> {
    let found = W::from_word(word);
    debug_assert!(found.is_some(), "\"{word}\" is none of {:?}", W::WORDS);
    found
}
