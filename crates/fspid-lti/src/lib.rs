#![doc = include_str!("../README.md")]
//!
//! Pure mathematics: no aeroplane, no controller, no file. Not for large systems: matrices are dense and everything is
//! meant for some ten states, sampled loops for up to a hundred where most are those of a dead time. No features.
//!
//! # The same bits on every machine
//! Sums and products are written out in a fixed order, nothing is fused, every elementary function beyond the square
//! root comes from `libm`, and results that are sets (roots, eigenvalues) come sorted. Nothing is random.
//!
//! # Errors
//! Every check is written for the good case, so a NaN is refused like any other bad value. What cannot be computed
//! is a [`LtiError`] that says what was found and what is allowed; nothing here panics on a caller's numbers.

mod balance;
mod ball;
mod complex;
mod delayed;
mod doubled;
mod eigenvalues;
mod error;
mod exponential;
mod fine;
mod frequency;
mod hold;
mod in_words;
mod integral_regulator;
mod matrix;
mod mode;
mod polynomial;
mod regulator;
mod response;
mod roots;
mod sampled;
mod solve;
mod state_space;
mod transfer_function;
mod wide;

pub use complex::{Complex, modulus, quotient};
pub use delayed::{DelayedLoop, DelayedPath};
pub use eigenvalues::{eigenvalues, spectral_radius};
pub use error::LtiError;
pub use exponential::{exponential, exponential_change};
pub use fine::FineMatrix;
pub use frequency::{Crossover, FrequencyResponse, Margins, NeutralGain};
pub use hold::{held_change, zero_order_hold};
pub use in_words::InWords;
pub use integral_regulator::{
    DampedIntegrator, IntegralRegulator, IntegralWeights, integral_regulator,
};
pub use matrix::Matrix;
pub use mode::{Mode, continuous_pole};
pub use polynomial::{DEGREE_LIMIT, Polynomial};
pub use regulator::{Regulator, regulator};
pub use response::step_response;
pub use sampled::{
    Bracket, DiskMargin, GainLimit, LoopFamily, Peak, Proved, SampledCrossover, SampledLoop,
    SampledMargins, SeriesControl, Stability,
};
pub use state_space::StateSpace;
pub use transfer_function::TransferFunction;
