//! What is said of aircraft wherever one is asked about: units, numbers, and why there is no answer.

mod failure;
pub mod number;
pub mod units;

pub use failure::{AircraftFailure, departure, quantity};
pub use units::Units;
