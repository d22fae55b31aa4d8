//! Plant files and rule tables.

use fspid_sim::ElevatorSign;

use super::scenario::COEFFICIENTS;
use super::word::Word;
use super::{Key, Kind, Range, Table, finite, optional, plain, positive, required};

/// A plant in a file of its own.
pub(crate) static PLANT_FILE: Table = plain(
    "A linear aircraft.",
    &[&[
        required("name", Kind::Text, "Name."),
        optional("title", Kind::Text, "What it is, in a line."),
        required(
            "numerator",
            COEFFICIENTS,
            "Coefficients of pitch angle over elevator, highest power of s first.",
        ),
        required("denominator", COEFFICIENTS, "As numerator; longer than it."),
        required(
            "elevator_sign",
            Kind::Word(ElevatorSign::WORDS),
            "What a positive elevator does.",
        ),
        optional("condition", Kind::Table(&CONDITION), "Flight condition."),
        optional("source", Kind::Text, "Where the numbers come from."),
        optional("notes", Kind::Text, "What else should be known."),
    ]],
);

static CONDITION: Table = plain(
    "Flight condition; what is not known is left out.",
    &[&[
        optional("aircraft", Kind::Text, "The aircraft."),
        optional("speed_m_s", positive("m/s"), "True airspeed."),
        optional("altitude_m", finite("m"), "Altitude."),
        optional(
            "mach",
            Kind::Number { unit: "", range: Range::PositiveUpTo(25.0) },
            "Mach number.",
        ),
        optional("mass_kg", positive("kg"), "Mass."),
    ]],
);

const GRID_KEYS: &[Key] = &[
    required("delta_kp", Kind::Grid, "Increment of the proportional gain."),
    required("delta_ki", Kind::Grid, "Increment of the integral gain."),
    required("delta_kd", Kind::Grid, "Increment of the derivative gain."),
];

/// The three grids alone.
pub(super) static GRIDS: Table = plain(
    "Three grids of seven lines of seven labels; rows are the error from NB to PB, columns its change.",
    &[GRID_KEYS],
);

/// Three grids of numbers in place of labels.
pub(super) static NUMBER_GRIDS: Table = plain(
    "Three grids of seven lists of seven numbers, each within the range; rows are the error from NB to PB, columns its change.",
    &[&[
        required("delta_kp", Kind::NumberGrid, "Increment of the proportional gain."),
        required("delta_ki", Kind::NumberGrid, "Increment of the integral gain."),
        required("delta_kd", Kind::NumberGrid, "Increment of the derivative gain."),
    ]],
);

/// A rule table in a file of its own.
pub(crate) static RULE_FILE: Table = plain(
    "A rule table.",
    &[
        &[
            required("name", Kind::Text, "Name."),
            optional("source", Kind::Text, "Where the rules come from."),
        ],
        GRID_KEYS,
    ],
);
