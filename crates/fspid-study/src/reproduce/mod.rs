//! The paper, flown again.

mod claim;
pub mod disturbance;
mod figures;
pub mod identify;
mod judge;
mod model;
mod qualitative;
mod reading;
