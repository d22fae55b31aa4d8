//! Why nothing was learned.

use fspid_fuzzy::system::{GradientError, InputError, SystemError};
use fspid_scenario::count::CountError;
use thiserror::Error;

/// Why nothing was learned.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AnfisError {
    /// A count beyond its limits.
    #[error("{0}")]
    Count(#[from] CountError),
    /// A table of data that could not be read; each problem with its line.
    #[error("{}", .problems.join("\n"))]
    Table {
        /// What is wrong.
        problems: Vec<String>,
    },
    /// A row of data that does not fit.
    #[error("data row {row} has {found} numbers; {needed} are needed, inputs first")]
    Width {
        /// Which row, counted from 1.
        row: usize,
        /// Its length.
        found: usize,
        /// The length that fits.
        needed: usize,
    },
    /// A number in the data that is not finite.
    #[error("data row {row} holds {found}; every number must be finite")]
    NotFinite {
        /// Which row, counted from 1.
        row: usize,
        /// What it holds.
        found: f64,
    },
    /// No data to learn from, or to judge by.
    #[error("there are no data to {what}; at least one row is needed")]
    NoData {
        /// What they would be for.
        what: &'static str,
    },
    /// A share for validation that leaves no row to learn from.
    #[error(
        "of {rows} row(s) a share of {share} judges, rounded to whole rows all of them, and none is left to learn from; give more rows or a smaller share"
    )]
    AllJudge {
        /// The share of the plan.
        share: f64,
        /// How many rows there are.
        rows: usize,
    },
    /// A system that is wrong.
    #[error("{}", words(.0))]
    System(Vec<SystemError>),
    /// A system whose answers are not linear in what its rules conclude.
    #[error("{place}: {because}; learning needs a system of Takagi and Sugeno, of order 0 or 1")]
    NotSugeno {
        /// Where.
        place: String,
        /// What is different.
        because: &'static str,
    },
    /// An input without a universe where one is needed.
    #[error("input `{input}` has no universe to lay a grid over")]
    NoUniverse {
        /// Its name.
        input: String,
    },
    /// A grid that cannot be laid.
    #[error("the grid has {found:?} points along its inputs; {allowed}")]
    Grid {
        /// What was given.
        found: Vec<usize>,
        /// What is allowed.
        allowed: String,
    },
    /// A row of data at which no rule fires.
    #[error("no rule fires at data row {row}, so that nothing can be learned from it")]
    NotCovered {
        /// Which row, counted from 1 in the data as they were given.
        row: usize,
    },
    /// A row of data that the system refuses.
    #[error("data row {row}: {reason}")]
    Input {
        /// Which row, counted from 1 in the data as they were given.
        row: usize,
        /// Why.
        reason: InputError,
    },
    /// A system whose answers have no derivatives.
    #[error("data row {row}: {reason}")]
    Gradient {
        /// Which row, counted from 1 in the data as they were given.
        row: usize,
        /// Why.
        reason: GradientError,
    },
    /// More numbers to be learned than is sensible.
    #[error("the rules conclude {found} numbers for an output; at most {allowed} can be learned")]
    TooMany {
        /// How many there are.
        found: usize,
        /// How many are allowed.
        allowed: usize,
    },
    /// Data or sets so large that the least squares overflow.
    #[error("the least squares overflow; choose other units")]
    Overflow,
    /// Rows for validation at which the learned system answers beyond the range of numbers.
    #[error(
        "the error of the rows for validation is no finite number in any epoch: the answers there, or the numbers to be answered, are so large that their squares leave the range of 64-bit numbers; choose other units, or look at these rows"
    )]
    Validation {
        /// What was found.
        found: f64,
    },
    /// A setting of the plan that is not allowed.
    #[error("{what} is {found}; allowed is {allowed}")]
    Plan {
        /// Which.
        what: &'static str,
        /// What was found.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
}

fn words(errors: &[SystemError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
