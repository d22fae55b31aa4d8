#![doc = include_str!("../README.md")]
//!
//! The Earth is flat and does not turn. No features. Not here: files, controllers, a clock.
//!
//! # Conventions
//! SI units and radians. Body axes point forward, right, down; the ground's north, east, down. Elevator trailing edge
//! down is positive and turns the nose down. A model of forces states its own reference for the angle of attack.
//!
//! # The same bits on every machine
//! As in `fspid-lti`: sums in a fixed order, nothing fused, elementary functions from `libm`, nothing random.

pub mod abreast;
pub mod aerodynamics;
mod aircraft;
pub mod airspeed;
pub mod atmosphere;
mod controls;
pub mod data;
pub mod derivation;
pub mod enclosure;
mod engine;
pub mod envelope;
mod error;
mod flow;
mod fuel;
pub mod integrate;
mod kink;
pub mod linearise;
mod mass;
pub mod modes;
pub mod qualities;
mod quaternion;
mod rigid_body;
mod transfer;
pub mod trim;
mod validity;
mod vector;
mod words;

pub use aerodynamics::{ForceModel, Loads};
pub use aircraft::{Aircraft, Instant, load_factors};
pub use atmosphere::{Air, AirModel, Environment};
pub use controls::{CONTROLS, Controls};
pub use engine::{Gearing, HALF_POWER, Spool, power_rate_per_s};
pub use envelope::{EnvelopeFlight, EnvelopeGrid, EnvelopeRow};
pub use error::AircraftError;
pub use flow::{AirMotion, Flow};
pub use fuel::{Consumption, FuelledBody};
pub use linearise::{Linearisation, VelocityForm};
pub use mass::MassProperties;
pub use modes::{
    AircraftMode, Growth, ModeName, lateral_modes, longitudinal_modes, modes_of_poles,
};
pub use qualities::{PitchModel, Qualities};
pub use quaternion::{EulerAngles, Quaternion};
pub use rigid_body::{Accelerations, RIGID_STATES, RigidState};
pub use transfer::transfer_function;
pub use trim::{Trim, TrimFailure, TrimPoint, TrimTarget};
pub use validity::{Departure, Quantity, Range, TableInput, Travel, Validity};
pub use vector::Vector3;
pub use words::Words;
