#![doc = include_str!("../README.md")]
//!
//! Texts are read in linear time; they are data and never run. What a tool computes is part of what its file means: a
//! system that is read answers by the rule of the tool that the format belongs to (see [`Reading::notes`]).
//!
//! No features. Not here: files and folders, evaluation (`fspid-fuzzy`), and the TOML of this project's own systems
//! (`fspid-scenario`).
#![warn(clippy::indexing_slicing)]
#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::indexing_slicing,
        reason = "tests ask for exact bits where they compare floats, and may panic"
    )
)]

mod adapt;
mod check;
mod cursor;
mod difference;
pub mod fcl;
pub mod fis;
mod fit;
pub mod fll;
pub mod fml;
#[doc(hidden)]
pub mod fuzzing;
mod hedged;
mod identifiers;
mod lexer;
mod loss;
mod names;
mod note;
mod number;
mod repeated;
mod report;
mod rule;
pub mod rule_text;
mod term;
mod tokens;
mod vocabulary;
mod work;

pub use fspid_diagnostics::{Note, Place, Problem, Problems};
pub use note::{MAX_INPUT_BYTES, Reading, WriteOptions, Writing};
