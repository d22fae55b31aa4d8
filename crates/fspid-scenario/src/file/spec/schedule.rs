//! Gains by dynamic pressure.

use super::{Default, Key, Kind, Table, defaulted, finite, optional, plain, positive, required};

/// The schedule of a controller with fixed gains.
pub(super) const SCHEDULE: Key = optional(
    "schedule",
    Kind::Table(&TABLE),
    "Multiplies every gain by a power of the dynamic pressure at which the aircraft is trimmed; by nothing if left out.",
);

static TABLE: Table = plain(
    "Gains by dynamic pressure: all are multiplied by (pressure at the trim / dynamic_pressure_pa)^exponent. \
     Taken once, before the flight; it does not follow what happens in it.",
    &[&[
        required(
            "dynamic_pressure_pa",
            positive("Pa"),
            "Dynamic pressure for which the gains are written.",
        ),
        defaulted(
            "exponent",
            finite(""),
            Default::Number(-1.0),
            "Power of the ratio of pressures; -1 keeps gain times elevator effectiveness.",
        ),
        optional("least_factor", positive(""), "The factor is not below this; free if left out."),
        optional("most_factor", positive(""), "The factor is not above this; free if left out."),
    ]],
);
