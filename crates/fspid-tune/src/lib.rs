//! Tuning: from a scenario whose free numbers are marked to a design, and from designs to a fair contest.
//!
//! ```text
//! scenario with marks ─candidates▶ studies ─fly▶ measures ─objective▶ costs ─optimiser▶ design
//! ```
//!
//! A search depends on the scenario, the optimiser, its budget and its seed alone: neither threads nor an
//! interruption show in what it finds.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod anfis;
pub mod rule;
