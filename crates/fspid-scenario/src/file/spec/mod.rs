//! The specification of the files: every key with its kind, unit, range, default and meaning.
//!
//! A key is added in one place: its row in this folder, a constant with its name in the list of its table, and the line of
//! `build` that asks for it by the same constant.

pub(crate) mod actuator;
pub(crate) mod air;
pub(crate) mod aircraft;
pub(crate) mod autopilot;
pub(crate) mod configuration;
pub(crate) mod controller;
pub(crate) mod data;
pub(crate) mod dispersion;
pub(crate) mod flight;
pub(crate) mod flight_stack;
mod keys;
pub(crate) mod lqi;
pub(crate) mod scenario;
pub(crate) mod schedule;
pub(crate) mod sensor;
pub(crate) mod signal;
pub(crate) mod simulator;
pub(crate) mod tables;
pub(crate) mod tuning;

use crate::keyed::{KindOf, Range, number};

pub(crate) use aircraft::{AIRCRAFT_FILE, AircraftKind};
pub(crate) use data::{PLANT_FILE, RULE_FILE};
pub use keys::scenario_keys;
pub(crate) use scenario::SCENARIO;
pub(crate) use tuning::FRONT;

/// Largest size of an angle, in degrees: where a flight has diverged.
pub(crate) const ANGLE_LIMIT_DEG: f64 = 1e6;

/// An angle in degrees.
pub(crate) const fn angle() -> KindOf<f64> {
    number("deg", Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG))
}
