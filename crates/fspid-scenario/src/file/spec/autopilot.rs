//! The autopilot around the loop: outer loops, modes, engine and glide slope.

use super::angle;
use super::controller::{
    DERIVATIVE_FILTER_S, DERIVATIVE_ON, INTEGRAL, KD, KI, KP, NOMINAL, RATE_GAIN, SETPOINT_WEIGHTS,
    TUNER,
};
use super::flight::{ALTITUDES, ALTITUDES_FT};
use crate::keyed::document::Item;
use crate::keyed::word::words;
use crate::keyed::{
    Choice, Key, KeyRow, Range, Section, TEXT, Table, Way, choosing, defaulted, finite,
    not_negative, number, of_kinds, one_of, optional, own, plain, positive, required, table,
    variant, whole, word,
};

words! {
    /// What an outer loop holds.
    HoldsWord {
        Altitude = "altitude",
        VerticalSpeed = "vertical-speed",
        FlightPath = "flight-path",
        Airspeed = "airspeed",
        GlideSlope = "glide-slope",
        Heading = "heading",
    }
}

words! {
    /// How an outer loop answers.
    OuterKind { Pid = "pid", Fspid = "fspid" }
}

words! {
    /// How the power of an engine follows.
    EngineKind { FirstOrder = "first-order", StevensLewis = "stevens-lewis" }
}

pub(crate) const NAME: Key<str> =
    required("name", TEXT, "Name by which modes engage it; each only once.");
pub(crate) const HOLDS: Key<HoldsWord> = required("holds", word(), "What it holds.");
pub(crate) const MOVES: Key<str> = required(
    "moves",
    TEXT,
    "What it moves: \"pitch\", \"throttle\", \"bank\", or the target of another outer loop by its name.",
);
/// Largest size of a limit: beyond every flight.
const MOST: Range = Range::Between(-1e6, 1e6);
pub(crate) const LEAST: Key<f64> = optional(
    "least",
    number("", MOST),
    "Least of what it commands: deg for pitch (from the trim), bank and flight path, m/s for a vertical speed, parts of the throttle (from the trim); open if left out.",
);
pub(crate) const GREATEST: Key<f64> =
    optional("most", number("", MOST), "Most of what it commands, as `least`.");
pub(crate) const MOST_PER_S: Key<f64> = optional(
    "most_per_s",
    number("", Range::PositiveUpTo(1e6)),
    "Largest rate of what it commands, per second; none if left out.",
);
pub(crate) const LOOP_SENSOR: Key<Section> = optional(
    "sensor",
    table(&LOOP_SENSOR_TABLE),
    "Errors of what it sees; without this table it sees what it holds as it is.",
);

pub(crate) const SEED: Key<i64> =
    defaulted("seed", whole(0, i64::MAX), 1, "The same seed gives the same errors.");
// Optional, and not with a default: a loop without the table has no sensor.
pub(crate) const LOOP_SEED: Key<i64> =
    optional("seed", whole(0, i64::MAX), "The same seed gives the same errors; 1 if left out.");
pub(crate) const NOISE: Key<f64> = optional(
    "noise_rt_hz",
    not_negative(""),
    "One-sided noise density: m, m/s or deg, for each √Hz; none if left out.",
);
pub(crate) const BIAS: Key<f64> =
    optional("bias", not_negative(""), "Standard deviation of a flight's bias; none if left out.");
pub(crate) const RESOLUTION: Key<f64> =
    optional("resolution", not_negative(""), "Resolution; 0, and if left out, for none.");
pub(crate) const PERIOD_S: Key<f64> = optional(
    "period_s",
    not_negative("s"),
    "Sampling time of its own; 0, and if left out, for that of the loop.",
);
pub(crate) const DELAY_S: Key<f64> =
    optional("delay_s", not_negative("s"), "From looking to showing; none if left out.");

static LOOP_SENSOR_TABLE: Table = plain(
    "What measures what an outer loop holds, in its unit: m, m/s or deg.",
    &[&[&LOOP_SEED, &NOISE, &BIAS, &RESOLUTION, &PERIOD_S, &DELAY_S]],
);

/// How the terms of an outer loop are formed.
const TERMS: &[KeyRow] =
    &[&RATE_GAIN, &SETPOINT_WEIGHTS, &DERIVATIVE_ON, &DERIVATIVE_FILTER_S, &INTEGRAL];

pub(crate) static OUTER_LOOP_TABLE: Table = of_kinds(
    "A loop around the pitch loop; gains count deg, m/s or parts of the throttle of what it moves for each m, m/s or deg of what it holds.",
    &[&[&NAME, &HOLDS, &MOVES, &LEAST, &GREATEST, &MOST_PER_S, &LOOP_SENSOR]],
    &[
        variant(
            OuterKind::Pid.name(),
            choosing(
                "With fixed gains.",
                &[&[&KP, &KI, &KD], TERMS],
                &[Choice { ways: &[Way { required: &[KP.name], optional: &[KI.name, KD.name] }] }],
            ),
        ),
        variant(
            OuterKind::Fspid.name(),
            choosing(
                "With gains that a fuzzy supervisor tunes; its scales count m, m/s or deg of what is held.",
                &[&[&NOMINAL], TUNER, TERMS],
                &[one_of!(NOMINAL)],
            ),
        ),
    ],
);

pub(crate) const ENERGY_NAME: Key<str> =
    defaulted("name", TEXT, "total energy", "Name by which modes engage it.");
pub(crate) const ALTITUDE_GAIN: Key<f64> = required(
    "altitude_gain_1_s",
    number("1/s", Range::PositiveUpTo(10.0)),
    "Vertical speed that is commanded for an error of altitude.",
);
pub(crate) const AIRSPEED_GAIN: Key<f64> = required(
    "airspeed_gain_1_s",
    number("1/s", Range::PositiveUpTo(10.0)),
    "Acceleration that is commanded for an error of airspeed.",
);
pub(crate) const MOST_PATH_DEG: Key<f64> = defaulted(
    "most_flight_path_deg",
    number("deg", Range::PositiveUpTo(45.0)),
    5.0,
    "Steepest path that is commanded, up or down.",
);
pub(crate) const MOST_ACCELERATION_G: Key<f64> = defaulted(
    "most_acceleration_g",
    number("g", Range::PositiveUpTo(1.0)),
    0.1,
    "Largest acceleration along the path that is commanded, either way.",
);
pub(crate) const THROTTLE_GAINS: Key<Section> = required(
    "throttle",
    table(&ENERGY_GAINS_TABLE),
    "From the rate of the total energy, γ + V̇/g in rad, to the throttle.",
);
pub(crate) const PITCH_GAINS: Key<Section> = required(
    "pitch",
    table(&ENERGY_GAINS_TABLE),
    "From the rate of its distribution, γ − V̇/g in rad, to pitch in rad.",
);
pub(crate) const PITCH_LIMITS_DEG: Key<f64> = defaulted(
    "most_pitch_deg",
    number("deg", Range::PositiveUpTo(45.0)),
    15.0,
    "Largest pitch from the trim that is commanded, either way.",
);
pub(crate) const ENERGY_KP: Key<f64> =
    required("kp", not_negative(""), "On the rate that is found, taken off.");
pub(crate) const ENERGY_KI: Key<f64> =
    required("ki", positive("1/s"), "On the rate that is missing, added up.");

static ENERGY_GAINS_TABLE: Table = plain("Gains of total energy.", &[&[&ENERGY_KP, &ENERGY_KI]]);

pub(crate) static TOTAL_ENERGY_TABLE: Table = plain(
    "Altitude and airspeed together, by pitch and throttle together (Lambregts, AIAA 83-2239).",
    &[
        &[&ENERGY_NAME, &ALTITUDE_GAIN, &AIRSPEED_GAIN, &MOST_PATH_DEG, &MOST_ACCELERATION_G],
        &[&THROTTLE_GAINS, &PITCH_GAINS, &PITCH_LIMITS_DEG],
    ],
);

pub(crate) const TIME_CONSTANT_S: Key<f64> =
    required("time_constant_s", positive("s"), "Time constant of the power.");

pub(crate) static ENGINE_TABLE: Table = of_kinds(
    "How the power of the engine follows the throttle.",
    &[],
    &[
        variant(
            EngineKind::FirstOrder.name(),
            plain("A lag of first order.", &[&[&TIME_CONSTANT_S]]),
        ),
        variant(
            EngineKind::StevensLewis.name(),
            plain(
                "That of the F-16 model: slow far from what is asked, quick with afterburner.",
                &[],
            ),
        ),
    ],
);

pub(crate) const BANK_TIME_S: Key<f64> = optional(
    "bank_time_s",
    number("s", Range::Between(0.1, 100.0)),
    "How fast the aileron brings the aircraft to the bank that is asked for; 2 s if left out.",
);
pub(crate) const YAW_DAMPING: Key<f64> = optional(
    "yaw_damping",
    number("", Range::UpTo(1.0)),
    "Damping ratio that the rudder brings the Dutch roll near, without sideslip in turns; 0, and if left out, for a rudder that does not move.",
);

pub(crate) static LATERAL_TABLE: Table =
    plain("What looks after the lateral motion.", &[&[&BANK_TIME_S, &YAW_DAMPING]]);

pub(crate) const ANGLE_DEG: Key<f64> = defaulted(
    "angle_deg",
    number("deg", Range::PositiveUpTo(30.0)),
    3.0,
    "Angle of the beam over the horizon.",
);
pub(crate) const DISTANCE: [Key<f64>; 3] = [
    optional("distance_m", positive("m"), "From the start to the antenna, along the heading."),
    optional("distance_ft", positive("ft"), "As distance_m."),
    optional("distance_nmi", positive("nmi"), "As distance_m."),
];
pub(crate) const ANTENNA_ALTITUDE: [Key<f64>; 2] = [
    optional(
        "antenna_altitude_m",
        number("m", ALTITUDES),
        "Altitude of the antenna; that of the ground if left out.",
    ),
    optional("antenna_altitude_ft", number("ft", ALTITUDES_FT), "As antenna_altitude_m."),
];
pub(crate) const ANGLE_NOISE: Key<f64> = defaulted(
    "angle_noise_deg_rt_hz",
    not_negative("deg/√Hz"),
    0.0,
    "One-sided noise density of the angle that the receiver shows.",
);
pub(crate) const ANGLE_BIAS_DEG: Key<f64> = defaulted(
    "angle_bias_deg",
    not_negative("deg"),
    0.0,
    "Standard deviation of a flight's bias of that angle.",
);
pub(crate) const RANGE_BIAS_M: Key<f64> = defaulted(
    "range_bias_m",
    not_negative("m"),
    0.0,
    "Standard deviation of a flight's bias of the range.",
);
pub(crate) const RANGE_NOISE: Key<f64> = defaulted(
    "range_noise_m_rt_hz",
    not_negative("m/√Hz"),
    0.0,
    "One-sided noise density of the range.",
);

pub(crate) static GLIDE_SLOPE_TABLE: Table = choosing(
    "The beam of an instrument landing system, ahead of the start.",
    &[
        &[&ANGLE_DEG, &DISTANCE[0], &DISTANCE[1], &DISTANCE[2]],
        &[&ANTENNA_ALTITUDE[0], &ANTENNA_ALTITUDE[1], &SEED],
        &[&ANGLE_NOISE, &ANGLE_BIAS_DEG, &RANGE_NOISE, &RANGE_BIAS_M],
    ],
    &[one_of!(DISTANCE[0], DISTANCE[1], DISTANCE[2])],
);

pub(crate) const MODE_NAME: Key<str> = required("name", TEXT, "Name in traces and reports.");
pub(crate) const AT_S: Key<f64> = defaulted(
    "at_s",
    not_negative("s"),
    0.0,
    "Not before this time; the first mode begins with the flight.",
);
pub(crate) const WHEN: Key<Section> = optional(
    "when",
    table(&WHEN_TABLE),
    "What has to be so for it to begin after the mode before it; all of it.",
);
pub(crate) const ENGAGE: Key<Item> = optional(
    "engage",
    own(names_in_words, names_schema),
    "Names of the loops that are engaged; none if left out.",
);
pub(crate) const TARGET: Key<Section> = optional(
    "target",
    table(&TARGET_TABLE),
    "What engaged loops hold; a quantity that is left out is held as it is when its loop becomes engaged.",
);
pub(crate) const BANK_DEG: Key<f64> = defaulted(
    "bank_deg",
    number("deg", Range::Between(-60.0, 60.0)),
    0.0,
    "Bank that is flown where no loop moves it, right wing down positive.",
);

pub(crate) fn names_in_words() -> String {
    "a list of texts, each the name of an outer loop".to_owned()
}

fn names_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" } })
}

pub(crate) static MODE_TABLE: Table = plain(
    "A mode of the autopilot; they follow each other in the order of the file.",
    &[&[&MODE_NAME, &AT_S, &WHEN, &ENGAGE, &TARGET, &BANK_DEG]],
);

/// A quantity in its units.
type Units = &'static [Key<f64>];

/// What each loop holds, and the target of it in every unit.
pub(crate) const TARGETS: [(HoldsWord, Units); 5] = [
    (HoldsWord::Altitude, &TARGET_ALTITUDE),
    (HoldsWord::VerticalSpeed, &TARGET_VERTICAL_SPEED),
    (HoldsWord::FlightPath, &[TARGET_FLIGHT_PATH]),
    (HoldsWord::Airspeed, &TARGET_AIRSPEED),
    (HoldsWord::Heading, &[TARGET_HEADING]),
];

const TARGET_ALTITUDE: [Key<f64>; 2] = [
    optional("altitude_m", number("m", ALTITUDES), "Altitude."),
    optional("altitude_ft", number("ft", ALTITUDES_FT), "Altitude."),
];
const TARGET_VERTICAL_SPEED: [Key<f64>; 2] = [
    optional("vertical_speed_m_s", finite("m/s"), "Vertical speed, climbing positive."),
    optional("vertical_speed_ft_min", finite("ft/min"), "Vertical speed, climbing positive."),
];
const TARGET_FLIGHT_PATH: Key<f64> = optional(
    "flight_path_deg",
    number("deg", Range::Between(-89.0, 89.0)),
    "Angle of the path over the ground, climbing positive.",
);
const TARGET_AIRSPEED: [Key<f64>; 3] = [
    optional("airspeed_m_s", positive("m/s"), "True airspeed."),
    optional("airspeed_kt", positive("kt"), "True airspeed."),
    optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
];
const TARGET_HEADING: Key<f64> =
    optional("heading_deg", angle(), "Heading, clockwise from north; the shorter turn is flown.");

static TARGET_TABLE: Table = plain(
    "What engaged loops hold.",
    &[
        &[&TARGET_ALTITUDE[0], &TARGET_ALTITUDE[1]],
        &[&TARGET_VERTICAL_SPEED[0], &TARGET_VERTICAL_SPEED[1], &TARGET_FLIGHT_PATH],
        &[&TARGET_AIRSPEED[0], &TARGET_AIRSPEED[1], &TARGET_AIRSPEED[2], &TARGET_HEADING],
    ],
);

/// The keys of conditions: a quantity, whether it has to be at or above the number, and in which unit.
pub(crate) const CONDITIONS: [(HoldsWord, bool, Key<f64>); 14] = [
    (HoldsWord::Altitude, true, ALTITUDE_ABOVE[0]),
    (HoldsWord::Altitude, true, ALTITUDE_ABOVE[1]),
    (HoldsWord::Altitude, false, ALTITUDE_BELOW[0]),
    (HoldsWord::Altitude, false, ALTITUDE_BELOW[1]),
    (HoldsWord::VerticalSpeed, true, VERTICAL_SPEED_ABOVE[0]),
    (HoldsWord::VerticalSpeed, true, VERTICAL_SPEED_ABOVE[1]),
    (HoldsWord::VerticalSpeed, false, VERTICAL_SPEED_BELOW[0]),
    (HoldsWord::VerticalSpeed, false, VERTICAL_SPEED_BELOW[1]),
    (HoldsWord::Airspeed, true, AIRSPEED_ABOVE[0]),
    (HoldsWord::Airspeed, true, AIRSPEED_ABOVE[1]),
    (HoldsWord::Airspeed, false, AIRSPEED_BELOW[0]),
    (HoldsWord::Airspeed, false, AIRSPEED_BELOW[1]),
    (HoldsWord::GlideSlope, true, GLIDE_SLOPE_ABOVE_M),
    (HoldsWord::GlideSlope, false, GLIDE_SLOPE_BELOW_M),
];

const ALTITUDE_ABOVE: [Key<f64>; 2] = [
    optional("altitude_above_m", number("m", ALTITUDES), "At or above this altitude."),
    optional("altitude_above_ft", number("ft", ALTITUDES_FT), "At or above this altitude."),
];
const ALTITUDE_BELOW: [Key<f64>; 2] = [
    optional("altitude_below_m", number("m", ALTITUDES), "At or below this altitude."),
    optional("altitude_below_ft", number("ft", ALTITUDES_FT), "At or below this altitude."),
];
const VERTICAL_SPEED_ABOVE: [Key<f64>; 2] = [
    optional("vertical_speed_above_m_s", finite("m/s"), "Climbing at least so fast."),
    optional("vertical_speed_above_ft_min", finite("ft/min"), "Climbing at least so fast."),
];
const VERTICAL_SPEED_BELOW: [Key<f64>; 2] = [
    optional("vertical_speed_below_m_s", finite("m/s"), "Climbing at most so fast."),
    optional("vertical_speed_below_ft_min", finite("ft/min"), "Climbing at most so fast."),
];
const AIRSPEED_ABOVE: [Key<f64>; 2] = [
    optional("airspeed_above_m_s", positive("m/s"), "At or above this true airspeed."),
    optional("airspeed_above_kt", positive("kt"), "At or above this true airspeed."),
];
const AIRSPEED_BELOW: [Key<f64>; 2] = [
    optional("airspeed_below_m_s", positive("m/s"), "At or below this true airspeed."),
    optional("airspeed_below_kt", positive("kt"), "At or below this true airspeed."),
];
const GLIDE_SLOPE_ABOVE_M: Key<f64> =
    optional("above_glide_slope_m", finite("m"), "At least so high above the beam.");
const GLIDE_SLOPE_BELOW_M: Key<f64> = optional(
    "below_glide_slope_m",
    finite("m"),
    "At most so high above the beam; below 0 is below it.",
);

static WHEN_TABLE: Table = plain(
    "What has to be so.",
    &[
        &[&ALTITUDE_ABOVE[0], &ALTITUDE_ABOVE[1], &ALTITUDE_BELOW[0], &ALTITUDE_BELOW[1]],
        &[&VERTICAL_SPEED_ABOVE[0], &VERTICAL_SPEED_ABOVE[1]],
        &[&VERTICAL_SPEED_BELOW[0], &VERTICAL_SPEED_BELOW[1]],
        &[&AIRSPEED_ABOVE[0], &AIRSPEED_ABOVE[1], &AIRSPEED_BELOW[0], &AIRSPEED_BELOW[1]],
        &[&GLIDE_SLOPE_ABOVE_M, &GLIDE_SLOPE_BELOW_M],
    ],
);
