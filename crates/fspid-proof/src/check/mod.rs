//! The re-check in interval arithmetic: what a certificate is believed for.
//!
//! A solver finds matrices in ordinary arithmetic. What they claim is proved here, or refused: every
//! sum and product is enclosed, the sampled plant with its matrix exponential as well, and nothing is
//! taken from the solver but numbers.
//!
//! # What it rests on
//! Sums, products, quotients and square roots of `f64` rounded to nearest (IEEE 754), the intervals of
//! [`fspid_numeric::scalar::Interval`], and the error bounds written down beside the code. No other
//! elementary function is used.

mod balance;
mod definite;
mod disturbed;
mod driven;
mod driven_moving;
mod error;
mod exponential;
mod factor;
mod growth;
mod lyapunov;
mod matrix;
mod moving;
mod packed;
mod plant;
mod plant_set;
mod product;

pub use crate::caps::MOST_PARAMETERS;
pub use balance::balance;
pub use definite::prove_positive_definite;
pub use disturbed::{Driven, Ellipsoid, grows_no_faster};
pub use driven::driven;
pub use driven_moving::{MovingDrive, grows_no_faster_while_moving};
pub use error::NotProved;
pub use exponential::{exponential, held};
pub use growth::{prove_growth, prove_unstable};
pub use lyapunov::{
    Relaxation, decreases, decreases_between, inside_limit, inside_limits, is_positive, reach,
};
pub use matrix::IntervalMatrix;
pub use moving::{Ends, Moving, MovingProof, NotProvedAt, falls_while_moving};
pub(crate) use plant::Passed;
pub use plant::{ActuatorLag, ContinuousPlant, LagOf, PrintedPlant, ROUNDED, printed};
pub(crate) use plant_set::from_middle;
pub use plant_set::{MakesPlant, PlantSet, Sloped};
