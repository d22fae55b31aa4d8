//! The scenario file: everything but controllers and signals.

use fspid_sim::ElevatorSign;

use super::actuator::ACTUATOR;
use super::air::{GUST, TURBULENCE, WIND};
use super::controller::CONTROLLER;
use super::dispersion::DISPERSION;
use super::flight::AIRCRAFT;
use super::requirement::REQUIREMENT;
use super::sensor::SENSOR;
use super::signal::{DISTURBANCE, SETPOINT};
use super::tuning::{CONTEST, TUNING};
use super::word::{Word, words_of};
use super::{
    Choice, Default, Key, Kind, Range, Table, Way, defaulted, not_negative, optional, plain,
    positive, required,
};
use crate::file::overrides;
use crate::file::preset::plant_names;

/// The file as a whole.
pub(crate) static SCENARIO: Table = Table {
    doc: "A flight to be simulated, once for each controller.",
    groups: &[&[
        required("schema", Kind::Integer { least: 1, most: 1 }, "Version of this format."),
        required("name", Kind::Text, "Name in reports."),
        optional("plant", Kind::Table(&PLANT), "A linear aircraft, from elevator to pitch angle."),
        optional(
            "aircraft",
            Kind::Table(&AIRCRAFT),
            "In place of a plant: an aircraft from its data, at a speed and an altitude.",
        ),
        optional(
            "actuator",
            Kind::Table(&ACTUATOR),
            "The elevator servo; without this table it is ideal.",
        ),
        required("loop", Kind::Table(&LOOP), "Samples and duration."),
        required("setpoint", Kind::Table(&SETPOINT), "The commanded pitch angle."),
        optional(
            "sensor",
            Kind::Table(&SENSOR),
            "What measures pitch and pitch rate; without this table both are seen as they are.",
        ),
        optional("wind", Kind::Table(&WIND), "The wind around an aircraft."),
        optional(
            "gust",
            Kind::Tables { table: &GUST, least: 0, most: 100 },
            "Gusts that an aircraft flies into; all are added.",
        ),
        optional("turbulence", Kind::Table(&TURBULENCE), "Random gusts around an aircraft."),
        optional(
            "disturbance",
            Kind::Tables { table: &DISTURBANCE, least: 0, most: 100 },
            "What disturbs; all are added.",
        ),
        optional(
            "plant_change",
            Kind::Tables { table: &PLANT_CHANGE, least: 0, most: 100 },
            "Changes of the aircraft in flight, in order of time.",
        ),
        required(
            "controller",
            Kind::Tables { table: &CONTROLLER, least: 1, most: 100 },
            "Who answers; each flies the whole scenario alone.",
        ),
        optional(
            "requirement",
            Kind::Tables { table: &REQUIREMENT, least: 0, most: 1000 },
            "What the responses must meet.",
        ),
        optional(
            "dispersion",
            Kind::Tables { table: &DISPERSION, least: 0, most: 1000 },
            "What differs from run to run of `fspid campaign`.",
        ),
        optional(
            "tuning",
            Kind::Table(&TUNING),
            "How `fspid tune` chooses the numbers that are marked free.",
        ),
        optional(
            "contest",
            Kind::Table(&CONTEST),
            "Where `fspid contest` compares tuned controllers.",
        ),
        optional(
            overrides::KEY,
            Kind::Own { allowed: overrides::listed_in_words, schema: overrides::listed_schema },
            "Changes as `--set` makes them, before anything is checked; also of what the files say that are named.",
        ),
    ]],
    choices: &[one_of!("plant", "aircraft")],
    variants: &[],
};

words_of!(ElevatorSign {
    NoseDownPositive = "nose-down-positive",
    NoseUpPositive = "nose-up-positive",
});

/// A list of coefficients.
pub(super) const COEFFICIENTS: Kind =
    Kind::Numbers { unit: "", range: Range::Finite, least: 1, most: 101 };

const PRESET: Key =
    optional("preset", Kind::Preset(plant_names), "A plant that the program carries.");
const FILE: Key = optional("file", Kind::Path, "A plant file, relative to this file.");
const NUMERATOR: Key = optional(
    "numerator",
    COEFFICIENTS,
    "Coefficients of pitch angle over elevator, highest power of s first.",
);
const DENOMINATOR: Key = optional("denominator", COEFFICIENTS, "As numerator; longer than it.");
const ELEVATOR_SIGN: Key = optional(
    "elevator_sign",
    Kind::Word(ElevatorSign::WORDS),
    "What a positive elevator does in these coefficients.",
);

static PLANT: Table = Table {
    doc: "A linear aircraft.",
    groups: &[&[PRESET, NUMERATOR, DENOMINATOR, ELEVATOR_SIGN, FILE]],
    choices: &[Choice {
        ways: &[
            Way { required: &["preset"], optional: &[] },
            Way { required: &["numerator", "denominator", "elevator_sign"], optional: &[] },
            Way { required: &["file"], optional: &[] },
        ],
    }],
    variants: &[],
};

static PLANT_CHANGE: Table = Table {
    doc: "A change of the aircraft's coefficients in flight.",
    groups: &[
        &[
            required("at_s", not_negative("s"), "Start of the change."),
            defaulted(
                "ramp_s",
                not_negative("s"),
                Default::Number(0.0),
                "Length of the change; 0 for at once.",
            ),
        ],
        &[PRESET, NUMERATOR, DENOMINATOR, ELEVATOR_SIGN, FILE],
    ],
    choices: &[Choice {
        ways: &[
            Way { required: &["preset"], optional: &[] },
            // The sign is that of the plant unless it is given.
            Way { required: &["numerator", "denominator"], optional: &["elevator_sign"] },
            Way { required: &["file"], optional: &[] },
        ],
    }],
    variants: &[],
};

static LOOP: Table = plain(
    "When samples are taken.",
    &[&[
        required("sample_period_s", positive("s"), "Time from sample to sample."),
        required(
            "duration_s",
            positive("s"),
            "Length of the flight; round(duration_s / sample_period_s) + 1 samples.",
        ),
    ]],
);
