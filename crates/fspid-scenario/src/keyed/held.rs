//! What keys may hold, and how readers get it.

use std::convert::Infallible;

use fspid_diagnostics::Span;
use fspid_fuzzy::{Defuzzifier, Grid, NumberGrid};

use super::document::Item;
use super::section::{Checked, Section};
use super::word::Word;

/// The type of what a key holds.
pub(crate) trait Held: 'static {
    /// As a reader gets it: the value, or where that is large a reference.
    type Got<'a>;
    /// What states a default; nothing does where a key of this type has none.
    type Default: Copy + Sync;

    /// What a checked value holds, if it is of this type.
    fn got(value: &Checked) -> Option<Self::Got<'_>>;

    /// A default as if it had been written.
    fn checked(_default: Self::Default) -> Option<Checked> {
        None
    }
}

impl Held for f64 {
    type Got<'a> = Self;
    type Default = Self;

    fn got(value: &Checked) -> Option<Self> {
        if let Checked::Number(number) = value { Some(*number) } else { None }
    }

    fn checked(default: Self) -> Option<Checked> {
        Some(Checked::Number(default))
    }
}

impl Held for i64 {
    type Got<'a> = Self;
    type Default = Self;

    fn got(value: &Checked) -> Option<Self> {
        if let Checked::Integer(integer) = value { Some(*integer) } else { None }
    }

    fn checked(default: Self) -> Option<Checked> {
        Some(Checked::Integer(default))
    }
}

impl Held for bool {
    type Got<'a> = Self;
    type Default = Self;

    fn got(value: &Checked) -> Option<Self> {
        if let Checked::Boolean(boolean) = value { Some(*boolean) } else { None }
    }

    fn checked(default: Self) -> Option<Checked> {
        Some(Checked::Boolean(default))
    }
}

impl Held for str {
    type Got<'a> = &'a Self;
    type Default = &'static Self;

    fn got(value: &Checked) -> Option<&Self> {
        if let Checked::Text(text) = value { Some(text) } else { None }
    }

    fn checked(default: &'static Self) -> Option<Checked> {
        Some(Checked::Text(default.to_owned()))
    }
}

/// The check let the words of the key pass alone, and these are the type's.
impl<W: Word> Held for W {
    type Got<'a> = Self;
    type Default = Self;

    fn got(value: &Checked) -> Option<Self> {
        Self::from_word(str::got(value)?)
    }

    fn checked(default: Self) -> Option<Checked> {
        str::checked(default.word())
    }
}

/// Numbers with their places.
impl Held for [f64] {
    type Got<'a> = &'a [(f64, Span)];
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Self::Got<'_>> {
        if let Checked::Numbers(numbers) = value { Some(numbers) } else { None }
    }
}

/// The two numbers of an interval.
impl Held for (f64, f64) {
    type Got<'a> = Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Self> {
        match *<[f64]>::got(value)? {
            [(lower, _), (upper, _)] => Some((lower, upper)),
            _ => None,
        }
    }
}

impl Held for Grid {
    type Got<'a> = Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Self> {
        if let Checked::Grid(grid) = value { Some(*grid) } else { None }
    }
}

/// The cells of a grid of numbers with their places, row by row.
impl Held for NumberGrid<f64> {
    type Got<'a> = &'a [(f64, Span)];
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Self::Got<'_>> {
        if let Checked::NumberGrid(cells) = value { Some(cells) } else { None }
    }
}

impl Held for Defuzzifier {
    type Got<'a> = Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Self> {
        if let Checked::Defuzzifier(defuzzifier) = value { Some(*defuzzifier) } else { None }
    }
}

/// A value that its reader checks.
impl Held for Item {
    type Got<'a> = &'a Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<&Self> {
        if let Checked::Item(item) = value { Some(item) } else { None }
    }
}

impl Held for Section {
    type Got<'a> = &'a Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<&Self> {
        if let Checked::Section(section) = value { Some(section) } else { None }
    }
}

impl Held for [Section] {
    type Got<'a> = &'a Self;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<&Self> {
        if let Checked::Sections(sections) = value { Some(sections) } else { None }
    }
}

/// The rules of a supervisor.
pub(crate) enum Rules<'a> {
    /// A name or the path of a file.
    Named(&'a str),
    /// The rules themselves.
    Grids(&'a Section),
}

impl Held for Rules<'static> {
    type Got<'a> = Rules<'a>;
    type Default = Infallible;

    fn got(value: &Checked) -> Option<Rules<'_>> {
        match value {
            Checked::Text(name) => Some(Rules::Named(name)),
            Checked::Section(grids) => Some(Rules::Grids(grids)),
            _ => None,
        }
    }
}
