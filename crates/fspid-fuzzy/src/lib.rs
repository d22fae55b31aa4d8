#![doc = include_str!("../README.md")]
//!
//! Instead of labels the rules may conclude numbers ([`NumberTable`], [`Supervisor::of_numbers`]), and a small neural
//! network may stand in the place of rules ([`Network`], [`Supervisor::of_network`]).
//!
//! | feature | adds | needs |
//! | --- | --- | --- |
//! | `alloc` | general systems, formulas, audits, type 2 | `alloc` |
//! | `batch` | `Supervisor::infer_many`: the same bits for arrays of inputs, with the vectors of the machine | `std` |
//!
//! Without them the crate depends on `fspid-numeric` and `libm` alone. Not here: time, plants, files. The self-tuning
//! law is in `fspid-core`, the formats of other tools in `fspid-formats`.
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
mod inference;
#[cfg(feature = "alloc")]
pub mod karnik_mendel;
mod label;

pub mod membership;
mod network;
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
pub use inference::{Increments, Inference, InferenceError};
pub use label::{LABEL_COUNT, Label};
pub use network::{LARGEST_WEIGHT, Network, NetworkRow, UNITS};
pub use norm::{SNormKind, TNormKind};
pub use number_table::{NumberGrid, NumberTable};

pub use rule_table::{Grid, GridError, Output, RuleTable};

pub use supervisor::{OutOfRange, RANGE_LIMITS_F32, Supervisor, SupervisorNumbers};
