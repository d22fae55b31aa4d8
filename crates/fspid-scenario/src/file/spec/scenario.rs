//! The scenario file: everything but controllers and signals.

use crate::keyed::document::Item;
use crate::keyed::word::words_of;
use crate::keyed::{
    Choice, FILE_PATH, Key, KindOf, Range, Section, TEXT, Table, Way, carried, choosing, defaulted,
    not_negative, numbers, one_of, optional, own, plain, positive, required, table, tables, whole,
    word,
};
use fspid_sim::ElevatorSign;

use super::actuator::ACTUATOR_TABLE;
use super::air::{GUST_TABLE, TURBULENCE_TABLE, WIND_TABLE};
use super::autopilot::{
    ENGINE_TABLE, GLIDE_SLOPE_TABLE, LATERAL_TABLE, MODE_TABLE, OUTER_LOOP_TABLE,
    TOTAL_ENERGY_TABLE,
};
use super::configuration::{CONFIGURATION, CONFIGURATION_CHANGE, FUEL, GROUND_EFFECT};
use super::controller::CONTROLLER_TABLE;
use super::dispersion::DISPERSION_TABLE;
use super::flight::AIRCRAFT_TABLE;
use super::sensor::SENSOR_TABLE;
use super::signal::{DISTURBANCE_TABLE, SETPOINT_TABLE};
use super::simulator::SIMULATOR_TABLE;
use super::tuning::{CONTEST_TABLE, TUNING_TABLE};
use crate::carried::plant_names;
use crate::file::overrides;
use crate::requirement::keys::REQUIREMENT_TABLE;

pub(crate) const SCHEMA: Key<i64> = required("schema", whole(1, 1), "Version of this format.");
pub(crate) const NAME: Key<str> = required("name", TEXT, "Name in reports.");
pub(crate) const PLANT: Key<Section> =
    optional("plant", table(&PLANT_TABLE), "A linear aircraft, from elevator to pitch angle.");
pub(crate) const AIRCRAFT: Key<Section> = optional(
    "aircraft",
    table(&AIRCRAFT_TABLE),
    "In place of a plant: an aircraft from its data, at a speed and an altitude.",
);
pub(crate) const SIMULATOR: Key<Section> = optional(
    "simulator",
    table(&SIMULATOR_TABLE),
    "In place of a plant: an aircraft that another simulator flies.",
);
pub(crate) const ACTUATOR: Key<Section> = optional(
    "actuator",
    table(&ACTUATOR_TABLE),
    "The elevator servo; without this table it is ideal.",
);
pub(crate) const LOOP: Key<Section> = required("loop", table(&LOOP_TABLE), "Samples and duration.");
pub(crate) const SETPOINT: Key<Section> =
    required("setpoint", table(&SETPOINT_TABLE), "The commanded pitch angle.");
pub(crate) const SENSOR: Key<Section> = optional(
    "sensor",
    table(&SENSOR_TABLE),
    "What measures pitch and pitch rate; without this table both are seen as they are.",
);
pub(crate) const WIND: Key<Section> =
    optional("wind", table(&WIND_TABLE), "The wind around an aircraft.");
pub(crate) const GUST: Key<[Section]> = optional(
    "gust",
    tables(&GUST_TABLE, 0, 100),
    "Gusts that an aircraft flies into; all are added.",
);
pub(crate) const TURBULENCE: Key<Section> =
    optional("turbulence", table(&TURBULENCE_TABLE), "Random gusts around an aircraft.");
pub(crate) const DISTURBANCE: Key<[Section]> =
    optional("disturbance", tables(&DISTURBANCE_TABLE, 0, 100), "What disturbs; all are added.");
pub(crate) const PLANT_CHANGE: Key<[Section]> = optional(
    "plant_change",
    tables(&PLANT_CHANGE_TABLE, 0, 100),
    "Changes of the aircraft in flight, in order of time.",
);
pub(crate) const ENGINE: Key<Section> = optional(
    "engine",
    table(&ENGINE_TABLE),
    "How the engine follows the throttle; without this table at once.",
);
pub(crate) const LATERAL: Key<Section> = optional(
    "lateral",
    table(&LATERAL_TABLE),
    "What looks after the lateral motion of a nonlinear aircraft; without this table a wing leveller with 2 s.",
);
pub(crate) const GLIDE_SLOPE: Key<Section> =
    optional("glide_slope", table(&GLIDE_SLOPE_TABLE), "A beam to follow to the ground.");
pub(crate) const OUTER_LOOP: Key<[Section]> = optional(
    "outer_loop",
    tables(&OUTER_LOOP_TABLE, 0, 20),
    "Loops around the pitch loop, which command its set-point, the throttle or the bank.",
);
pub(crate) const TOTAL_ENERGY: Key<Section> = optional(
    "total_energy",
    table(&TOTAL_ENERGY_TABLE),
    "A loop for altitude and airspeed together.",
);
pub(crate) const MODE: Key<[Section]> =
    optional("mode", tables(&MODE_TABLE, 0, 100), "Which outer loops are engaged when, in order.");
pub(crate) const CONTROLLER: Key<[Section]> = required(
    "controller",
    tables(&CONTROLLER_TABLE, 1, 100),
    "Who answers; each flies the whole scenario alone.",
);
pub(crate) const REQUIREMENT: Key<[Section]> =
    optional("requirement", tables(&REQUIREMENT_TABLE, 0, 1000), "What the responses must meet.");
pub(crate) const DISPERSION: Key<[Section]> = optional(
    "dispersion",
    tables(&DISPERSION_TABLE, 0, 1000),
    "What differs from run to run of `fspid campaign`.",
);
pub(crate) const TUNING: Key<Section> = optional(
    "tuning",
    table(&TUNING_TABLE),
    "How `fspid tune` chooses the numbers that are marked free.",
);
pub(crate) const CONTEST: Key<Section> =
    optional("contest", table(&CONTEST_TABLE), "Where `fspid contest` compares tuned controllers.");
pub(crate) const SET: Key<Item> = optional(
    overrides::KEY,
    own(overrides::listed_in_words, overrides::listed_schema),
    "Changes as `--set` makes them, before anything is checked; also of what the files say that are named.",
);

/// The file as a whole.
pub(crate) static SCENARIO: Table = choosing(
    "A flight to be simulated, once for each controller.",
    &[
        &[&SCHEMA, &NAME, &PLANT, &AIRCRAFT, &SIMULATOR, &ACTUATOR, &LOOP, &SETPOINT, &SENSOR],
        &[&CONFIGURATION, &CONFIGURATION_CHANGE, &GROUND_EFFECT, &FUEL],
        &[&ENGINE, &LATERAL, &GLIDE_SLOPE, &OUTER_LOOP, &TOTAL_ENERGY, &MODE],
        &[&WIND, &GUST, &TURBULENCE, &DISTURBANCE, &PLANT_CHANGE, &CONTROLLER],
        &[&REQUIREMENT, &DISPERSION, &TUNING, &CONTEST, &SET],
    ],
    &[one_of!(PLANT, AIRCRAFT, SIMULATOR)],
);

words_of!(ElevatorSign {
    NoseDownPositive = "nose-down-positive",
    NoseUpPositive = "nose-up-positive",
});

/// A list of coefficients.
pub(super) const COEFFICIENTS: KindOf<[f64]> = numbers("", Range::Finite, (1, 101));

pub(crate) const PRESET: Key<str> =
    optional("preset", carried(plant_names), "A plant that the program carries.");
pub(crate) const FILE: Key<str> =
    optional("file", FILE_PATH, "A plant file, relative to this file.");
pub(crate) const NUMERATOR: Key<[f64]> = optional(
    "numerator",
    COEFFICIENTS,
    "Coefficients of pitch angle over elevator, highest power of s first.",
);
pub(crate) const DENOMINATOR: Key<[f64]> =
    optional("denominator", COEFFICIENTS, "As numerator; longer than it.");
pub(crate) const ELEVATOR_SIGN: Key<ElevatorSign> =
    optional("elevator_sign", word(), "What a positive elevator does in these coefficients.");

static PLANT_TABLE: Table = choosing(
    "A linear aircraft.",
    &[&[&PRESET, &NUMERATOR, &DENOMINATOR, &ELEVATOR_SIGN, &FILE]],
    &[Choice {
        ways: &[
            Way { required: &[PRESET.name], optional: &[] },
            Way {
                required: &[NUMERATOR.name, DENOMINATOR.name, ELEVATOR_SIGN.name],
                optional: &[],
            },
            Way { required: &[FILE.name], optional: &[] },
        ],
    }],
);

pub(crate) const AT_S: Key<f64> = required("at_s", not_negative("s"), "Start of the change.");
pub(crate) const RAMP_S: Key<f64> =
    defaulted("ramp_s", not_negative("s"), 0.0, "Length of the change; 0 for at once.");

static PLANT_CHANGE_TABLE: Table = choosing(
    "A change of the aircraft's coefficients in flight.",
    &[&[&AT_S, &RAMP_S], &[&PRESET, &NUMERATOR, &DENOMINATOR, &ELEVATOR_SIGN, &FILE]],
    &[Choice {
        ways: &[
            Way { required: &[PRESET.name], optional: &[] },
            // The sign is that of the plant unless it is given.
            Way { required: &[NUMERATOR.name, DENOMINATOR.name], optional: &[ELEVATOR_SIGN.name] },
            Way { required: &[FILE.name], optional: &[] },
        ],
    }],
);

pub(crate) const SAMPLE_PERIOD_S: Key<f64> =
    required("sample_period_s", positive("s"), "Time from sample to sample.");
pub(crate) const DURATION_S: Key<f64> = required(
    "duration_s",
    positive("s"),
    "Length of the flight; round(duration_s / sample_period_s) + 1 samples.",
);

static LOOP_TABLE: Table = plain("When samples are taken.", &[&[&SAMPLE_PERIOD_S, &DURATION_S]]);
