//! Flight models in DAVE-ML (AIAA S-119): read, checked against their own check cases, computed without a heap.
//!
//! For whoever has the aerodynamics, the engine or the control law of an aircraft as a `.dml` file and wants to fly it.
//! The subset is that of tables on grids and formulas: header, variables with MathML, breakpoints, gridded tables,
//! functions and check cases. What is outside is refused with its place; nothing is dropped in silence. Not for
//! ungridded tables, splines, statistics of uncertainty, or files in several parts.
//!
//! ```
//! let text = r#"<DAVEfunc xmlns="http://daveml.org/2010/DAVEML">
//!   <fileHeader name="lift"><creationDate date="2026-01-01"/></fileHeader>
//!   <variableDef name="angleOfAttack" varID="alpha" units="deg"><isInput/></variableDef>
//!   <variableDef name="liftCoefficient" varID="CL" units="nd">
//!     <calculation><math xmlns="http://www.w3.org/1998/Math/MathML">
//!       <apply><times/><cn>0.1</cn><ci>alpha</ci></apply>
//!     </math></calculation><isOutput/>
//!   </variableDef>
//! </DAVEfunc>"#;
//! let reading = fspid_daveml::read(text)?;
//! let mut outputs = [0.0];
//! reading.model.evaluate(&[5.0], &mut outputs)?;
//! assert_eq!(outputs, [0.5]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The same bits on every machine
//! Formulas and tables are computed in the order of the file by the arithmetic of `fspid-fuzzy`: nothing fused,
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
