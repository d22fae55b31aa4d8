//! What responses must meet: requirements in a scenario, in a file of their own, and in ready sets.

use super::{
    Choice, Key, Kind, Range, Table, Way, not_negative, optional, plain, positive, required,
};
use crate::measure::Measure;
use crate::requirement::{Air, Confidence, set_names};

/// Words for the speed that a set is asked at.
pub(crate) const SPEEDS: [&str; 4] = ["normal", "below", "limit", "beyond"];
/// Words for the category of flight.
pub(crate) const CATEGORIES: [&str; 3] = ["A", "B", "C"];

pub(super) const MEASURE: Kind = Kind::Word(&Measure::NAMES);
const MEASURE_DOC: &str = "What is measured; `fspid verify --help` lists all. The worst step, plant or frozen gain counts.";
const LEVEL: Kind = Kind::Integer { least: 1, most: 3 };

/// Limits.
pub(super) const LIMITS: &[Key] = &[
    optional(
        "least",
        not_negative(""),
        "Smallest value that is met, in the unit of the measure; the limit itself is met.",
    ),
    optional("most", not_negative(""), "Largest value that is met, in the unit of the measure."),
];

/// What counts.
pub(super) const CONDITIONS: &[Key] = &[
    optional(
        "step_deg",
        positive("deg"),
        "Only steps of the command of this size count; without one the requirement is not met.",
    ),
    optional("within_deg", positive("deg"), "Band about the set-point, for recovery_time_s."),
    optional("from_s", not_negative("s"), "Start of the time that counts."),
    optional("to_s", positive("s"), "End of the time that counts."),
    optional("from_hz", not_negative("Hz"), "Lowest frequency that counts."),
    optional("to_hz", positive("Hz"), "Frequency from which on nothing counts."),
];

const AIR: Kind = Kind::Word(&Air::NAMES);

/// Where a requirement is from.
const ORIGIN: &[Key] = &[
    optional("clause", Kind::Text, "Clause of its source."),
    optional("source", Kind::Text, "Where it is from."),
    optional("confidence", Kind::Word(&Confidence::NAMES), CONFIDENCE_DOC),
    optional("note", Kind::Text, "What else should be known."),
];
const CONFIDENCE_DOC: &str = "How sure its numbers are: read in the source, quoted by another document, transcribed by several, disputed among them, recalled and not read again, or the project's own.";

const ASKED: &[Key] = &[
    optional(
        "id",
        Kind::Text,
        "What it is called in answers; the name of the measure if left out.",
    ),
    optional("measure", MEASURE, MEASURE_DOC),
];

const OF_SET: &[Key] = &[
    optional("set", Kind::Preset(set_names), "A ready set in place of a measure."),
    optional("level", LEVEL, "Level of flying qualities, for mil-f-8785c; 1 if left out."),
    optional(
        "category",
        Kind::Word(&CATEGORIES),
        "Category of flight, for mil-f-8785c; \"B\" if left out.",
    ),
    optional(
        "speed",
        Kind::Word(&SPEEDS),
        "Speed, for mil-f-9490d: normal operation (also if left out), below its lowest speed, at the limit speed, beyond it.",
    ),
    optional(
        "first_aeroelastic_mode_hz",
        Kind::Number { unit: "Hz", range: Range::Positive },
        "First aeroelastic mode, for mil-f-9490d; the aircraft is rigid if left out.",
    ),
];

/// Asked of a controller, in one air.
const WHERE: &[Key] = &[
    optional(
        "air",
        AIR,
        "The air that it is asked in: for a measure any, for a set \"smooth\" if left out.",
    ),
    optional("controller", Kind::Text, "Name of the controller; all of them if it is left out."),
    optional(
        ONLY_IN,
        Kind::Own { allowed: names_in_words, schema: names_schema },
        "Names of cases of [tuning] and [contest], or of their groups: it is asked in these alone, and not of the scenario as it is written.",
    ),
    optional(
        NOT_IN,
        Kind::Own { allowed: names_in_words, schema: names_schema },
        "Names of cases or groups in which it is not asked.",
    ),
];

/// Keys that say in which cases a requirement is asked.
pub(crate) const ONLY_IN: &str = "only_in";
pub(crate) const NOT_IN: &str = "not_in";

pub(crate) fn names_in_words() -> String {
    "a list of names of [[tuning.case]] and [[contest.case]], or of their groups".to_owned()
}

fn names_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 })
}

/// Keys that go with `measure`.
const WITH_MEASURE: &[&str] = &[
    "id",
    "least",
    "most",
    "step_deg",
    "within_deg",
    "from_s",
    "to_s",
    "from_hz",
    "to_hz",
    "clause",
    "source",
    "confidence",
    "note",
];

/// Keys that go with `set`.
const WITH_SET: &[&str] = &["level", "category", "speed", "first_aeroelastic_mode_hz"];

/// A requirement of a scenario.
pub(super) static REQUIREMENT: Table = Table {
    doc: "Limits of a measure that every controller, or one, must meet; or a ready set of them.",
    groups: &[ASKED, LIMITS, CONDITIONS, ORIGIN, OF_SET, WHERE],
    choices: &[Choice {
        ways: &[
            Way { required: &["measure"], optional: WITH_MEASURE },
            Way { required: &["set"], optional: WITH_SET },
        ],
    }],
    variants: &[],
};

/// A file of requirements outside of any scenario; its entries are checked with those of the scenario.
pub(crate) static REQUIREMENT_FILE: Table = plain(
    "Requirements that several scenarios share.",
    &[&[
        optional("schema", Kind::Integer { least: 1, most: 1 }, "Version of this format."),
        optional("name", Kind::Text, "What they are called."),
        required(
            "requirement",
            Kind::Own { allowed: entries_in_words, schema: entries_schema },
            "The requirements.",
        ),
    ]],
);

fn entries_in_words() -> String {
    "tables under [[requirement]] in double brackets".to_owned()
}

fn entries_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array" })
}

/// A ready set.
pub(crate) static SET_FILE: Table = plain(
    "A set of requirements.",
    &[&[
        required("name", Kind::Text, "Name in scenarios."),
        required("title", Kind::Text, "What it is, in a line."),
        required("source", Kind::Text, "Where it is from."),
        optional("notes", Kind::Text, "What else should be known, and what is not in it."),
        required("line", Kind::Tables { table: &LINE, least: 1, most: 1000 }, "Its lines."),
    ]],
);

static LINE: Table = plain(
    "A requirement, and when it is asked.",
    &[
        &[
            required("id", Kind::Text, "What it is called."),
            required("measure", MEASURE, MEASURE_DOC),
            required("clause", Kind::Text, "Clause of its source."),
            required("source", Kind::Text, "Where it is from."),
            required("confidence", Kind::Word(&Confidence::NAMES), CONFIDENCE_DOC),
            optional("note", Kind::Text, "What else should be known."),
        ],
        LIMITS,
        CONDITIONS,
        &[
            optional("air", AIR, "Only in this air."),
            optional("level", LEVEL, "Only at this level."),
            optional("category", Kind::Word(&CATEGORIES), "Only in this category."),
            optional("speed", Kind::Word(&SPEEDS), "Only at this speed."),
            optional(
                "below_aeroelastic_mode",
                Kind::Boolean,
                "Only frequencies below the first aeroelastic mode count.",
            ),
            optional(
                "above_aeroelastic_mode",
                Kind::Boolean,
                "Only frequencies from the first aeroelastic mode on count.",
            ),
        ],
    ],
);
