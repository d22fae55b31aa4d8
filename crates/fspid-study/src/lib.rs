#![doc = include_str!("../README.md")]
//!
//! ```text
//! Study ─simulate▶ Trace ─measure▶ metrics ─judge▶ verdicts ─render▶ report
//! ```
//!
//! No features. Not here: how a study is read (`fspid-scenario`), many flights (`fspid-campaign`), searches (`fspid-tune`), printing (`fspid-cli`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod aircraft;
pub mod analysis;
pub mod difference;
pub mod export;
pub mod flight;
pub mod fly;
pub mod fuzzy_system;
pub mod inference;
pub mod json;
pub mod judgement;
pub mod memory;
pub mod metrics;
pub mod moment;
pub mod output;
pub mod report;
pub mod rows;
pub mod shell;
pub mod simulation;
pub mod verify;
