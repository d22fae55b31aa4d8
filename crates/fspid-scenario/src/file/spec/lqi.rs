//! The linear-quadratic regulator with integral action.

use crate::keyed::{
    Key, KeyRow, Section, Table, defaulted, finite, plain, positive, required, table,
};

pub(crate) const DESIGN: Key<Section> =
    required("design", table(&DESIGN_TABLE), "The model that the regulator is optimal for.");
pub(crate) const WEIGHTS: Key<Section> =
    required("weights", table(&WEIGHTS_TABLE), "What the regulator makes the least of.");
pub(crate) const SETPOINT_WEIGHT: Key<f64> = defaulted(
    "setpoint_weight",
    finite(""),
    0.0,
    "How much of the set-point the pitch gain sees at once; 0 is the regulator itself.",
);

/// What makes its gains.
pub(super) const LQI: &[KeyRow] = &[&DESIGN, &WEIGHTS, &SETPOINT_WEIGHT];

pub(crate) const PITCH_DAMPING_PER_S: Key<f64> = required(
    "pitch_damping_per_s",
    finite("1/s"),
    "Damping of the pitch rate; negative for one that grows by itself.",
);
pub(crate) const ELEVATOR_POWER_PER_S2: Key<f64> = required(
    "elevator_power_per_s2",
    positive("1/s2"),
    "Pitch acceleration per command; a positive command turns the nose up.",
);

static DESIGN_TABLE: Table = plain(
    "Pitching with the angle of attack left out: q' = -pitch_damping_per_s q + elevator_power_per_s2 u; pitch' = q.",
    &[&[&PITCH_DAMPING_PER_S, &ELEVATOR_POWER_PER_S2]],
);

pub(crate) const PITCH: Key<f64> = required("pitch", positive(""), "Weight of the pitch angle.");
pub(crate) const RATE: Key<f64> = required("rate", positive("s2"), "Weight of the pitch rate.");
pub(crate) const INTEGRAL: Key<f64> =
    required("integral", positive("1/s2"), "Weight of the integral of the error.");

static WEIGHTS_TABLE: Table = plain(
    "Weights of squares in the integral over time that is made the least, beside 1 for the command.",
    &[&[&PITCH, &RATE, &INTEGRAL]],
);
