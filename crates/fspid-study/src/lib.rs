//! Studies of a closed loop: from the text of a scenario to verdicts and reports.
//!
//! ```text
//! text ─parse▶ document ─validate▶ Study ─simulate▶ Trace ─measure▶ metrics ─judge▶ verdicts ─render▶ report
//! ```
//!
//! One function per verb; the edges (command line, later Python and the browser) contain no formula.
//! Only this crate knows TOML, JSON and HTML, and only here do degrees become radians and back.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod aircraft;
pub mod analysis;
pub mod certify;
pub mod fly;
pub mod fuzzy_system;
pub mod inference;
pub mod judgement;
pub mod metrics;
pub mod output;
pub mod report;
pub mod rows;
pub mod shell;
pub mod simulation;
pub mod verify;
