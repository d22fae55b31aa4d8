//! Plant files and rule tables.

use crate::keyed::{
    GRID, Key, KeyRow, NUMBER_GRID, Range, Section, TEXT, Table, finite, number, numbers, optional,
    plain, positive, required, table, word,
};
use fspid_fuzzy::{Grid, LARGEST_WEIGHT, NumberGrid, UNITS};
use fspid_sim::ElevatorSign;

use super::scenario::COEFFICIENTS;

pub(crate) const NAME: Key<str> = required("name", TEXT, "Name.");
pub(crate) const TITLE: Key<str> = optional("title", TEXT, "What it is, in a line.");
pub(crate) const NUMERATOR: Key<[f64]> = required(
    "numerator",
    COEFFICIENTS,
    "Coefficients of pitch angle over elevator, highest power of s first.",
);
pub(crate) const DENOMINATOR: Key<[f64]> =
    required("denominator", COEFFICIENTS, "As numerator; longer than it.");
pub(crate) const ELEVATOR_SIGN: Key<ElevatorSign> =
    required("elevator_sign", word(), "What a positive elevator does.");
pub(crate) const CONDITION: Key<Section> =
    optional("condition", table(&CONDITION_TABLE), "Flight condition.");
pub(crate) const PLANT_SOURCE: Key<str> = optional("source", TEXT, "Where the numbers come from.");
pub(crate) const NOTES: Key<str> = optional("notes", TEXT, "What else should be known.");

/// A plant in a file of its own.
pub(crate) static PLANT_FILE: Table = plain(
    "A linear aircraft.",
    &[
        &[&NAME, &TITLE, &NUMERATOR, &DENOMINATOR, &ELEVATOR_SIGN, &CONDITION],
        &[&PLANT_SOURCE, &NOTES],
    ],
);

pub(crate) const AIRCRAFT: Key<str> = optional("aircraft", TEXT, "The aircraft.");
pub(crate) const SPEED_M_S: Key<f64> = optional("speed_m_s", positive("m/s"), "True airspeed.");
pub(crate) const ALTITUDE_M: Key<f64> = optional("altitude_m", finite("m"), "Altitude.");
pub(crate) const MACH: Key<f64> =
    optional("mach", number("", Range::PositiveUpTo(25.0)), "Mach number.");
pub(crate) const MASS_KG: Key<f64> = optional("mass_kg", positive("kg"), "Mass.");

static CONDITION_TABLE: Table = plain(
    "Flight condition; what is not known is left out.",
    &[&[&AIRCRAFT, &SPEED_M_S, &ALTITUDE_M, &MACH, &MASS_KG]],
);

pub(crate) const DELTA_KP: Key<Grid> =
    required("delta_kp", GRID, "Increment of the proportional gain.");
pub(crate) const DELTA_KI: Key<Grid> =
    required("delta_ki", GRID, "Increment of the integral gain.");
pub(crate) const DELTA_KD: Key<Grid> =
    required("delta_kd", GRID, "Increment of the derivative gain.");

const GRID_KEYS: &[KeyRow] = &[&DELTA_KP, &DELTA_KI, &DELTA_KD];

/// The three grids alone.
pub(super) static GRIDS_TABLE: Table = plain(
    "Three grids of seven lines of seven labels; rows are the error from NB to PB, columns its change.",
    &[GRID_KEYS],
);

pub(crate) const NUMBER_DELTA_KP: Key<NumberGrid<f64>> =
    required("delta_kp", NUMBER_GRID, "Increment of the proportional gain.");
pub(crate) const NUMBER_DELTA_KI: Key<NumberGrid<f64>> =
    required("delta_ki", NUMBER_GRID, "Increment of the integral gain.");
pub(crate) const NUMBER_DELTA_KD: Key<NumberGrid<f64>> =
    required("delta_kd", NUMBER_GRID, "Increment of the derivative gain.");

/// Three grids of numbers in place of labels.
pub(super) static NUMBER_GRIDS_TABLE: Table = plain(
    "Three grids of seven lists of seven numbers, each within the range; rows are the error from NB to PB, columns its change.",
    &[&[&NUMBER_DELTA_KP, &NUMBER_DELTA_KI, &NUMBER_DELTA_KD]],
);

/// Hidden units, as a number for each is written.
const EACH_UNIT: (usize, usize) = (UNITS, UNITS);

const fn weights(name: &'static str, doc: &'static str) -> Key<[f64]> {
    let range = Range::Between(-LARGEST_WEIGHT, LARGEST_WEIGHT);
    required(name, numbers("", range, EACH_UNIT), doc)
}

/// Rows of a network, in the order of [`fspid_fuzzy::Network::ROWS`].
pub(crate) const NETWORK_ROWS: [Key<[f64]>; 6] = [
    weights("error", "Weight of the error in each of the eight hidden units."),
    weights("change", "Weight of what is seen beside it in each of them."),
    weights("offset", "Offset of each of them."),
    weights("delta_kp", "Weight of each of them in the increment of the proportional gain."),
    weights("delta_ki", "Weight of each of them in the increment of the integral gain."),
    weights("delta_kd", "Weight of each of them in the increment of the derivative gain."),
];

/// A network in place of rules.
pub(super) static NETWORK_TABLE: Table = plain(
    "A network of eight hidden units: silent at rest, the same for a mirrored flight, its answers within the range.",
    &[&[
        &NETWORK_ROWS[0],
        &NETWORK_ROWS[1],
        &NETWORK_ROWS[2],
        &NETWORK_ROWS[3],
        &NETWORK_ROWS[4],
        &NETWORK_ROWS[5],
    ]],
);

pub(crate) const RULE_SOURCE: Key<str> = optional("source", TEXT, "Where the rules come from.");

/// A rule table in a file of its own.
pub(crate) static RULE_FILE: Table = plain("A rule table.", &[&[&NAME, &RULE_SOURCE], GRID_KEYS]);
