#![doc = include_str!("../README.md")]
//!
//! The subset is that of tables on grids and formulas: header, variables with MathML, breakpoints, gridded tables,
//! functions and check cases. Not for ungridded tables, splines, statistics of uncertainty, or files in several parts.
//! No features.
//!
//! # The same bits on every machine
//! Formulas and tables are computed in the order of the file by the arithmetic of `fspid-numeric`: nothing fused,
//! elementary functions from `libm`.
//!
//! # Source
//! ANSI/AIAA S-119-2011, *Flight Dynamics Model Exchange Standard*; *Dynamic Aerospace Vehicle Exchange Markup Language
//! Reference*, DTD 2.0, daveml.org.
#![warn(clippy::indexing_slicing)]
#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::indexing_slicing,
        reason = "tests ask for exact bits, and a missing element fails the test"
    )
)]

mod compile;
pub mod data;
pub mod document;
mod expression;
mod finding;
pub mod flight;
mod formula;
pub mod jsbsim;
mod model;
mod number;
mod xml;

pub use document::Document;
pub use expression::{Expression, Function, One, Two};
pub use fspid_diagnostics::{Note, Place, Problem, Problems};
pub use model::{Bounds, CheckReport, Deviation, EvaluateError, Model, Port, ShotReport};
pub use number::Number;
pub use xml::{Reading, read};

/// Longest text that is read, bytes.
pub const MAX_INPUT_BYTES: usize = 10 << 20;

/// Deepest nesting of elements that is read.
pub const MAX_DEPTH: usize = 64;

/// Most variables of a model, and most different axes of its tables.
pub const MAX_VARIABLES: usize = 1024;

/// Most axes of a table.
pub const MAX_AXES: usize = 8;

/// Largest magnitude of a number in a file: differences and products of two are finite.
pub const MAX_MAGNITUDE: f64 = 1e100;
