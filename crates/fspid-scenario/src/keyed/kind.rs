//! What a value may be: as the check knows it ([`Kind`]), and with the type that readers get ([`KindOf`]).

use std::marker::PhantomData;

use fspid_diagnostics::digits::shortest_within;
use fspid_fuzzy::{Defuzzifier, Grid, NumberGrid};
use serde_json::Value;

use super::document::Item;
use super::held::Rules;
use super::section::Section;
use super::table::Table;
use super::word::Word;

/// What a key holds.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Number {
        unit: &'static str,
        range: Range,
    },
    Integer {
        least: i64,
        most: i64,
    },
    Boolean,
    /// Any text that is not empty.
    Text,
    /// Any text, also none at all.
    FreeText,
    /// One of these words.
    Word(&'static [&'static str]),
    /// The name of something that the program carries.
    Preset(fn() -> Vec<&'static str>),
    /// The path of a file.
    Path,
    /// One of some names or a path, or the rules themselves in a table.
    Rules {
        names: fn() -> Vec<&'static str>,
        grids: &'static Table,
    },
    /// A rule grid: seven lines of seven labels.
    Grid,
    /// A grid of numbers: seven lists of seven.
    NumberGrid,
    /// A defuzzifier by name.
    Defuzzifier,
    /// Something that its reader checks: what it may be in words, and its JSON Schema.
    Own {
        allowed: fn() -> String,
        schema: fn() -> Value,
    },
    Numbers {
        unit: &'static str,
        range: Range,
        least: usize,
        most: usize,
    },
    /// A lower and a higher number.
    Interval {
        unit: &'static str,
        range: Range,
    },
    Table(&'static Table),
    Tables {
        table: &'static Table,
        least: usize,
        most: usize,
    },
}

impl Kind {
    /// The unit, empty where there is none.
    pub(crate) const fn unit(&self) -> &'static str {
        match self {
            Self::Number { unit, .. }
            | Self::Numbers { unit, .. }
            | Self::Interval { unit, .. } => unit,
            _ => "",
        }
    }
}

/// Which numbers are allowed. All are finite.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Range {
    Finite,
    Positive,
    NotNegative,
    /// Ends included.
    Between(f64, f64),
    /// Above 0, up to and with the end.
    PositiveUpTo(f64),
    /// From 0 to the end, both included.
    UpTo(f64),
}

impl Range {
    pub(crate) fn contains(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Between(least, most) => (least..=most).contains(&value),
                Self::PositiveUpTo(most) => value > 0.0 && value <= most,
                Self::UpTo(most) => (0.0..=most).contains(&value),
            }
    }

    /// The allowed numbers in words.
    pub(crate) fn words(self, unit: &str) -> String {
        let (of, unit) = match unit {
            "" => (String::new(), String::new()),
            unit => (format!(", in {unit}"), format!(" {unit}")),
        };
        match self {
            Self::Finite => format!("a finite number{of}"),
            Self::Positive => format!("a finite number above 0{of}"),
            Self::NotNegative => format!("a finite number, 0 or above{of}"),
            Self::Between(least, most) => format!("{} to {}{unit}", short(least), short(most)),
            Self::PositiveUpTo(most) => format!("above 0, up to {}{unit}", short(most)),
            Self::UpTo(most) => format!("0 to {}{unit}", short(most)),
        }
    }
}

/// A number for people: without a point where it is whole, with an exponent where it is long.
fn short(value: f64) -> String {
    shortest_within(value, 1e-3..1e7)
}

/// A kind with the type of what it holds.
pub(crate) struct KindOf<V: ?Sized> {
    pub(super) any: Kind,
    of: PhantomData<V>,
}

impl<V: ?Sized> KindOf<V> {
    const fn new(any: Kind) -> Self {
        Self { any, of: PhantomData }
    }
}

/// A number of a range.
pub(crate) const fn number(unit: &'static str, range: Range) -> KindOf<f64> {
    KindOf::new(Kind::Number { unit, range })
}

/// A number of any size.
pub(crate) const fn finite(unit: &'static str) -> KindOf<f64> {
    number(unit, Range::Finite)
}

/// A time or another number, 0 or above.
pub(crate) const fn not_negative(unit: &'static str) -> KindOf<f64> {
    number(unit, Range::NotNegative)
}

/// A number above 0.
pub(crate) const fn positive(unit: &'static str) -> KindOf<f64> {
    number(unit, Range::Positive)
}

/// A whole number.
pub(crate) const fn whole(least: i64, most: i64) -> KindOf<i64> {
    KindOf::new(Kind::Integer { least, most })
}

/// True or false.
pub(crate) const BOOLEAN: KindOf<bool> = KindOf::new(Kind::Boolean);

/// Any text that is not empty.
pub(crate) const TEXT: KindOf<str> = KindOf::new(Kind::Text);

/// Any text, also none at all.
pub(crate) const FREE_TEXT: KindOf<str> = KindOf::new(Kind::FreeText);

/// The path of a file.
pub(crate) const FILE_PATH: KindOf<str> = KindOf::new(Kind::Path);

/// The name of something that the program carries.
pub(crate) const fn carried(names: fn() -> Vec<&'static str>) -> KindOf<str> {
    KindOf::new(Kind::Preset(names))
}

/// One of some names that readers pass on as text.
pub(crate) const fn name_in(names: &'static [&'static str]) -> KindOf<str> {
    KindOf::new(Kind::Word(names))
}

/// A word that stands for a value.
pub(crate) const fn word<W: Word>() -> KindOf<W> {
    KindOf::new(Kind::Word(W::WORDS))
}

/// The rules of a supervisor by name or path, or in grids.
pub(crate) const fn rules(
    names: fn() -> Vec<&'static str>,
    grids: &'static Table,
) -> KindOf<Rules<'static>> {
    KindOf::new(Kind::Rules { names, grids })
}

/// A rule grid: seven lines of seven labels.
pub(crate) const GRID: KindOf<Grid> = KindOf::new(Kind::Grid);

/// A grid of numbers: seven lists of seven.
pub(crate) const NUMBER_GRID: KindOf<NumberGrid<f64>> = KindOf::new(Kind::NumberGrid);

/// A defuzzifier by name.
pub(crate) const DEFUZZIFIER_NAME: KindOf<Defuzzifier> = KindOf::new(Kind::Defuzzifier);

/// Something that its reader checks: what it may be in words, and its JSON Schema.
pub(crate) const fn own(allowed: fn() -> String, schema: fn() -> Value) -> KindOf<Item> {
    KindOf::new(Kind::Own { allowed, schema })
}

/// A list of numbers, and how many.
pub(crate) const fn numbers(
    unit: &'static str,
    range: Range,
    (least, most): (usize, usize),
) -> KindOf<[f64]> {
    KindOf::new(Kind::Numbers { unit, range, least, most })
}

/// A lower and a higher number.
pub(crate) const fn interval(unit: &'static str, range: Range) -> KindOf<(f64, f64)> {
    KindOf::new(Kind::Interval { unit, range })
}

/// A table.
pub(crate) const fn table(table: &'static Table) -> KindOf<Section> {
    KindOf::new(Kind::Table(table))
}

/// A list of tables, and how many.
pub(crate) const fn tables(table: &'static Table, least: usize, most: usize) -> KindOf<[Section]> {
    KindOf::new(Kind::Tables { table, least, most })
}
