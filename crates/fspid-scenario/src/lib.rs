#![doc = include_str!("../README.md")]
//!
//! ```text
//! text ─read▶ document ─check▶ sections ─build▶ Study: scenario, requirements, dispersions, tuning, warnings
//! ```
//!
//! No features. Not here: flights, measures of them, and verdicts (`fspid-study`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod aircraft;
pub mod apart;
mod carried;
pub mod count;
pub mod dispersion;
pub mod file;
pub mod flyer;
pub mod fuzzy_system;
mod keyed;
pub mod measure;
mod refused;
mod regular_file;
pub mod requirement;
mod setting_path;
pub mod supervisor;
mod system_text;
pub mod toml_text;
pub mod tuning;
pub mod turned;

pub use fspid_numeric::units;
