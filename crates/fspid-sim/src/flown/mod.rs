//! Analysis by simulation: empirical stability margins, and linearisation along a flown trajectory.
//!
//! [`empirical`] asks how much gain, delay and phase lag the flown scenario bears, by bisection in the
//! simulation itself: with every limit at work and with gains that move. [`trajectory`] linearises a
//! flown loop at every sample, with the derivatives of the gains. Neither proves anything beyond the
//! flight that was flown.

pub mod empirical;
mod holding;
mod ladder;
mod perturbation;
pub mod trajectory;

pub use holding::{Criterion, Envelope, Failure};
pub use ladder::Margin;
pub(crate) use perturbation::CommandPath;
pub use perturbation::{AllPass, Perturbation};
