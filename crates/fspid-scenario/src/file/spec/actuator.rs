//! The actuator of the elevator.

use crate::keyed::{
    Key, KindOf, Range, Table, carried, defaulted, finite, interval, not_negative, optional, plain,
    positive, whole,
};
use fspid_sim::actuator::Preset;

fn presets() -> Vec<&'static str> {
    Preset::ALL.iter().map(|preset| preset.name).collect()
}

/// An interval of angles.
const ANGLES: KindOf<(f64, f64)> = interval("deg", Range::Between(-180.0, 180.0));

pub(crate) const PRESET: Key<str> = optional(
    "preset",
    carried(presets),
    "An actuator that the program carries; what else is given replaces its values.",
);
pub(crate) const TIME_CONSTANT_S: Key<f64> = defaulted(
    "time_constant_s",
    not_negative("s"),
    0.0,
    "Time constant; 0 for none, or for the lag of the preset.",
);
pub(crate) const NATURAL_FREQUENCY_RAD_S: Key<f64> = optional(
    "natural_frequency_rad_s",
    positive("rad/s"),
    "Natural frequency of a lag of second order, with damping.",
);
pub(crate) const DAMPING: Key<f64> =
    optional("damping", positive(""), "Damping ratio, with natural_frequency_rad_s.");
pub(crate) const POSITION_LIMIT_DEG: Key<f64> = optional(
    "position_limit_deg",
    positive("deg"),
    "The servo's command is kept within plus and minus this, and the deflection but for a bias and the overshoot of a lag of second order; travel_deg are stops.",
);
pub(crate) const TRAVEL_DEG: Key<(f64, f64)> =
    optional("travel_deg", ANGLES, "Stops of the deflection: nose down, nose up.");
pub(crate) const RATE_LIMIT_DEG_S: Key<f64> = optional(
    "rate_limit_deg_s",
    positive("deg/s"),
    "The deflection's rate is kept within plus and minus this.",
);
pub(crate) const DEADBAND_DEG: Key<f64> = optional(
    "deadband_deg",
    not_negative("deg"),
    "Commands up to plus and minus this do nothing; 0 if left out.",
);
pub(crate) const BACKLASH_DEG: Key<f64> = optional(
    "backlash_deg",
    not_negative("deg"),
    "Full width of the play between actuator and surface; 0 if left out.",
);
pub(crate) const BIAS_DEG: Key<f64> =
    optional("bias_deg", finite("deg"), "Error of the deflection; 0 if left out.");
pub(crate) const DELAY_SAMPLES: Key<i64> =
    defaulted("delay_samples", whole(0, 10_000), 0, "How many samples the command arrives late.");

pub(super) static ACTUATOR_TABLE: Table = plain(
    "A servo of first order with optional limits behind a delay; what else is given makes it an \
     actuator. Angles are nose up positive.",
    &[
        &[&PRESET, &TIME_CONSTANT_S, &NATURAL_FREQUENCY_RAD_S, &DAMPING],
        &[&POSITION_LIMIT_DEG, &TRAVEL_DEG, &RATE_LIMIT_DEG_S, &DEADBAND_DEG],
        &[&BACKLASH_DEG, &BIAS_DEG, &DELAY_SAMPLES],
    ],
);
