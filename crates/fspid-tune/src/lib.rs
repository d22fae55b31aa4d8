#![doc = include_str!("../README.md")]
//!
//! ```text
//! scenario with marks ─candidates▶ studies ─fly▶ measures ─objective▶ costs ─optimiser▶ design
//! ```
//!
//! No features. Not here: optimisers, which know no scenario (`fspid-optimise`), and many flights of one
//! design (`fspid-campaign`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod adaptation;
pub mod anfis;
pub mod baseline;
mod bits;
pub mod contest;
mod crew;
pub mod design;
mod draw;
mod error;
mod flights;
mod flyer;
pub mod front;
pub mod history;
mod kept;
pub mod limit;
mod near_limit;
mod own_draws;
mod problem;
pub mod rule;
mod score;
mod sealed;
mod search;
mod slopes;
mod source;
mod space;
mod tuned;
mod written;
mod wrong_cases;

pub use crew::{Crew, Engine, Order, Worker};
pub use error::{TuneError, WrongCase};
pub use fspid_optimise::Stop;
pub use kept::{Beginning, Kept, Then, Unfit};
pub use problem::{TuningProblem, controllers_with_marks};
pub use score::{FORBIDDEN, Score};
pub use search::{AskedEffort, Effort, Search, State, Trial, stop_in_words};
pub use slopes::Counted;
pub use source::Source;
pub use space::Space;
pub use tuned::{Number, Tuned};
pub use written::{NotRight, Written, problems_of_certified};
