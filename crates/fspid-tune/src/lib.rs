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
pub mod baseline;
pub mod contest;
pub mod design;
mod error;
mod flights;
pub mod history;
mod problem;
pub mod rule;
mod score;
mod search;
mod source;
mod space;
mod tuned;

pub use error::TuneError;
pub use problem::{Problem, controllers_with_marks};
pub use score::{FORBIDDEN, Score};
pub use search::{Effort, Search, State, Trial, stop_in_words};
pub use source::Source;
pub use space::Space;
pub use tuned::{Number, Tuned};
