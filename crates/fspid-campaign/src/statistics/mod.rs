//! What many numbers say: quantiles, probabilities, ranks and shares, with how sure that is.
//!
//! Pure functions on columns of numbers. They take finite values: [`finite`], [`finite_pairs`] and [`Sorted`] leave NaN and
//! infinities out and count them, so that a report can say how many runs a figure rests on. A function that is given one
//! all the same has no answer (`None`), never a wrong one.
//!
//! Every statement of confidence assumes **independent runs**, each drawn from the same distributions. Runs from a Latin
//! hypercube or a low-discrepancy sequence are not independent: for means and probabilities the statements usually err on the wide
//! side, which is not proven; for shares of the variance see [`share::Classes::share_of`].
//!
//! The same column gives the same bits on every machine: sums run in the order of the rows, elementary functions come from
//! `libm`.

pub mod beta;
pub mod binomial;
mod error;
mod exact;
mod finite;
pub mod histogram;
pub mod moments;
mod ordered;
pub mod quantile;
pub mod rank;
pub mod share;
pub mod sketch;
mod sorted;
mod sum;
mod tail;

pub use error::StatisticsError;
pub use finite::{Finite, FinitePairs, finite, finite_pairs};
pub use histogram::Histogram;
pub use moments::Moments;
pub use ordered::Ordered;
pub use sketch::Sketch;
pub use sorted::Sorted;
