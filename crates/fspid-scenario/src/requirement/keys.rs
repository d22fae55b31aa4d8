//! What responses must meet: requirements in a scenario, in a file of their own, and in ready sets.

use super::{Air, Confidence, set_names};
use crate::keyed::document::Item;
use crate::keyed::word::Word;
use crate::keyed::{
    BOOLEAN, Choice, Key, KeyName, KeyRow, Range, Section, TEXT, Table, Way, carried, choosing,
    finite, name_in, not_negative, number, optional, own, plain, positive, required, tables, whole,
    word,
};
use crate::measure::Measure;

impl Word for Measure {
    const WORDS: &'static [&'static str] = &Self::NAMES;
    const ALL: &'static [Self] = &Self::ALL;

    fn word(self) -> &'static str {
        self.name()
    }
}

impl Word for Air {
    const WORDS: &'static [&'static str] = &Self::NAMES;
    const ALL: &'static [Self] = &[Self::Smooth, Self::Turbulent];

    fn word(self) -> &'static str {
        self.name()
    }
}

impl Word for Confidence {
    const WORDS: &'static [&'static str] = &Self::NAMES;
    const ALL: &'static [Self] = &Self::ALL;

    fn word(self) -> &'static str {
        self.name()
    }
}

/// Words for the speed that a set is asked at.
pub(crate) const SPEEDS: [&str; 4] = ["normal", "below", "limit", "beyond"];
/// Words for the category of flight.
pub(crate) const CATEGORIES: [&str; 3] = ["A", "B", "C"];

const MEASURE_DOC: &str = "What is measured; `fspid verify --help` lists all. The worst step, plant or frozen gain counts.";

pub(crate) const LEAST: Key<f64> = optional(
    "least",
    finite(""),
    "Smallest value that is met, in the unit of the measure; the limit itself is met. Below 0 only for a measure that can be.",
);
pub(crate) const MOST: Key<f64> =
    optional("most", finite(""), "Largest value that is met, in the unit of the measure.");

/// Limits.
pub(crate) const LIMITS: &[KeyRow] = &[&LEAST, &MOST];

pub(crate) const STEP_DEG: Key<f64> = optional(
    "step_deg",
    positive("deg"),
    "Only steps of the command of this size count; without one the requirement is not met.",
);
pub(crate) const WITHIN_DEG: Key<f64> =
    optional("within_deg", positive("deg"), "Band about the set-point, for recovery_time_s.");
pub(crate) const FROM_S: Key<f64> =
    optional("from_s", not_negative("s"), "Start of the time that counts.");
pub(crate) const TO_S: Key<f64> = optional("to_s", positive("s"), "End of the time that counts.");
pub(crate) const FROM_HZ: Key<f64> =
    optional("from_hz", not_negative("Hz"), "Lowest frequency that counts.");
pub(crate) const TO_HZ: Key<f64> =
    optional("to_hz", positive("Hz"), "Frequency from which on nothing counts.");
pub(crate) const TARGET_FT: Key<f64> = optional(
    "target_ft",
    finite("ft"),
    "Altitude that is aimed at; for altitude_loss_ft and altitude_deviation_ft that of the start if left out.",
);
pub(crate) const TARGET_M: Key<f64> =
    optional("target_m", finite("m"), "The same in metres, in its place.");

/// What counts.
pub(crate) const CONDITIONS: &[KeyRow] =
    &[&STEP_DEG, &WITHIN_DEG, &FROM_S, &TO_S, &FROM_HZ, &TO_HZ, &TARGET_FT, &TARGET_M];

pub(crate) const CLAUSE: Key<str> = optional("clause", TEXT, "Clause of its source.");
pub(crate) const SOURCE: Key<str> = optional("source", TEXT, "Where it is from.");
pub(crate) const CONFIDENCE: Key<Confidence> = optional("confidence", word(), CONFIDENCE_DOC);
pub(crate) const NOTE: Key<str> = optional("note", TEXT, "What else should be known.");

/// Where a requirement is from.
const ORIGIN: &[KeyRow] = &[&CLAUSE, &SOURCE, &CONFIDENCE, &NOTE];
const CONFIDENCE_DOC: &str = "How sure its numbers are: read in the source, quoted by another document, transcribed by several, disputed among them, recalled and not read again, or the project's own.";

pub(crate) const ID: Key<str> =
    optional("id", TEXT, "What it is called in answers; the name of the measure if left out.");
pub(crate) const MEASURE: Key<Measure> = optional("measure", word(), MEASURE_DOC);

const ASKED: &[KeyRow] = &[&ID, &MEASURE];

pub(crate) const SET: Key<str> =
    optional("set", carried(set_names), "A ready set in place of a measure.");
pub(crate) const LEVEL: Key<i64> =
    optional("level", whole(1, 3), "Level of flying qualities, for mil-f-8785c; 1 if left out.");
pub(crate) const CATEGORY: Key<str> = optional(
    "category",
    name_in(&CATEGORIES),
    "Category of flight, for mil-f-8785c; \"B\" if left out.",
);
pub(crate) const SPEED: Key<str> = optional(
    "speed",
    name_in(&SPEEDS),
    "Speed, for mil-f-9490d: normal operation (also if left out), below its lowest speed, at the limit speed, beyond it.",
);
pub(crate) const FIRST_AEROELASTIC_MODE_HZ: Key<f64> = optional(
    "first_aeroelastic_mode_hz",
    number("Hz", Range::Positive),
    "First aeroelastic mode, for mil-f-9490d; the aircraft is rigid if left out.",
);

const OF_SET: &[KeyRow] = &[&SET, &LEVEL, &CATEGORY, &SPEED, &FIRST_AEROELASTIC_MODE_HZ];

pub(crate) const AIR: Key<Air> = optional(
    "air",
    word(),
    "The air that it is asked in: for a measure any, for a set \"smooth\" if left out.",
);
pub(crate) const CONTROLLER: Key<str> =
    optional("controller", TEXT, "Name of the controller; all of them if it is left out.");
pub(crate) const ONLY_IN: Key<Item> = optional(
    "only_in",
    own(names_in_words, names_schema),
    "Names of cases of [tuning] and [contest], or of their groups: it is asked in these alone, and not of the scenario as it is written.",
);
pub(crate) const NOT_IN: Key<Item> = optional(
    "not_in",
    own(names_in_words, names_schema),
    "Names of cases or groups in which it is not asked.",
);

/// Asked of a controller, in one air.
const WHERE: &[KeyRow] = &[&AIR, &CONTROLLER, &ONLY_IN, &NOT_IN];

pub(crate) fn names_in_words() -> String {
    "a list of names of [[tuning.case]] and [[contest.case]], or of their groups".to_owned()
}

fn names_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 })
}

/// Keys that go with `measure`.
const WITH_MEASURE: &[KeyName] = &[
    ID.name,
    LEAST.name,
    MOST.name,
    STEP_DEG.name,
    WITHIN_DEG.name,
    FROM_S.name,
    TO_S.name,
    FROM_HZ.name,
    TO_HZ.name,
    CLAUSE.name,
    SOURCE.name,
    CONFIDENCE.name,
    NOTE.name,
];

/// Keys that go with `set`.
const WITH_SET: &[KeyName] =
    &[LEVEL.name, CATEGORY.name, SPEED.name, FIRST_AEROELASTIC_MODE_HZ.name];

/// A requirement of a scenario.
pub(crate) static REQUIREMENT_TABLE: Table = choosing(
    "Limits of a measure that every controller, or one, must meet; or a ready set of them.",
    &[ASKED, LIMITS, CONDITIONS, ORIGIN, OF_SET, WHERE],
    &[Choice {
        ways: &[
            Way { required: &[MEASURE.name], optional: WITH_MEASURE },
            Way { required: &[SET.name], optional: WITH_SET },
        ],
    }],
);

pub(crate) const SCHEMA: Key<i64> = optional("schema", whole(1, 1), "Version of this format.");
pub(crate) const FILE_NAME: Key<str> = optional("name", TEXT, "What they are called.");
pub(crate) const REQUIREMENT: Key<Item> =
    required("requirement", own(entries_in_words, entries_schema), "The requirements.");

/// A file of requirements outside of any scenario; its entries are checked with those of the scenario.
pub(crate) static REQUIREMENT_FILE: Table =
    plain("Requirements that several scenarios share.", &[&[&SCHEMA, &FILE_NAME, &REQUIREMENT]]);

fn entries_in_words() -> String {
    "tables under [[requirement]] in double brackets".to_owned()
}

fn entries_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array" })
}

pub(crate) const SET_NAME: Key<str> = required("name", TEXT, "Name in scenarios.");
pub(crate) const TITLE: Key<str> = required("title", TEXT, "What it is, in a line.");
pub(crate) const SET_SOURCE: Key<str> = required("source", TEXT, "Where it is from.");
pub(crate) const NOTES: Key<str> =
    optional("notes", TEXT, "What else should be known, and what is not in it.");
pub(crate) const LINE: Key<[Section]> =
    required("line", tables(&LINE_TABLE, 1, 1000), "Its lines.");

/// A ready set.
pub(crate) static SET_FILE: Table =
    plain("A set of requirements.", &[&[&SET_NAME, &TITLE, &SET_SOURCE, &NOTES, &LINE]]);

pub(crate) const LINE_ID: Key<str> = required("id", TEXT, "What it is called.");
pub(crate) const LINE_MEASURE: Key<Measure> = required("measure", word(), MEASURE_DOC);
pub(crate) const LINE_CLAUSE: Key<str> = required("clause", TEXT, "Clause of its source.");
pub(crate) const LINE_SOURCE: Key<str> = required("source", TEXT, "Where it is from.");
pub(crate) const LINE_CONFIDENCE: Key<Confidence> = required("confidence", word(), CONFIDENCE_DOC);
pub(crate) const LINE_AIR: Key<Air> = optional("air", word(), "Only in this air.");
pub(crate) const LINE_LEVEL: Key<i64> = optional("level", whole(1, 3), "Only at this level.");
pub(crate) const LINE_CATEGORY: Key<str> =
    optional("category", name_in(&CATEGORIES), "Only in this category.");
pub(crate) const LINE_SPEED: Key<str> = optional("speed", name_in(&SPEEDS), "Only at this speed.");
pub(crate) const BELOW_AEROELASTIC_MODE: Key<bool> = optional(
    "below_aeroelastic_mode",
    BOOLEAN,
    "Only frequencies below the first aeroelastic mode count.",
);
pub(crate) const ABOVE_AEROELASTIC_MODE: Key<bool> = optional(
    "above_aeroelastic_mode",
    BOOLEAN,
    "Only frequencies from the first aeroelastic mode on count.",
);

static LINE_TABLE: Table = plain(
    "A requirement, and when it is asked.",
    &[
        &[&LINE_ID, &LINE_MEASURE, &LINE_CLAUSE, &LINE_SOURCE, &LINE_CONFIDENCE, &NOTE],
        LIMITS,
        CONDITIONS,
        &[&LINE_AIR, &LINE_LEVEL, &LINE_CATEGORY, &LINE_SPEED, &BELOW_AEROELASTIC_MODE],
        &[&ABOVE_AEROELASTIC_MODE],
    ],
);
