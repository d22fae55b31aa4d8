//! The controllers.

use super::data::{GRIDS, NUMBER_GRIDS};
use fspid_core::{Change, ErrorSign, IntegralForm};
use fspid_fuzzy::OutOfRange;

use super::lqi::LQI;
use super::schedule::SCHEDULE;
use super::word::{Word, words, words_of};
use super::{
    ANGLE_LIMIT_DEG, Choice, Default, Key, Kind, Range, Table, Variant, Way, angle, defaulted,
    finite, not_negative, optional, plain, positive, required,
};

words! {
    /// What controls.
    ControllerKind { P = "p", Pid = "pid", Fspid = "fspid", Lqi = "lqi" }
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

pub(super) static CONTROLLER: Table = Table {
    doc: "A controller; a positive command turns the nose up.",
    groups: &[&[required("name", Kind::Text, "Name in traces and reports; each only once.")]],
    choices: &[],
    variants: &[
        Variant {
            name: ControllerKind::P.name(),
            table: plain(
                "Proportional, with an optional inner loop of pitch rate.",
                &[&[required("kp", finite(""), "Command per error."), RATE_GAIN, SCHEDULE]],
            ),
        },
        Variant {
            name: ControllerKind::Pid.name(),
            table: Table {
                doc: "PID with fixed gains, in parallel or ISA form.",
                groups: &[
                    &[
                        optional("kp", finite(""), "Proportional gain, command per error."),
                        optional("ki", finite("1/s"), "Integral gain; 0 if left out."),
                        optional("kd", finite("s"), "Derivative gain; 0 if left out."),
                        optional("isa", Kind::Table(&ISA), "The gains in ISA form."),
                        SCHEDULE,
                    ],
                    TERMS,
                    ENDS,
                ],
                choices: &[Choice {
                    ways: &[
                        Way { required: &["kp"], optional: &["ki", "kd"] },
                        Way { required: &["isa"], optional: &[] },
                    ],
                }],
                variants: &[],
            },
        },
        Variant {
            name: ControllerKind::Fspid.name(),
            table: Table {
                doc: "PID whose gains a fuzzy supervisor tunes while flying.",
                groups: &[
                    &[
                        optional(
                            "nominal",
                            Kind::Table(&PARALLEL),
                            "The gains that the supervisor adds to.",
                        ),
                        optional("nominal_isa", Kind::Table(&ISA), "The same in ISA form."),
                    ],
                    TUNER,
                    TERMS,
                    ENDS,
                ],
                choices: &[Choice {
                    ways: &[
                        Way { required: &["nominal"], optional: &[] },
                        Way { required: &["nominal_isa"], optional: &[] },
                    ],
                }],
                variants: &[],
            },
        },
        Variant {
            name: ControllerKind::Lqi.name(),
            table: plain(
                "Linear-quadratic regulator with integral action, of a model of pitching.",
                &[LQI, ENDS],
            ),
        },
    ],
};

const RATE_GAIN: Key = defaulted(
    "rate_gain",
    finite("s"),
    Default::Number(0.0),
    "Gain of the inner loop: command per pitch rate, taken off.",
);

static PARALLEL: Table = plain(
    "Gains in parallel form.",
    &[&[
        required("kp", finite(""), "Proportional gain, command per error."),
        defaulted("ki", finite("1/s"), Default::Number(0.0), "Integral gain."),
        defaulted("kd", finite("s"), Default::Number(0.0), "Derivative gain."),
    ]],
);

static ISA: Table = plain(
    "Gains in ISA form: gain · (e + ∫e dt / ti_s + td_s · de/dt).",
    &[&[
        required("gain", finite(""), "K, command per error."),
        optional("ti_s", positive("s"), "Integral time; no integral if left out."),
        defaulted("td_s", not_negative("s"), Default::Number(0.0), "Derivative time."),
        optional(
            "n",
            positive(""),
            "The derivative is filtered with time constant td_s / n; not at all if left out.",
        ),
    ]],
);

/// How the terms of a PID controller are formed.
const TERMS: &[Key] = &[
    RATE_GAIN,
    optional(
        "setpoint_weights",
        Kind::Table(&WEIGHTS),
        "How much of the set-point each term sees.",
    ),
    defaulted(
        "derivative_on",
        Kind::Word(DerivativeOn::WORDS),
        Default::Word("error"),
        "`measurement` is a derivative weight of 0.",
    ),
    optional(
        "derivative_filter_s",
        not_negative("s"),
        "Time constant of the derivative's filter; 0 for none, which is also the default.",
    ),
    defaulted(
        "integral",
        Kind::Word(IntegralForm::WORDS),
        Default::Word("bumpless"),
        "Sum of ki·e, or ki times the sum of e as the paper has it.",
    ),
];

/// Where a controller with an integral ends: its limits, and which samples it believes.
const ENDS: &[Key] = &[
    optional(
        "anti_windup",
        Kind::Table(&ANTI_WINDUP),
        "What the integral does at a limit; nothing if left out.",
    ),
    optional(
        "output_limits_deg",
        Kind::Interval { unit: "deg", range: Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG) },
        "Lowest and highest command.",
    ),
    optional("slew_limit_deg_s", positive("deg/s"), "Largest rate of the command."),
    defaulted(
        "sample_guard_deg",
        Kind::Number { unit: "deg", range: Range::PositiveUpTo(1e300) },
        Default::Number(1e9),
        "A larger sample is not believed: the command is held.",
    ),
];

static WEIGHTS: Table = plain(
    "Set-point weights.",
    &[&[
        defaulted(
            "proportional",
            finite(""),
            Default::Number(1.0),
            "Weight in the proportional term.",
        ),
        optional(
            "derivative",
            finite(""),
            "Weight in the derivative term; if left out 1, or 0 where derivative_on is `measurement`.",
        ),
    ]],
);

static ANTI_WINDUP: Table = Table {
    doc: "Anti-windup.",
    groups: &[],
    choices: &[],
    variants: &[
        Variant { name: AntiWindupKind::None.name(), table: plain("The integral runs on.", &[]) },
        Variant {
            name: AntiWindupKind::Clamping.name(),
            table: plain(
                "The integral's part of the command is kept within limits.",
                &[&[
                    required("lower_deg", angle(), "Lowest part."),
                    required("upper_deg", angle(), "Highest part; above the lowest."),
                ]],
            ),
        },
        Variant {
            name: AntiWindupKind::Conditional.name(),
            table: plain(
                "The integral stops while it would drive the command further past its limit.",
                &[],
            ),
        },
        Variant {
            name: AntiWindupKind::BackCalculation.name(),
            table: plain(
                "The integral follows the limited command.",
                &[&[required("tracking_s", positive("s"), "Tracking time.")]],
            ),
        },
    ],
};

/// What a self-tuning controller has beyond a PID.
const TUNER: &[Key] = &[
    required("supervisor", Kind::Table(&SUPERVISOR), "The fuzzy rules and their scales."),
    defaulted(
        "law",
        Kind::Word(LawWord::WORDS),
        Default::Word("memoryless"),
        "Gains are nominal plus increment, or add the increment up over time.",
    ),
    optional(
        "leakage_per_s",
        not_negative("1/s"),
        "Pulls the gains of the accumulating law back to nominal; 0 if left out.",
    ),
    optional(
        "gain_coupling",
        Kind::Table(&GAIN_COUPLING),
        "What moves with the gains; nothing if left out.",
    ),
    optional(
        "gain_limits",
        Kind::Table(&GAIN_LIMITS),
        "Bounds of the total gains; none if left out.",
    ),
    optional(
        "dead_zone",
        Kind::Table(&DEAD_ZONE),
        "Where the supervisor stays silent; nowhere if left out.",
    ),
];

static SUPERVISOR: Table = Table {
    doc: "The supervisor: it sees the error and something beside it, and answers increments of the gains.",
    groups: &[SUPERVISOR_KEYS],
    choices: &[one_of!("table", "numbers", "system")],
    variants: &[],
};

const SUPERVISOR_KEYS: &[Key] = &[
    optional(
        "table",
        Kind::Rules(&GRIDS),
        "The rules: a name, a file, or the three grids themselves.",
    ),
    optional(
        "numbers",
        Kind::Table(&NUMBER_GRIDS),
        "Rules that conclude numbers (Takagi and Sugeno): the answer is interpolated between them.",
    ),
    optional(
        "system",
        Kind::Path,
        "A file with such rules (.toml, .fis, .t2fis, .fcl, .fll, .xml), as `fspid learn` writes it.",
    ),
    required(
        "range",
        Kind::Number { unit: "", range: Range::Between(1e-100, 1e100) },
        "Half range of inputs and outputs.",
    ),
    optional(
        "defuzzifier",
        Kind::Defuzzifier,
        "How the answer becomes a number; with `table` only, where it is \"exact\" if left out.",
    ),
    defaulted(
        "out_of_range",
        Kind::Word(OutOfRange::WORDS),
        Default::Word("clamp"),
        "What happens to an input beyond the range: moved to its end, evaluated as it is, or refused (the gains hold).",
    ),
    defaulted(
        "error_sign",
        Kind::Word(ErrorSign::WORDS),
        Default::Word("setpoint-minus-measurement"),
        "Sign of the supervisor's error and of its change.",
    ),
    defaulted(
        "error_scale",
        finite("1/deg"),
        Default::Number(1.0),
        "The supervisor sees this times the error in degrees.",
    ),
    optional(
        "error_set_centres",
        Kind::Interval { unit: "", range: Range::Between(0.0, 1.0) },
        "Centres of the small and the medium sets of the error, as parts of the range; a third and two thirds if left out.",
    ),
    defaulted(
        "second_input",
        Kind::Word(SecondInputWord::WORDS),
        Default::Word("error-and-change"),
        "Beside the error: its change, the measured pitch rate with its sign turned, or how far the pitch is behind a reference model.",
    ),
    optional("model", Kind::Table(&MODEL), "The reference model of `error-and-model-error`."),
    defaulted(
        "change",
        Kind::Word(Change::WORDS),
        Default::Word("rate"),
        "Change of error per second or per sample.",
    ),
    defaulted(
        "change_scale",
        finite(""),
        Default::Number(1.0),
        "The supervisor sees this times the change in degrees per second or per sample, the pitch rate in degrees per second, or the model's error in degrees.",
    ),
    optional(
        "change_set_centres",
        Kind::Interval { unit: "", range: Range::Between(0.0, 1.0) },
        "As `error_set_centres`, of what is seen beside the error.",
    ),
    optional(
        "output_scale",
        Kind::Table(&OUTPUT_SCALE),
        "Factors of the increments; 1 if left out.",
    ),
];

static MODEL: Table = plain(
    "A reference model of second order: how the pitch should follow the set-point.",
    &[&[
        required(
            "bandwidth_rad_s",
            positive("rad/s"),
            "Its natural frequency; at most half per sample.",
        ),
        defaulted(
            "damping",
            Kind::Number { unit: "", range: Range::PositiveUpTo(1.5) },
            Default::Number(1.0),
            "Its damping.",
        ),
    ]],
);

static GAIN_COUPLING: Table = plain(
    "What moves with the gains, by how much per unit of their distance from nominal.",
    &[&[
        defaulted(
            "setpoint_weight_per_kp",
            finite(""),
            Default::Number(0.0),
            "Of the set-point weight in the proportional term, by the proportional gain.",
        ),
        defaulted(
            "rate_gain_per_kd",
            finite(""),
            Default::Number(0.0),
            "Of the gain of the inner loop, by the derivative gain.",
        ),
    ]],
);

static OUTPUT_SCALE: Table = plain(
    "Factors of the increments.",
    &[&[
        defaulted("kp", finite(""), Default::Number(1.0), "Factor of the proportional gain's."),
        defaulted("ki", finite(""), Default::Number(1.0), "Factor of the integral gain's."),
        defaulted("kd", finite(""), Default::Number(1.0), "Factor of the derivative gain's."),
    ]],
);

static GAIN_LIMITS: Table = plain(
    "Lowest and highest total gains; an end that is left out is open.",
    &[&[
        optional("kp_min", finite(""), "Lowest proportional gain."),
        optional("kp_max", finite(""), "Highest proportional gain."),
        optional("ki_min", finite("1/s"), "Lowest integral gain."),
        optional("ki_max", finite("1/s"), "Highest integral gain."),
        optional("kd_min", finite("s"), "Lowest derivative gain."),
        optional("kd_max", finite("s"), "Highest derivative gain."),
    ]],
);

static DEAD_ZONE: Table = plain(
    "Errors and changes so small that the increments are 0; both must be inside.",
    &[&[
        required("error_deg", not_negative("deg"), "Error up to which it holds."),
        required(
            "change_deg_s",
            not_negative("deg/s"),
            "Change up to which it holds; degrees per sample where change is `delta`, degrees where a model's error is seen.",
        ),
    ]],
);
