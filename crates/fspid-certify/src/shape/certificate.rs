//! The keys of a certificate.
//!
//! Ranges are wide: they keep out what no loop has, and what would cost time or memory before a proof
//! could refuse it. What a number may be beyond that is asked where the loop is built.

use fspid_proof::sizes::{
    MOST_CHANGES, MOST_CONES, MOST_DIVISIONS, MOST_LEG_PARTS, MOST_LEGS, MOST_LOADS, MOST_PIECES,
    MOST_SAMPLES, MOST_STATES,
};

use fspid_proof::{MOST_BOUNDS, MOST_PARAMETERS, MOST_PARTS, MOST_PATCHES};

use super::{Key, Shape, key, optional};
use Shape::{Digest, Kinds, List, Number, Object, OrNull, Positive, Text, Truth, Whole, Word};

/// A whole certificate, but for the first two keys, which are asked before.
pub(in super::super) const CERTIFICATE: Shape = Object(&[
    key("kind", Text(64)),
    key("schema", Whole(1, 1000)),
    optional("content_digest", Digest),
    key("origin", ORIGIN),
    key("loop", LOOP),
    key("controller", CONTROLLER),
    key("output_factor", Number(0.0, 1e6)),
    key("divisions", Whole(1, MOST_DIVISIONS as u64)),
    key("range", RANGE),
    key("not_in_this_claim", List(&Text(64), [0, 64])),
    key("limits", Word(&["none-are-there", "none-acts-within-the-level", "left-out"])),
    key("claim", CLAIM),
    optional("level", Positive(LARGE)),
    optional("steps", STEPS),
    optional("commanded", COMMANDED),
    optional("family", FAMILY),
    optional("disturbances", List(&DISTURBANCE, [1, MOST_BOUNDS])),
    optional("nonlinear", NONLINEAR),
]);

/// A bound of what a disturbance does.
const DISTURBANCE: Shape = Object(&[
    key("enters", Word(&["elevator", "forward-gust", "vertical-gust", "turning-gust"])),
    optional("numerator", List(&REAL, [1, COEFFICIENTS])),
    key("bounds", Word(&["pitch", "command", "limits"])),
    key("measured_by", Word(&["energy", "peak"])),
    key("decay", RATE),
    key("gain", Positive(LARGE)),
    key("form", FORM),
    optional("by_gain", List(&FORM, [3, 3])),
]);

/// Boxes of set-points, and parts of the loads.
const STEPS: Shape = Object(&[
    key("setpoint_rad", Positive(ANGLE)),
    key("load_rad", Number(0.0, ANGLE)),
    key("ends", List(&END, [2, MOST_PIECES + 1])),
    key("loads", Whole(1, MOST_LOADS as u64)),
    key("near_rest", NEAR_REST),
]);

/// Set-point and loads over time, and the parts that they are flown in.
const COMMANDED: Shape = Object(&[
    key("setpoint_rad", Number(0.0, ANGLE)),
    key("load_rad", Number(0.0, ANGLE)),
    key("setpoint", CHANGES),
    key("at_servo", CHANGES),
    key("at_elevator", CHANGES),
    key(
        "legs",
        List(
            &Object(&[
                key("from_sample", Whole(0, u32::MAX as u64)),
                key("groups", List(&GROUP, [1, MOST_LEG_PARTS])),
            ]),
            [1, MOST_LEGS],
        ),
    ),
    key("near_rest", NEAR_REST),
]);

const GROUP: Shape = Object(&[
    key("of", List(&Whole(0, u32::MAX as u64), [0, MOST_LEG_PARTS])),
    key("setpoints_rad", List(&END, [2, MOST_LEG_PARTS + 1])),
    key("loads_rad", List(&END, [2, MOST_LEG_PARTS + 1])),
]);

const CHANGES: Shape = List(
    &Object(&[key("from_sample", Whole(0, u32::MAX as u64)), key("share", Number(-1.0, 1.0))]),
    [0, MOST_CHANGES],
);

const NEAR_REST: Shape = Object(&[
    key("rate", RATE),
    key("form", FORM),
    key("level", Positive(LARGE)),
    optional("gains", REMEMBERED),
]);

/// Gains that remember, and how far their reference model may be off.
const REMEMBERED: Shape = Object(&[
    key("least", List(&Number(-LARGE, LARGE), [3, 3])),
    key("most", List(&Number(-LARGE, LARGE), [3, 3])),
    key("model_rad", Number(0.0, ANGLE)),
]);

/// In what time numbers may cross their ranges, and patches of the box with a claim each.
const PACE: Shape = Object(&[
    key("crosses_in_s", NOT_NEGATIVE),
    key("overlap", Number(0.0, 1.0)),
    key("patches", List(&PATCH, [1, MOST_PATCHES])),
]);

const PATCH: Shape = Object(&[
    key("ends", List(&BOTH_ENDS, [1, MOST_PARAMETERS])),
    key("claim", Whole(0, MOST_PARTS as u64)),
]);

/// What differs, claims, and parts with their plants.
const FAMILY: Shape = Object(&[
    key("parameters", List(&PARAMETER, [1, MOST_PARAMETERS])),
    key("claims", List(&CLAIM, [1, MOST_PARTS])),
    key("parts", List(&PART, [1, MOST_PARTS])),
    optional("pace", PACE),
]);

const PARAMETER: Shape = Object(&[
    key("name", Text(NAME)),
    key("paths", List(&Text(NAME), [1, COEFFICIENTS])),
    key("relative", Truth),
    key("inverse", Truth),
    optional("sensors", List(&Word(&["pitch", "rate"]), [1, 2])),
    key("ends", BOTH_ENDS),
]);

/// Ends of a number of a plant.
const BOTH_ENDS: Shape = List(&REAL, [2, 2]);
const ROW: Shape = List(&BOTH_ENDS, [1, COEFFICIENTS]);
const ROWS: Shape = List(&ROW, [1, COEFFICIENTS]);

const PART: Shape = Object(&[
    key("ends", List(&BOTH_ENDS, [1, MOST_PARAMETERS])),
    key("plants", PLANTS),
    key("claim", Whole(0, MOST_PARTS as u64)),
]);

const PLANTS: Shape = Object(&[
    key("middle", ROWS),
    key("all", ROWS),
    key("slopes", List(&ROWS, [0, MOST_PARAMETERS])),
    key("reach", List(&NOT_NEGATIVE, [0, MOST_PARAMETERS])),
    key("pitch_rate", ROW),
    key("without_lag", Truth),
]);

/// The aircraft, the box, and what is claimed in it.
const NONLINEAR: Shape = Object(&[
    optional("begins_with", Word(&["any-gains", "reset"])),
    key("aircraft", AIRCRAFT),
    key(
        "box",
        Object(&[
            key("pitch_rad", Positive(ANGLE)),
            key("pitch_rate_rad_s", Positive(ANGLE)),
            key("airspeed_m_s", Positive(FACTOR)),
            key("alpha_rad", Positive(ANGLE)),
            key("elevator_rad", Positive(ANGLE)),
            key("command_rad", Positive(ANGLE)),
        ]),
    ),
    key("rate", RATE),
    key("form", FORM),
    key("level", Positive(LARGE)),
]);

const AIRCRAFT: Shape = Object(&[
    key("mass_kg", Positive(FACTOR)),
    key("iy_kg_m2", Positive(FACTOR)),
    key("cg_aft_chords", REAL),
    key("airspeed_m_s", Positive(FACTOR)),
    key("flight_path_rad", END),
    key("density_kg_m3", Positive(FACTOR)),
    optional("height_m", Number(0.0, FACTOR)),
    optional("densities_kg_m3", List(&Positive(FACTOR), [2, 2])),
    key("gravity_m_s2", Positive(FACTOR)),
    key("area_m2", Positive(FACTOR)),
    key("chord_m", Positive(FACTOR)),
    key("reference_airspeed_m_s", Positive(FACTOR)),
    key("lift", COEFFICIENT),
    key("drag", COEFFICIENT),
    key("pitch", COEFFICIENT),
    key("thrust_speed", REAL),
    key("drag_law", Word(&["linear", "polar"])),
    key("thrust_law", Word(&["constant", "with-speed"])),
    key("alpha_rad", ENDS),
    key("airspeeds_m_s", ENDS),
    key("elevator_rad", ENDS),
]);

/// A coefficient and its derivatives.
const COEFFICIENT: Shape = Object(&[
    key("reference", REAL),
    key("alpha", REAL),
    key("alpha_rate", REAL),
    key("pitch_rate", REAL),
    key("speed", REAL),
    key("elevator", REAL),
]);

/// Longest names.
const NAME: usize = 1000;
/// Entries of forms, and levels.
const LARGE: f64 = 1e150;
/// Gains, scales, coefficients.
const FACTOR: f64 = 1e30;
/// Angles and rates; a guard that is practically none is a billion degrees.
const ANGLE: f64 = 1e12;
/// Times, s.
const TIME: f64 = 1e6;
/// Most coefficients of a polynomial.
const COEFFICIENTS: usize = 33;
/// Most samples on their way: a loop of more states is refused.
const SAMPLES: u64 = MOST_STATES as u64;

const ENTRY: Shape = Number(-LARGE, LARGE);
const REAL: Shape = Number(-FACTOR, FACTOR);
const NOT_NEGATIVE: Shape = Number(0.0, FACTOR);
const END: Shape = Number(-ANGLE, ANGLE);
const DURATION: Shape = Number(0.0, TIME);
/// Ends, `null` for an open one.
const ENDS: Shape = List(&OrNull(&END), [2, 2]);
const GAIN_ENDS: Shape = List(&OrNull(&REAL), [2, 2]);
const GAINS: Shape = Object(&[key("kp", REAL), key("ki", REAL), key("kd", REAL)]);

const ORIGIN: Shape = Object(&[
    key("program", Text(64)),
    key("scenario", Text(NAME)),
    key("digest", Digest),
    key("controller", Text(NAME)),
]);

const RANGE: Shape =
    Object(&[key("setpoint_rad", Number(0.0, ANGLE)), key("load_rad", Number(0.0, ANGLE))]);

const LOOP: Shape = Object(&[
    key("sample_period_s", Positive(TIME)),
    key("numerator", List(&REAL, [1, COEFFICIENTS])),
    key("denominator", List(&REAL, [2, COEFFICIENTS])),
    key("elevator_sign", Word(&["nose-up-positive", "nose-down-positive"])),
    key("actuator", ACTUATOR),
    key("pitch_sensing", SENSING),
    key("rate_sensing", SENSING),
]);

const ACTUATOR: Shape = Object(&[
    key("lag", LAG),
    key("delay_samples", Whole(0, SAMPLES)),
    key("command_limits_rad", OrNull(&List(&END, [2, 2]))),
    key("travel_rad", OrNull(&List(&END, [2, 2]))),
    key("rate_limit_rad_s", OrNull(&Positive(ANGLE))),
    key("bias_rad", END),
]);

const LAG: Shape = Kinds(
    "order",
    &[
        ("none", &[]),
        ("first", &[key("time_constant_s", Positive(TIME))]),
        (
            "second",
            &[key("natural_frequency_rad_s", Positive(FACTOR)), key("damping", Positive(FACTOR))],
        ),
    ],
);

const SENSING: Shape = Object(&[
    key("scale", REAL),
    key("samples", Whole(0, SAMPLES)),
    key("part", Number(0.0, 1.0)),
    key("resolution", Number(0.0, ANGLE)),
]);

const CONTROLLER: Shape = Object(&[
    key("gains", GAINS),
    key("rate_gain_s", REAL),
    key("setpoint_weights", List(&REAL, [2, 2])),
    optional("feedforward", REAL),
    key("derivative_filter_s", DURATION),
    key("integral", Word(&["bumpless", "literal"])),
    key("anti_windup", ANTI_WINDUP),
    key("output_limits_rad", OrNull(&ENDS)),
    key("slew_limit_rad_s", OrNull(&Positive(ANGLE))),
    key("sample_guard_rad", Positive(ANGLE)),
    key("tuner", OrNull(&TUNER)),
]);

const ANTI_WINDUP: Shape = Kinds(
    "kind",
    &[
        ("none", &[]),
        ("clamping", &[key("limits_rad", ENDS)]),
        ("conditional", &[]),
        ("back-calculation", &[key("tracking_s", Positive(TIME))]),
    ],
);

const TUNER: Shape = Object(&[
    key("error_sign", Word(&["setpoint-minus-measurement", "measurement-minus-setpoint"])),
    key("change", Word(&["rate", "delta"])),
    key("error_per_rad", REAL),
    key("change_per_rad", REAL),
    key("output_scale", GAINS),
    key("law", LAW),
    key("gain_limits", OrNull(&List(&GAIN_ENDS, [3, 3]))),
    key("dead_zone", OrNull(&List(&NOT_NEGATIVE, [2, 2]))),
    key("range", Positive(FACTOR)),
    key("defuzzifier", Text(32)),
    key("out_of_range", Text(32)),
    key("rules", OrNull(&RULES)),
    optional("numbers", NUMBERS),
    optional("network", NETWORK),
    optional("second_input", SECOND_INPUT),
    optional("error_set_centres", CENTRES),
    optional("change_set_centres", CENTRES),
    optional("gain_coupling", COUPLING),
]);

const NUMBER_GRID: Shape = List(&List(&REAL, [7, 7]), [7, 7]);
const NUMBERS: Shape = Object(&[
    key("delta_kp", NUMBER_GRID),
    key("delta_ki", NUMBER_GRID),
    key("delta_kd", NUMBER_GRID),
]);
/// A weight of each hidden unit.
const WEIGHTS: Shape = List(
    &Number(-fspid_core::fuzzy::LARGEST_WEIGHT, fspid_core::fuzzy::LARGEST_WEIGHT),
    [fspid_core::fuzzy::UNITS, fspid_core::fuzzy::UNITS],
);
const NETWORK: Shape = Object(&[
    key("error", WEIGHTS),
    key("change", WEIGHTS),
    key("offset", WEIGHTS),
    key("delta_kp", WEIGHTS),
    key("delta_ki", WEIGHTS),
    key("delta_kd", WEIGHTS),
]);
const SECOND_INPUT: Shape = Kinds(
    "kind",
    &[
        ("rate", &[]),
        (
            "model-error",
            &[key("bandwidth_rad_s", Positive(FACTOR)), key("damping", Positive(FACTOR))],
        ),
    ],
);
/// Small and medium centres as shares of the range.
const CENTRES: Shape = List(&Positive(1.0), [2, 2]);
const COUPLING: Shape =
    Object(&[key("setpoint_weight_per_kp", REAL), key("rate_gain_per_kd", REAL)]);

const LAW: Shape = Kinds(
    "kind",
    &[("memoryless", &[]), ("accumulating", &[key("leakage_per_s", Number(0.0, FACTOR))])],
);

/// Seven rows of seven labels of two letters.
const GRID: Shape = List(&Text(20), [7, 7]);
const RULES: Shape = Object(&[key("delta_kp", GRID), key("delta_ki", GRID), key("delta_kd", GRID)]);

const FORM: Shape = List(&List(&ENTRY, [1, MOST_STATES]), [1, MOST_STATES]);
const RATE: Shape = Positive(1.0);
const GROWTH: Shape = Number(1.0, LARGE);
const DIRECTION: Shape = List(&ENTRY, [1, MOST_STATES]);
/// An input of the supervisor.
const INPUT: Shape = List(&REAL, [2, 2]);

const CLAIM: Shape = Kinds(
    "kind",
    &[
        ("stable-at-any-speed", &[key("rate", RATE), key("form", FORM)]),
        (
            "stable-as-tied-to-the-error",
            &[
                key("rate", RATE),
                key("form", FORM),
                key("multipliers", List(&Number(0.0, LARGE), [1, MOST_CONES])),
            ],
        ),
        ("stable-at-bounded-rate", BOUNDED_RATE),
        (
            "unstable-with-frozen-gains",
            &[
                key("input", INPUT),
                key("factor", GROWTH),
                key("form", FORM),
                key("direction", DIRECTION),
            ],
        ),
        (
            "unstable-with-a-sequence-of-gains",
            &[
                key("inputs", List(&INPUT, [1, MOST_SAMPLES])),
                key("factor", GROWTH),
                key("form", FORM),
                key("direction", DIRECTION),
            ],
        ),
    ],
);

const BOUNDED_RATE: &[Key] = &[
    key("rate", RATE),
    key("ends", List(&List(&REAL, [2, 2]), [3, 3])),
    key("changes", List(&NOT_NEGATIVE, [3, 3])),
    key("forms", List(&FORM, [4, 4])),
];
