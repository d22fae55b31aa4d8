//! The controllers.

use super::data::{GRIDS_TABLE, NETWORK_TABLE, NUMBER_GRIDS_TABLE};
use super::{ANGLE_LIMIT_DEG, angle};
use crate::carried::rule_table_names;
use crate::keyed::KindOf;
use crate::keyed::word::{words, words_of};
use crate::keyed::{
    Choice, DEFUZZIFIER_NAME, FILE_PATH, Key, KeyRow, Range, Rules, Section, TEXT, Table, Way,
    choosing, defaulted, finite, interval, not_negative, number, of_kinds, one_of, optional, plain,
    positive, required, rules, table, tables, variant, word,
};
use fspid_core::{Change, ErrorSign, IntegralForm};
use fspid_fuzzy::Defuzzifier;
use fspid_fuzzy::OutOfRange;

use super::flight_stack::{ARDUPILOT_TABLE, PX4_TABLE};
use super::lqi::LQI;
use super::schedule::SCHEDULE;

words! {
    /// Controls that an input of a control law can trim.
    TrimmedControl { Elevator = "elevator", Throttle = "throttle" }
}

words! {
    /// What controls.
    ControllerKind {
        P = "p",
        Pid = "pid",
        Fspid = "fspid",
        Lqi = "lqi",
        External = "external",
        ArduPilot = "ardupilot",
        Px4 = "px4",
    }
}

words! {
    /// What the derivative acts on.
    DerivativeOn { Error = "error", Measurement = "measurement" }
}

words! {
    /// What the integral does at a limit.
    AntiWindupKind {
        None = "none",
        Clamping = "clamping",
        Conditional = "conditional",
        BackCalculation = "back-calculation",
    }
}

words! {
    /// How increments become gains.
    LawWord { Memoryless = "memoryless", Accumulating = "accumulating" }
}

words! {
    /// What the supervisor sees.
    SecondInputWord {
        Change = "error-and-change",
        Rate = "error-and-rate",
        ModelError = "error-and-model-error",
    }
}

words_of!(IntegralForm { Bumpless = "bumpless", Literal = "literal" });
words_of!(OutOfRange { Clamp = "clamp", Evaluate = "evaluate", Error = "error" });
words_of!(ErrorSign {
    SetpointMinusMeasurement = "setpoint-minus-measurement",
    MeasurementMinusSetpoint = "measurement-minus-setpoint",
});
words_of!(Change { Rate = "rate", Delta = "delta" });

pub(crate) const NAME: Key<str> =
    required("name", TEXT, "Name in traces and reports; each only once.");
/// Largest gain either way: what the loop at rest multiplies it with twice stays within the range of 64-bit numbers.
const MOST_GAIN: f64 = 1e100;

const fn gain(unit: &'static str) -> KindOf<f64> {
    number(unit, Range::Between(-MOST_GAIN, MOST_GAIN))
}

pub(crate) const P_KP: Key<f64> = required("kp", gain(""), "Command per error.");
pub(crate) const KP: Key<f64> = optional("kp", gain(""), "Proportional gain, command per error.");
pub(crate) const KI: Key<f64> = optional("ki", gain("1/s"), "Integral gain; 0 if left out.");
pub(crate) const KD: Key<f64> = optional("kd", gain("s"), "Derivative gain; 0 if left out.");
pub(crate) const ISA: Key<Section> = optional("isa", table(&ISA_TABLE), "The gains in ISA form.");
pub(crate) const NOMINAL: Key<Section> =
    optional("nominal", table(&PARALLEL_TABLE), "The gains that the supervisor adds to.");
pub(crate) const NOMINAL_ISA: Key<Section> =
    optional("nominal_isa", table(&ISA_TABLE), "The same in ISA form.");

pub(super) static CONTROLLER_TABLE: Table = of_kinds(
    "A controller; a positive command turns the nose up.",
    &[&[&NAME]],
    &[
        variant(
            ControllerKind::P.name(),
            plain(
                "Proportional, with an optional inner loop of pitch rate.",
                &[&[&P_KP, &RATE_GAIN, &FEEDFORWARD, &SCHEDULE]],
            ),
        ),
        variant(
            ControllerKind::Pid.name(),
            choosing(
                "PID with fixed gains, in parallel or ISA form.",
                &[&[&KP, &KI, &KD, &ISA, &SCHEDULE], TERMS, ENDS],
                &[Choice {
                    ways: &[
                        Way { required: &[KP.name], optional: &[KI.name, KD.name] },
                        Way { required: &[ISA.name], optional: &[] },
                    ],
                }],
            ),
        ),
        variant(
            ControllerKind::Fspid.name(),
            choosing(
                "PID whose gains a fuzzy supervisor tunes while flying.",
                &[&[&NOMINAL, &NOMINAL_ISA], TUNER, TERMS, ENDS],
                &[one_of!(NOMINAL, NOMINAL_ISA)],
            ),
        ),
        variant(
            ControllerKind::Lqi.name(),
            plain(
                "Linear-quadratic regulator with integral action, of a model of pitching.",
                &[LQI, ENDS],
            ),
        ),
        variant(
            ControllerKind::External.name(),
            choosing(
                "A program that answers samples, an export or one of your own, which runs as you do; or a control law in a file of DAVE-ML.",
                &[
                    &[&LIBRARY, &FMU, &INPUTS, &OUTPUTS, &ANSWER_LIMIT_S],
                    &[&CONTROL_LAW, &LAW_INPUT],
                ],
                &[Choice {
                    ways: &[
                        Way { required: &[LIBRARY.name], optional: &[] },
                        Way { required: &[FMU.name], optional: &[INPUTS.name, OUTPUTS.name] },
                        Way { required: &[CONTROL_LAW.name], optional: &[LAW_INPUT.name] },
                    ],
                }],
            ),
        ),
        variant(ControllerKind::ArduPilot.name(), ARDUPILOT_TABLE),
        variant(ControllerKind::Px4.name(), PX4_TABLE),
    ],
);

pub(crate) const LIBRARY: Key<str> = optional(
    "library",
    FILE_PATH,
    "A shared library with the functions of `fspid_external.h`, relative to this file.",
);
pub(crate) const FMU: Key<str> = optional(
    "fmu",
    FILE_PATH,
    "An FMU for co-simulation (FMI 2.0 or 3.0), relative to this file; `inputs` and `outputs` say how its variables are called where they are not those of `fspid export --to fmu2`.",
);
pub(crate) const CONTROL_LAW: Key<str> = optional(
    "control_law",
    FILE_PATH,
    "A control law in DAVE-ML, as a file or as `fspid aircraft import` writes it, relative to this file: outputs `elevatorDeflection` and, if it has them, `aileronDeflection`, `rudderDeflection` and `powerLeverAngle`, of what a nonlinear aircraft shows. It has no memory; with aileron or rudder it flies the lateral motion, too.",
);
pub(crate) const LAW_INPUT: Key<[Section]> = optional(
    "input",
    tables(&LAW_INPUT_TABLE, 0, 100),
    "Inputs of a control law that are set, in this order.",
);
pub(crate) const LAW_INPUT_NAME: Key<str> =
    required("name", TEXT, "Name of the input, such as \"altitudeMslCommand\".");
pub(crate) const LAW_INPUT_VALUE: Key<f64> =
    optional("value", finite(""), "Its value, in the unit of the file.");
pub(crate) const LAW_INPUT_ADDED: Key<f64> = optional(
    "added",
    finite(""),
    "What is added to what the flight shows, in the unit of the file: an error, or a course line beside the first one.",
);
pub(crate) const LAW_INPUT_TRIMS: Key<TrimmedControl> = optional(
    "trims",
    word(),
    "In place of a value: it is found so that this control stands at the start where the trim has it, whatever its `at_s`.",
);
pub(crate) const LAW_INPUT_AT_S: Key<f64> =
    defaulted("at_s", not_negative("s"), 0.0, "When that begins.");
static LAW_INPUT_TABLE: Table = choosing(
    "An input of a control law.",
    &[&[&LAW_INPUT_NAME, &LAW_INPUT_VALUE, &LAW_INPUT_ADDED, &LAW_INPUT_TRIMS, &LAW_INPUT_AT_S]],
    &[Choice {
        ways: &[
            Way { required: &[LAW_INPUT_VALUE.name], optional: &[] },
            Way { required: &[LAW_INPUT_ADDED.name], optional: &[] },
            Way { required: &[LAW_INPUT_TRIMS.name], optional: &[] },
        ],
    }],
);
pub(crate) const INPUTS: Key<Section> = optional(
    "inputs",
    table(&INPUTS_TABLE),
    "How the FMU calls its inputs; the unit is that of the key.",
);
pub(crate) const OUTPUTS: Key<Section> = optional(
    "outputs",
    table(&OUTPUTS_TABLE),
    "How the FMU calls its command; the unit is that of the key.",
);
pub(crate) const ANSWER_LIMIT_S: Key<f64> = defaulted(
    "answer_limit_s",
    number("s", Range::Between(0.001, 3600.0)),
    5.0,
    "The longest time for an answer, by the clock; one that takes longer hangs.",
);

pub(crate) const RATE_GAIN: Key<f64> = defaulted(
    "rate_gain",
    finite("s"),
    0.0,
    "Gain of the inner loop: command per pitch rate, taken off.",
);

pub(crate) const NOMINAL_KP: Key<f64> =
    required("kp", gain(""), "Proportional gain, command per error.");
pub(crate) const NOMINAL_KI: Key<f64> = defaulted("ki", gain("1/s"), 0.0, "Integral gain.");
pub(crate) const NOMINAL_KD: Key<f64> = defaulted("kd", gain("s"), 0.0, "Derivative gain.");

static PARALLEL_TABLE: Table =
    plain("Gains in parallel form.", &[&[&NOMINAL_KP, &NOMINAL_KI, &NOMINAL_KD]]);

const fn called(name: &'static str, doc: &'static str) -> Key<str> {
    optional(name, TEXT, doc)
}

/// Names of an FMU's inputs, of each place one in radians and one in degrees.
pub(crate) const FMU_INPUTS: [[Key<str>; 2]; 3] = [
    [
        called("setpoint_rad", "The input for the commanded pitch, in radians."),
        called("setpoint_deg", "The same in degrees."),
    ],
    [
        called("measurement_rad", "The input for the measured pitch, in radians."),
        called("measurement_deg", "The same in degrees."),
    ],
    [
        called("rate_rad_s", "The input for the pitch rate, in radians per second."),
        called("rate_deg_s", "The same in degrees per second."),
    ],
];
/// The same of its command.
pub(crate) const FMU_OUTPUTS: [Key<str>; 2] = [
    called(
        "command_rad",
        "The output that is the command, in radians; `-name` turns the sign of one that is nose down positive.",
    ),
    called("command_deg", "The same in degrees."),
];
static INPUTS_TABLE: Table = plain(
    "Inputs of an FMU by their names there; `-name` turns a sign.",
    &[
        &[&FMU_INPUTS[0][0], &FMU_INPUTS[0][1]],
        &[&FMU_INPUTS[1][0], &FMU_INPUTS[1][1]],
        &[&FMU_INPUTS[2][0], &FMU_INPUTS[2][1]],
    ],
);
static OUTPUTS_TABLE: Table =
    plain("Outputs of an FMU by their names there.", &[&[&FMU_OUTPUTS[0], &FMU_OUTPUTS[1]]]);

pub(crate) const GAIN: Key<f64> = required("gain", finite(""), "K, command per error.");
pub(crate) const TI_S: Key<f64> =
    optional("ti_s", positive("s"), "Integral time; no integral if left out.");
pub(crate) const TD_S: Key<f64> = defaulted("td_s", not_negative("s"), 0.0, "Derivative time.");
pub(crate) const N: Key<f64> = optional(
    "n",
    positive(""),
    "The derivative is filtered with time constant td_s / n; not at all if left out.",
);

static ISA_TABLE: Table = plain(
    "Gains in ISA form: gain · (e + ∫e dt / ti_s + td_s · de/dt).",
    &[&[&GAIN, &TI_S, &TD_S, &N]],
);

pub(crate) const SETPOINT_WEIGHTS: Key<Section> = optional(
    "setpoint_weights",
    table(&WEIGHTS_TABLE),
    "How much of the set-point each term sees.",
);
pub(crate) const FEEDFORWARD: Key<f64> = defaulted(
    "feedforward",
    finite(""),
    0.0,
    "Command per set-point beside the other terms; it does not move with the gains of a self-tuner.",
);
pub(crate) const DERIVATIVE_ON: Key<DerivativeOn> = defaulted(
    "derivative_on",
    word(),
    DerivativeOn::Error,
    "`measurement` is a derivative weight of 0.",
);
pub(crate) const DERIVATIVE_FILTER_S: Key<f64> = optional(
    "derivative_filter_s",
    not_negative("s"),
    "Time constant of the derivative's filter; 0 for none, which is also the default.",
);
pub(crate) const INTEGRAL: Key<IntegralForm> = defaulted(
    "integral",
    word(),
    IntegralForm::Bumpless,
    "Sum of ki·e, or ki times the sum of e as the paper has it.",
);

/// How the terms of a PID controller are formed.
const TERMS: &[KeyRow] =
    &[&RATE_GAIN, &SETPOINT_WEIGHTS, &FEEDFORWARD, &DERIVATIVE_ON, &DERIVATIVE_FILTER_S, &INTEGRAL];

pub(crate) const ANTI_WINDUP: Key<Section> = optional(
    "anti_windup",
    table(&ANTI_WINDUP_TABLE),
    "What the integral does at a limit; nothing if left out.",
);
pub(crate) const OUTPUT_LIMITS_DEG: Key<(f64, f64)> = optional(
    "output_limits_deg",
    interval("deg", Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG)),
    "Lowest and highest command.",
);
pub(crate) const SLEW_LIMIT_DEG_S: Key<f64> =
    optional("slew_limit_deg_s", positive("deg/s"), "Largest rate of the command.");
pub(crate) const SAMPLE_GUARD_DEG: Key<f64> = defaulted(
    "sample_guard_deg",
    number("deg", Range::PositiveUpTo(1e300)),
    1e9,
    "A larger sample is not believed: the command is held.",
);

/// Where a controller with an integral ends: its limits, and which samples it believes.
const ENDS: &[KeyRow] = &[&ANTI_WINDUP, &OUTPUT_LIMITS_DEG, &SLEW_LIMIT_DEG_S, &SAMPLE_GUARD_DEG];

pub(crate) const PROPORTIONAL: Key<f64> =
    defaulted("proportional", finite(""), 1.0, "Weight in the proportional term.");
pub(crate) const DERIVATIVE: Key<f64> = optional(
    "derivative",
    finite(""),
    "Weight in the derivative term; if left out 1, or 0 where derivative_on is `measurement`.",
);

static WEIGHTS_TABLE: Table = plain("Set-point weights.", &[&[&PROPORTIONAL, &DERIVATIVE]]);

pub(crate) const LOWER_DEG: Key<f64> = required("lower_deg", angle(), "Lowest part.");
pub(crate) const UPPER_DEG: Key<f64> =
    required("upper_deg", angle(), "Highest part; above the lowest.");
pub(crate) const TRACKING_S: Key<f64> = required("tracking_s", positive("s"), "Tracking time.");

static ANTI_WINDUP_TABLE: Table = of_kinds(
    "Anti-windup.",
    &[],
    &[
        variant(AntiWindupKind::None.name(), plain("The integral runs on.", &[])),
        variant(
            AntiWindupKind::Clamping.name(),
            plain(
                "The integral's part of the command is kept within limits.",
                &[&[&LOWER_DEG, &UPPER_DEG]],
            ),
        ),
        variant(
            AntiWindupKind::Conditional.name(),
            plain(
                "The integral stops while it would drive the command further past its limit.",
                &[],
            ),
        ),
        variant(
            AntiWindupKind::BackCalculation.name(),
            plain("The integral follows the limited command.", &[&[&TRACKING_S]]),
        ),
    ],
);

pub(crate) const SUPERVISOR: Key<Section> =
    required("supervisor", table(&SUPERVISOR_TABLE), "The fuzzy rules and their scales.");
pub(crate) const LAW: Key<LawWord> = defaulted(
    "law",
    word(),
    LawWord::Memoryless,
    "Gains are nominal plus increment, or add the increment up over time.",
);
pub(crate) const LEAKAGE_PER_S: Key<f64> = optional(
    "leakage_per_s",
    not_negative("1/s"),
    "Pulls the gains of the accumulating law back to nominal; 0 if left out.",
);
pub(crate) const GAIN_COUPLING: Key<Section> = optional(
    "gain_coupling",
    table(&GAIN_COUPLING_TABLE),
    "What moves with the gains; nothing if left out.",
);
pub(crate) const GAIN_LIMITS: Key<Section> = optional(
    "gain_limits",
    table(&GAIN_LIMITS_TABLE),
    "Bounds of the total gains; none if left out.",
);
pub(crate) const DEAD_ZONE: Key<Section> = optional(
    "dead_zone",
    table(&DEAD_ZONE_TABLE),
    "Where the supervisor stays silent; nowhere if left out.",
);

/// What a self-tuning controller has beyond a PID.
pub(crate) const TUNER: &[KeyRow] =
    &[&SUPERVISOR, &LAW, &LEAKAGE_PER_S, &GAIN_COUPLING, &GAIN_LIMITS, &DEAD_ZONE];

static SUPERVISOR_TABLE: Table = choosing(
    "The supervisor: it sees the error and something beside it, and answers increments of the gains.",
    &[
        &[&TABLE, &NUMBERS, &SYSTEM, &NETWORK, &RANGE, &DEFUZZIFIER, &OUT_OF_RANGE, &ERROR_SIGN],
        &[&ERROR_SCALE, &ERROR_SET_CENTRES, &SECOND_INPUT, &MODEL, &CHANGE],
        &[&CHANGE_SCALE, &CHANGE_SET_CENTRES, &OUTPUT_SCALE],
    ],
    &[one_of!(TABLE, NUMBERS, SYSTEM, NETWORK)],
);

pub(crate) const TABLE: Key<Rules<'static>> = optional(
    "table",
    rules(rule_table_names, &GRIDS_TABLE),
    "The rules: a name, a file, or the three grids themselves.",
);
pub(crate) const NUMBERS: Key<Section> = optional(
    "numbers",
    table(&NUMBER_GRIDS_TABLE),
    "Rules that conclude numbers (Takagi and Sugeno): the answer is interpolated between them.",
);
pub(crate) const SYSTEM: Key<str> = optional(
    "system",
    FILE_PATH,
    "A file with such rules (.toml, .fis, .t2fis, .fcl, .fll, .xml), as `fspid learn` writes it.",
);
pub(crate) const NETWORK: Key<Section> =
    optional("network", table(&NETWORK_TABLE), "No rules, but a small neural network.");
pub(crate) const RANGE: Key<f64> = required(
    "range",
    number("", Range::Between(1e-100, 1e100)),
    "Half range of inputs and outputs.",
);
pub(crate) const DEFUZZIFIER: Key<Defuzzifier> = optional(
    "defuzzifier",
    DEFUZZIFIER_NAME,
    "How the answer becomes a number; with `table` only, where it is \"exact\" if left out.",
);
pub(crate) const OUT_OF_RANGE: Key<OutOfRange> = defaulted(
    "out_of_range",
    word(),
    OutOfRange::Clamp,
    "What happens to an input beyond the range: moved to its end, evaluated as it is, or refused (the gains hold).",
);
pub(crate) const ERROR_SIGN: Key<ErrorSign> = defaulted(
    "error_sign",
    word(),
    ErrorSign::SetpointMinusMeasurement,
    "Sign of the supervisor's error and of its change.",
);
pub(crate) const ERROR_SCALE: Key<f64> = defaulted(
    "error_scale",
    finite("1/deg"),
    1.0,
    "The supervisor sees this times the error in degrees.",
);
pub(crate) const ERROR_SET_CENTRES: Key<(f64, f64)> = optional(
    "error_set_centres",
    interval("", Range::Between(0.0, 1.0)),
    "Centres of the small and the medium sets of the error, as parts of the range; a third and two thirds if left out. A network has none.",
);
pub(crate) const SECOND_INPUT: Key<SecondInputWord> = defaulted(
    "second_input",
    word(),
    SecondInputWord::Change,
    "Beside the error: its change, the measured pitch rate with its sign turned, or how far the pitch is behind a reference model.",
);
pub(crate) const MODEL: Key<Section> =
    optional("model", table(&MODEL_TABLE), "The reference model of `error-and-model-error`.");
pub(crate) const CHANGE: Key<Change> =
    defaulted("change", word(), Change::Rate, "Change of error per second or per sample.");
pub(crate) const CHANGE_SCALE: Key<f64> = defaulted(
    "change_scale",
    finite(""),
    1.0,
    "The supervisor sees this times the change in degrees per second or per sample, the pitch rate in degrees per second, or the model's error in degrees.",
);
pub(crate) const CHANGE_SET_CENTRES: Key<(f64, f64)> = optional(
    "change_set_centres",
    interval("", Range::Between(0.0, 1.0)),
    "As `error_set_centres`, of what is seen beside the error.",
);
pub(crate) const OUTPUT_SCALE: Key<Section> = optional(
    "output_scale",
    table(&OUTPUT_SCALE_TABLE),
    "Factors of the increments; 1 if left out.",
);

pub(crate) const BANDWIDTH_RAD_S: Key<f64> = required(
    "bandwidth_rad_s",
    positive("rad/s"),
    "Its natural frequency; at most half per sample.",
);
pub(crate) const DAMPING: Key<f64> =
    defaulted("damping", number("", Range::PositiveUpTo(1.5)), 1.0, "Its damping.");

static MODEL_TABLE: Table = plain(
    "A reference model of second order: how the pitch should follow the set-point.",
    &[&[&BANDWIDTH_RAD_S, &DAMPING]],
);

pub(crate) const SETPOINT_WEIGHT_PER_KP: Key<f64> = defaulted(
    "setpoint_weight_per_kp",
    finite(""),
    0.0,
    "Of the set-point weight in the proportional term, by the proportional gain.",
);
pub(crate) const RATE_GAIN_PER_KD: Key<f64> = defaulted(
    "rate_gain_per_kd",
    finite(""),
    0.0,
    "Of the gain of the inner loop, by the derivative gain.",
);

static GAIN_COUPLING_TABLE: Table = plain(
    "What moves with the gains, by how much per unit of their distance from nominal.",
    &[&[&SETPOINT_WEIGHT_PER_KP, &RATE_GAIN_PER_KD]],
);

pub(crate) const OUTPUT_SCALE_KP: Key<f64> =
    defaulted("kp", finite(""), 1.0, "Factor of the proportional gain's.");
pub(crate) const OUTPUT_SCALE_KI: Key<f64> =
    defaulted("ki", finite(""), 1.0, "Factor of the integral gain's.");
pub(crate) const OUTPUT_SCALE_KD: Key<f64> =
    defaulted("kd", finite(""), 1.0, "Factor of the derivative gain's.");

static OUTPUT_SCALE_TABLE: Table =
    plain("Factors of the increments.", &[&[&OUTPUT_SCALE_KP, &OUTPUT_SCALE_KI, &OUTPUT_SCALE_KD]]);

pub(crate) const KP_ENDS: [Key<f64>; 2] = [
    optional("kp_min", finite(""), "Lowest proportional gain."),
    optional("kp_max", finite(""), "Highest proportional gain."),
];
pub(crate) const KI_ENDS: [Key<f64>; 2] = [
    optional("ki_min", finite("1/s"), "Lowest integral gain."),
    optional("ki_max", finite("1/s"), "Highest integral gain."),
];
pub(crate) const KD_ENDS: [Key<f64>; 2] = [
    optional("kd_min", finite("s"), "Lowest derivative gain."),
    optional("kd_max", finite("s"), "Highest derivative gain."),
];

static GAIN_LIMITS_TABLE: Table = plain(
    "Lowest and highest total gains; an end that is left out is open.",
    &[&[&KP_ENDS[0], &KP_ENDS[1], &KI_ENDS[0], &KI_ENDS[1], &KD_ENDS[0], &KD_ENDS[1]]],
);

pub(crate) const ERROR_DEG: Key<f64> =
    required("error_deg", not_negative("deg"), "Error up to which it holds.");
pub(crate) const CHANGE_DEG_S: Key<f64> = required(
    "change_deg_s",
    not_negative("deg/s"),
    "Change up to which it holds; degrees per sample where change is `delta`, degrees where a model's error is seen.",
);

static DEAD_ZONE_TABLE: Table = plain(
    "Errors and changes so small that the increments are 0; both must be inside.",
    &[&[&ERROR_DEG, &CHANGE_DEG_S]],
);
