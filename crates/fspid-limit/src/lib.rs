#![doc = include_str!("../README.md")]
//!
//! # How it is proved
//! The solver's answer is believed for nothing but numbers. For any multipliers $g_k$ of the errors, $\zeta_k$ of the travel
//! with $|\zeta_k| \le \nu$, and others of rate and stops, every history of commands within a travel $B$ has
//!
//! $$ J \ge \sum_k g_k e_k + \sum_k \zeta_k (y_k - y_{k-1}) - \nu B - \dots $$
//!
//! whose right side is linear in the commands; an adjoint recursion over the enclosed sampled plant gives its coefficients,
//! and each command within its limits makes of its own at least its least product. [`prove`] adds that up in intervals.
//!
//! No features. Not here: files, texts, scenarios.

mod bound;
mod causal;
mod drift;
mod error;
mod history;
mod measure;
mod programme;
mod question;
mod reach;
mod still;
mod travel;

pub use bound::{Multipliers, prove};
pub use causal::{MOST_EVENTS, Planner, Reached};
pub use error::{LimitError, Refusal};
pub use history::{Flown, fly_commands, measured};
pub use measure::Measure;
pub use programme::{Programme, Solution};
pub use question::{Question, SaidBeside};
pub use reach::{Limit, keeps_within, limit};
pub use still::{Assumed, Still};
pub use travel::Travel;
