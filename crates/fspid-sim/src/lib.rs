#![doc = include_str!("../README.md")]
//!
//! What flies is a [`LinearPlant`], an [`AircraftPlant`] or, in another simulator, an [`ExternalPlant`] behind an [`Actuator`], what answers a [`Controller`]. Units are
//! SI and radians; degrees exist in files and reports only.
//!
//! [`Surroundings`] adds what a real flight has: moving [`air`], sensors
//! with noise and delay. Without them the loop is that of the paper, bit for bit.
//!
//! No features. Not here: measures and verdicts (`fspid-study`). [`stability`] is the exception that the loop itself
//! must answer: whether it is locally stable at all, about each equilibrium, with fixed gains, self-tuners and autopilots alike.
#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod actuated;
pub mod actuator;
pub mod air;
pub mod aircraft;
mod around_trim;
pub mod autopilot;
pub mod batch;
mod beyond;
mod closed_loop;
pub mod control_law;
mod controller;
pub mod describing;
mod error;
pub mod external;
pub mod external_plant;
mod flight_doubt;
pub mod flight_stack;
pub mod flown;
mod flown_on;
mod generator;
pub mod gradient;
mod gust_entry;
mod gust_response;
mod held_limits;
mod in_flight;
#[cfg(test)]
mod in_tests;
mod inflow;
mod instant;
mod integral_limits;
mod law;
mod leads_to;
mod led;
pub mod load;
mod longitudinal;
pub mod loop_model;
mod math;
mod names;
mod plant;
mod propagation;
mod propagator;
pub mod replay;
mod rest;
mod sample_guard;
mod scenario;
mod seen;
pub mod sensor;
pub mod signal;
pub mod stability;
mod steady;
mod surroundings;
mod timing;
mod trace;

pub use actuator::Actuator;
pub use aircraft::{AircraftPlant, AircraftSample};
pub use autopilot::{Autopilot, AutopilotSample};
pub use closed_loop::{Flight, fly, fly_commanded, fly_perturbed, simulate};
pub use controller::Controller;
pub use error::SimError;
pub use external::{ControllerLoss, External, ExternalSource, NamedExternal};
pub use external_plant::{ExternalPlant, PlantLoss, Simulator};
pub use flown::{AllPass, Perturbation};
pub use in_flight::{InFlight, ModePoles, mode_poles};
pub use inflow::Inflow;
pub use instant::Instant;
pub use led::{Led, Leg};
pub use longitudinal::{LongitudinalDerivatives, LongitudinalModel};
pub use plant::{ElevatorSign, LinearPlant, Plant, PlantChange};
pub use rest::{Doubt, Rest, RestPoint, Side, Stand};
pub use scenario::{Flyer, NamedController, Noises, Prepared, Respondent, Scenario};
pub use seen::Seen;
pub use steady::Steady;
pub use surroundings::{Course, Surroundings, Weather};
pub use timing::{MAX_ROWS, Timing};
pub use trace::{Column, EarlyEnd, EndCause, Exit, Outcome, Trace};

pub use fspid_core as core;
pub use fspid_lti as lti;
