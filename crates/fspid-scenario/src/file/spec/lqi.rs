//! The linear-quadratic regulator with integral action.

use super::{Default, Key, Kind, Table, defaulted, finite, plain, positive, required};

/// What makes its gains.
pub(super) const LQI: &[Key] = &[
    required("design", Kind::Table(&DESIGN), "The model that the regulator is optimal for."),
    required("weights", Kind::Table(&WEIGHTS), "What the regulator makes the least of."),
    defaulted(
        "setpoint_weight",
        finite(""),
        Default::Number(0.0),
        "How much of the set-point the pitch gain sees at once; 0 is the regulator itself.",
    ),
];

static DESIGN: Table = plain(
    "Pitching with the angle of attack left out: q' = -pitch_damping_per_s q + elevator_power_per_s2 u; pitch' = q.",
    &[&[
        required(
            "pitch_damping_per_s",
            finite("1/s"),
            "Damping of the pitch rate; negative for one that grows by itself.",
        ),
        required(
            "elevator_power_per_s2",
            positive("1/s2"),
            "Pitch acceleration per command; a positive command turns the nose up.",
        ),
    ]],
);

static WEIGHTS: Table = plain(
    "Weights of squares in the integral over time that is made the least, beside 1 for the command.",
    &[&[
        required("pitch", positive(""), "Weight of the pitch angle."),
        required("rate", positive("s2"), "Weight of the pitch rate."),
        required("integral", positive("1/s2"), "Weight of the integral of the error."),
    ]],
);
