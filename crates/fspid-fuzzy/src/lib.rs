//! Fuzzy inference for controllers that fly: no heap, no panic, the same bits everywhere.
//!
//! The crate answers one question: given an error and its change, by how much should the three
//! gains of a PID controller move? [`Supervisor`] holds the rule base (seven Gaussian sets on each
//! input, seven triangular sets on each output, 49 rules) and answers with the **exact** centroid;
//! the sampled centroids of other tools are there by name ([`Defuzzifier`]) for comparison. Instead of
//! labels the rules may conclude numbers ([`NumberTable`], [`Supervisor::of_numbers`]).
//!
//! The feature `batch` adds `Supervisor::infer_many`: the same bits for arrays of inputs, with the
//! vectors of the machine. It needs `std`; without it the crate depends on `fspid-numeric` alone.
//!
//! It knows nothing of time, plants or files: the self-tuning law is in `fspid-core`, the reading
//! of rule tables from files in `fspid-study`.
//!
//! ```
//! use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
//!
//! let raise_with_error = "
//!     NB NB NB NB NB NB NB
//!     NM NM NM NM NM NM NM
//!     NS NS NS NS NS NS NS
//!     ZO ZO ZO ZO ZO ZO ZO
//!     PS PS PS PS PS PS PS
//!     PM PM PM PM PM PM PM
//!     PB PB PB PB PB PB PB";
//! let table = RuleTable::parse([raise_with_error; 3])?;
//! let supervisor = Supervisor::new(&table, 5.0_f64, Defuzzifier::Exact, OutOfRange::Clamp)?;
//! let answer = supervisor.infer(0.0, 1.0)?;
//! assert!(answer.delta.kp.abs() < 1e-15);
//! # Ok::<(), fspid_fuzzy::FuzzyError>(())
//! ```
#![no_std]
#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

#[cfg(feature = "alloc")]
pub mod audit;
#[cfg(feature = "batch")]
mod batch;
mod centroid;
mod consequents;
mod defuzzifier;
mod error;

#[cfg(feature = "alloc")]
pub mod formula;
pub mod hedge;
#[cfg(feature = "alloc")]
pub mod karnik_mendel;
mod label;

pub mod membership;
pub mod norm;
mod number_table;

mod rule_table;

mod supervisor;
#[cfg(feature = "alloc")]
pub mod system;

#[cfg(feature = "batch")]
pub use batch::{Answers, BatchError};
pub use defuzzifier::{Defuzzifier, MAX_SAMPLES};
pub use error::FuzzyError;
#[cfg(feature = "alloc")]
pub use formula::{Formula, FormulaError, FormulaErrorKind};
pub use hedge::Hedge;
pub use label::{LABEL_COUNT, Label};
pub use norm::{SNormKind, TNormKind};
pub use number_table::{NumberGrid, NumberTable};

pub use rule_table::{Grid, GridError, Output, RuleTable};

pub use supervisor::{Increments, Inference, InferenceError, OutOfRange, Supervisor};
