//! Gains by dynamic pressure.

use crate::keyed::{
    Key, Section, Table, defaulted, finite, optional, plain, positive, required, table,
};

/// The schedule of a controller with fixed gains.
pub(crate) const SCHEDULE: Key<Section> = optional(
    "schedule",
    table(&TABLE),
    "Multiplies every gain by a power of the dynamic pressure at which the aircraft is trimmed; by nothing if left out.",
);

pub(crate) const DYNAMIC_PRESSURE_PA: Key<f64> = required(
    "dynamic_pressure_pa",
    positive("Pa"),
    "Dynamic pressure for which the gains are written.",
);
pub(crate) const EXPONENT: Key<f64> = defaulted(
    "exponent",
    finite(""),
    -1.0,
    "Power of the ratio of pressures; -1 keeps gain times elevator effectiveness.",
);
pub(crate) const LEAST_FACTOR: Key<f64> =
    optional("least_factor", positive(""), "The factor is not below this; free if left out.");
pub(crate) const MOST_FACTOR: Key<f64> =
    optional("most_factor", positive(""), "The factor is not above this; free if left out.");

static TABLE: Table = plain(
    "Gains by dynamic pressure: all are multiplied by (pressure at the trim / dynamic_pressure_pa)^exponent. \
     Taken once, before the flight; it does not follow what happens in it.",
    &[&[&DYNAMIC_PRESSURE_PA, &EXPONENT, &LEAST_FACTOR, &MOST_FACTOR]],
);
