//! What can be wrong with a formula's text.

use alloc::string::String;
use core::fmt;

use super::{MAX_BYTES, MAX_DEPTH, MAX_PARTS};

/// Why a formula cannot be read, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// Byte at which the wrong thing begins.
    pub position: usize,
    /// What is wrong.
    pub kind: FormulaErrorKind,
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FormulaErrorKind {
    /// A function with too few or too many arguments.
    Arguments {
        /// Its name.
        function: &'static str,
        /// How many were given.
        found: usize,
        /// How many it takes.
        expected: usize,
    },
    /// A character that means nothing.
    Character {
        /// Which.
        found: char,
    },
    /// A name that is neither a variable nor a constant nor a function.
    Name {
        /// As written.
        found: String,
        /// The known ones, with commas.
        known: String,
    },
    /// A number that cannot be read, or is too large.
    Number {
        /// As written.
        found: String,
    },
    /// Nested too deeply.
    TooDeep,
    /// Too long a text.
    TooLong {
        /// Its bytes.
        found: usize,
    },
    /// Too many numbers, variables, operators and functions.
    TooManyParts,
    /// A bracket that is never closed.
    Unclosed,
    /// Something in the wrong place.
    Unexpected {
        /// As written; empty for the end.
        found: String,
        /// What could stand there.
        expected: &'static str,
    },
}

impl FormulaErrorKind {
    pub(super) const fn at(self, position: usize) -> FormulaError {
        FormulaError { position, kind: self }
    }
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at byte {}: {}", self.position, self.kind)
    }
}

impl fmt::Display for FormulaErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Arguments { function, found, expected } => {
                write!(f, "{function} has {found} arguments; expected are {expected}")
            }
            Self::Character { found } => write!(f, "{found:?} means nothing in a formula"),
            Self::Name { found, known } => write!(f, "unknown name {found:?}; known are {known}"),
            Self::Number { found } => write!(f, "{found:?} is not a finite number"),
            Self::TooDeep => write!(f, "nested too deeply; allowed are {MAX_DEPTH} levels"),
            Self::TooLong { found } => write!(f, "{found} bytes; allowed are {MAX_BYTES}"),
            Self::TooManyParts => {
                write!(f, "too many parts; allowed are {MAX_PARTS} numbers, names and operators")
            }
            Self::Unclosed => write!(f, "this bracket is never closed"),
            Self::Unexpected { found, expected } if found.is_empty() => {
                write!(f, "the formula ends; expected is {expected}")
            }
            Self::Unexpected { found, expected } => {
                write!(f, "unexpected {found:?}; expected is {expected}")
            }
        }
    }
}

impl core::error::Error for FormulaError {}
