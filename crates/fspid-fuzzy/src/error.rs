//! What can be wrong with a fuzzy system before it is built.

use core::fmt;

use crate::defuzzifier::Defuzzifier;
use crate::inference::InferenceError;
use crate::rule_table::{GridError, Output};

/// Why a supervisor could not be built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FuzzyError {
    /// The half range of the variables is not a finite positive number.
    Range {
        /// What was given.
        found: f64,
    },
    /// A parameter of a membership function is not allowed.
    Parameter {
        /// Its name.
        name: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A membership function with too few or too many parameters.
    ParameterCount {
        /// The kind of membership function.
        shape: &'static str,
        /// How many were given.
        found: usize,
        /// How many it has.
        expected: usize,
        /// True if any multiple of that many would do.
        repeats: bool,
    },
    /// A sampled centroid with too few or too many samples.
    SampleCount {
        /// What was given.
        found: u32,
        /// Fewest allowed.
        least: u32,
        /// Most allowed.
        most: u32,
    },
    /// A word that names no defuzzifier.
    UnknownDefuzzifier,
    /// A rule grid that cannot be read.
    Grid {
        /// Which of the three grids.
        output: Output,
        /// What is wrong in it.
        error: GridError,
    },
    /// A number of a [`NumberTable`](crate::NumberTable) that is not finite or beyond the range.
    Number {
        /// Which of the three grids.
        output: Output,
        /// Row of the cell, from 1.
        row: usize,
        /// Its column, from 1.
        column: usize,
        /// What was given.
        found: f64,
        /// Largest magnitude that is allowed.
        allowed: f64,
    },
    /// A weight of a [`Network`](crate::Network) that is not finite or too large.
    Weight {
        /// Which of the six rows.
        row: &'static str,
        /// Number of the hidden unit, from 1.
        unit: usize,
        /// What was given.
        found: f64,
        /// Largest magnitude that is allowed.
        allowed: f64,
    },
    /// A supervisor's input that cannot be answered.
    Inference(InferenceError),
}

impl fmt::Display for FuzzyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range { found } => write!(
                f,
                "range is {found:?}; allowed is a finite number above 0, at least 1e-100 and at most 1e100"
            ),
            Self::Parameter { name, found, allowed } => {
                write!(f, "{name} is {found:?}; allowed is {allowed}")
            }
            Self::ParameterCount { shape, found, expected, repeats: false } => {
                write!(f, "{shape} has {found} parameters; allowed are {expected}")
            }
            Self::ParameterCount { shape, found, expected, repeats: true } => {
                write!(f, "{shape} has {found} parameters; allowed is a multiple of {expected}")
            }
            Self::SampleCount { found, least, most } => {
                write!(f, "{found} samples for a centroid; allowed are {least} to {most}")
            }
            Self::UnknownDefuzzifier => {
                write!(f, "unknown defuzzifier; known are {}", Defuzzifier::NAMES)
            }
            Self::Grid { output, error } => write!(f, "{}: {error}", output.name()),
            Self::Number { output, row, column, found, allowed } => write!(
                f,
                "{}: the number in row {row}, column {column} is {found:?}; allowed is -{allowed:?} to {allowed:?}",
                output.name()
            ),
            Self::Weight { row, unit, found, allowed } => write!(
                f,
                "{row}: the weight of unit {unit} is {found:?}; allowed is -{allowed:?} to {allowed:?}"
            ),
            Self::Inference(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for FuzzyError {}

impl From<InferenceError> for FuzzyError {
    fn from(error: InferenceError) -> Self {
        Self::Inference(error)
    }
}
