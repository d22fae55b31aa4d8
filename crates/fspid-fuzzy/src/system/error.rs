//! What can be wrong with the parts of a system.

use alloc::string::String;
use core::fmt;

use crate::error::FuzzyError;

/// A problem and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemError {
    /// Where, in words: ``input `service`, term `poor` ``.
    pub place: String,
    /// What.
    pub problem: SystemProblem,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SystemProblem {
    /// A system needs at least one.
    Missing {
        /// What: `input`, `output`, `term`, `universe`.
        what: &'static str,
    },
    /// Two things of one kind have the same name.
    Duplicate {
        /// The name.
        name: String,
    },
    /// A name with nothing in it.
    NoName,
    /// A universe whose ends are not finite numbers in ascending order.
    Universe {
        /// Lower end.
        lower: f64,
        /// Upper end.
        upper: f64,
    },
    /// A number that is not allowed.
    Number {
        /// Which.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A position beyond the end of a list.
    Position {
        /// Of what.
        what: &'static str,
        /// What was given.
        found: usize,
        /// How many there are.
        count: usize,
    },
    /// Parameters of a membership function, or the number of samples.
    Fuzzy(FuzzyError),
    /// Something that does not go together.
    Conflict {
        /// What was given.
        what: &'static str,
        /// What it needs.
        needs: &'static str,
    },
    /// An antecedent that is nested too deeply.
    Depth {
        /// Deepest nesting that is allowed.
        most: usize,
    },
    /// More than a system may hold.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are allowed.
        most: usize,
    },
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl fmt::Display for SystemProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { what } => write!(f, "has no {what}; at least one is needed"),
            Self::Duplicate { name } => write!(f, "`{name}` is there twice; names must differ"),
            Self::NoName => f.write_str("has an empty name"),
            Self::Universe { lower, upper } => write!(
                f,
                "the universe is {lower:?} to {upper:?}; allowed are two finite numbers in ascending order"
            ),
            Self::Number { what, found, allowed } => {
                write!(f, "{what} is {found:?}; allowed is {allowed}")
            }
            Self::Position { what, found, count } => {
                write!(f, "{what} number {} is named, but there are {count}", found + 1)
            }
            Self::Fuzzy(error) => error.fmt(f),
            Self::Conflict { what, needs } => write!(f, "{what} needs {needs}"),
            Self::Depth { most } => {
                write!(f, "the antecedent is nested too deeply; allowed are {most} levels")
            }
            Self::TooMany { what, found, most } => {
                write!(f, "{found} {what}; allowed are {most}")
            }
        }
    }
}

impl core::error::Error for SystemError {}

impl From<FuzzyError> for SystemProblem {
    fn from(error: FuzzyError) -> Self {
        Self::Fuzzy(error)
    }
}
