//! Scenarios, fuzzy systems and requirements as text, and what is true of them.
//!
//! ```text
//! text ─read▶ document ─check▶ sections ─build▶ Study: scenario, requirements, dispersions, tuning, warnings
//! ```
//!
//! All problems of a text are told at once, each with its place, what was found and what is allowed. Here degrees
//! become radians and units SI; what is built has no options and no invalid state.
//!
//! ```
//! let text = fspid_scenario::file::starter();
//! let study = fspid_scenario::file::parse(text, "starter.toml", None, &[])?;
//! assert_eq!(study.scenario.controllers.len(), 2);
//! # Ok::<(), fspid_scenario::file::Problems>(())
//! ```
//!
//! Not here: flights, measures of them, and verdicts.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod aircraft;
pub mod dispersion;
pub mod file;
pub mod flyer;
pub mod fuzzy_system;
pub mod measure;
pub mod requirement;
pub mod supervisor;
pub mod tuning;
pub mod units;
