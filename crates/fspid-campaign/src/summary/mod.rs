//! What a merged campaign says: how often flights fail, how well they fly, and what that depends on.
//!
//! ```text
//! merged file ─Summary::of▶ Summary ─text▶ terminal;  ─json▶ other programs;  ─▶ a page
//! ```
//!
//! A [`Summary`] is plain data: counts, estimates with their confidence, and numbers of runs, so that every
//! statement leads to flights that can be flown again. What it rests on and what it leaves out stands in
//! [`Summary::notes`].
//!
//! # Memory and order
//! Up to [`EXACT_ROWS`] rows are read column by column. Quantiles and their intervals are exact order statistics: 8
//! bytes a row of one column at a time, and of the first [`SENSITIVITY_RUNS`] runs every parameter with its ranks. All
//! sums run in the order of the file: the same file gives the same bits on every machine, with any number of threads.
//!
//! More rows are read once, part by part on all threads, into what adds up: counts, exact sums, and a
//! [`Sketch`](crate::statistics::Sketch) of each column, whose quantiles say how far they may be off. Memory is that
//! of the sketches, some MB a column, whatever the number of rows; the bits do not depend on how the rows are cut.

mod above_chance;
mod data;
mod error;
mod files;
mod flights;
mod json;
mod make;
mod measures;
mod partial;
mod probability;
mod requirements;
mod sensitivity;
mod source;
mod text;
pub mod words;

pub(crate) use above_chance::AboveChance;
pub use data::{
    Bad, ControllerSummary, Extreme, FailedRun, Head, Influence, Limits, MeasureCount,
    MeasureSummary, Note, Parameter, Probability, QuantileSummary, RequirementSummary, Sensitivity,
    SensitivityTarget, Severity, Shards, Sketched, Summary, SummarySettings, VerdictCount,
};
pub use error::{NotMerged, SummaryError};
pub(crate) use files::Files;
pub use json::json;
pub(crate) use source::Found;
pub use text::text;

/// Shares of the flights whose quantiles a summary has.
pub const QUANTILES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];

/// How many lowest and highest values of a measure are named with their runs.
pub const EXTREMES: usize = 5;

/// How many failed runs are named.
pub const FAILED_RUNS: usize = 10;

/// Most rows whose values are sorted for exact quantiles: half a gigabyte a column.
pub const EXACT_ROWS: u64 = 1 << 26;

/// Most runs that sensitivities are computed from: the first of the campaign.
///
/// With so many a rank correlation is sure to ±0.006, a share of the variance to about 0.002; what is less does not
/// matter to an engineer. The first runs, not evenly spaced ones: every second point of a Sobol' sequence lies in
/// the same half of a dimension, while its first 2¹⁷ points are as even as that many points can be. For independent
/// runs and Latin hypercubes, the first are as good as any others.
pub const SENSITIVITY_RUNS: usize = 1 << 17;
