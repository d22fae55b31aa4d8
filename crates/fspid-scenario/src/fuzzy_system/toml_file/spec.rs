//! The keys of a fuzzy system's file, from which the check, the schema and the defaults come.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{Defuzzifier, Sampling, SetReading};
use serde_json::{Value, json};

use super::{activation, conclusion, membership, norm, rules};
use crate::file::spec::word::{Word, words_of};
use crate::file::spec::{
    Choice, Default, Key, Kind, Range, Table, Way, defaulted, optional, plain, required,
};

/// The word that tells a fuzzy system from a scenario.
pub(super) const KIND: &str = "fuzzy-system";

/// The file as a whole.
pub(crate) static FUZZY_SYSTEM: Table = plain(
    "A fuzzy system: what goes in, what comes out, and the rules between them.",
    &[&[
        required("schema", Kind::Integer { least: 1, most: 1 }, "Version of this format."),
        required("kind", Kind::Word(&[KIND]), "What the file describes."),
        optional("name", Kind::FreeText, "Name in answers and reports."),
        DESCRIPTION,
        required(
            "input",
            Kind::Tables { table: &INPUT, least: 1, most: 1000 },
            "What goes in, in the order in which values are given.",
        ),
        required(
            "output",
            Kind::Tables { table: &OUTPUT, least: 1, most: 1000 },
            "What comes out, in the order of the answers.",
        ),
        optional(
            "rules",
            Kind::Tables { table: &RULES, least: 0, most: 1000 },
            "Blocks of rules that share their norms, worked through in order.",
        ),
    ]],
);

const DESCRIPTION: Key =
    optional("description", Kind::FreeText, "What it is or stands for, in a sentence.");
const NAME: Key = required("name", Kind::Text, "Name in rules and answers; each only once.");
const RANGE: Key = optional(
    "range",
    Kind::Interval { unit: "", range: Range::Finite },
    "Where the variable lives: lowest and highest value.",
);
const ENABLED: Key = defaulted(
    "enabled",
    Kind::Boolean,
    Default::Boolean(true),
    "Whether it takes part; what is switched off stays in the file.",
);

static INPUT: Table = plain(
    "An input.",
    &[&[
        NAME,
        DESCRIPTION,
        ENABLED,
        RANGE,
        defaulted(
            "out_of_range",
            Kind::Word(OutOfRange::WORDS),
            Default::Word("evaluate"),
            "A value outside the range is moved to its end, taken as it is, or refused.",
        ),
        optional(
            "terms",
            Kind::Own { allowed: membership::terms_in_words, schema: membership::terms_schema },
            "Fuzzy sets by name, in order.",
        ),
    ]],
);

words_of!(SetReading { Tsukamoto = "tsukamoto", InverseTsukamoto = "inverse-tsukamoto" });

static OUTPUT: Table = plain(
    "An output.",
    &[&[
        NAME,
        DESCRIPTION,
        ENABLED,
        RANGE,
        defaulted(
            "clamp",
            Kind::Boolean,
            Default::Boolean(false),
            "Whether an answer outside the range is moved to its end.",
        ),
        defaulted(
            "defuzzifier",
            Kind::Word(&Defuzzifier::NAMES),
            Default::Word("centroid"),
            "How the joined conclusions become a number.",
        ),
        optional(
            "sampling",
            Kind::Own { allowed: sampling_in_words, schema: sampling_schema },
            "How integrals are computed; exact if left out.",
        ),
        defaulted(
            "set_reading",
            Kind::Word(SetReading::WORDS),
            Default::Word("tsukamoto"),
            "Which number a weighted defuzzifier takes for a fuzzy set.",
        ),
        optional(
            "aggregation",
            Kind::Own { allowed: norm::or_in_words, schema: norm::or_schema },
            "How the conclusions of several rules are joined; maximum if left out.",
        ),
        defaulted(
            "keep_previous",
            Kind::Boolean,
            Default::Boolean(false),
            "Whether the previous answer stands where no rule fires.",
        ),
        optional(
            "fallback",
            Kind::Own { allowed: fallback_in_words, schema: fallback_schema },
            "The answer where no rule fires; none if left out.",
        ),
        optional(
            "terms",
            Kind::Own { allowed: conclusion::terms_in_words, schema: conclusion::terms_schema },
            "What rules may conclude, by name, in order.",
        ),
    ]],
);

static RULES: Table = Table {
    doc: "A block of rules.",
    groups: &[&[
        optional("name", Kind::FreeText, "Name of the block."),
        DESCRIPTION,
        ENABLED,
        optional(
            "and",
            Kind::Own { allowed: norm::and_in_words, schema: norm::and_schema },
            "What `and` means between statements; minimum if left out.",
        ),
        optional(
            "or",
            Kind::Own { allowed: norm::or_in_words, schema: norm::or_schema },
            "What `or` means between statements; maximum if left out.",
        ),
        optional(
            "implication",
            Kind::Own { allowed: norm::and_in_words, schema: norm::and_schema },
            "How a rule's strength shapes its conclusion; minimum if left out.",
        ),
        optional(
            "activation",
            Kind::Own { allowed: activation::in_words, schema: activation::schema },
            "Which rules act; all of them if left out.",
        ),
        optional(
            "lines",
            Kind::Own { allowed: rules::in_words, schema: rules::schema },
            "The rules in words, one a line.",
        ),
        optional("table", Kind::Table(&TABLE), "The rules of two inputs as grids of terms."),
    ]],
    choices: &[Choice {
        ways: &[
            Way { required: &["lines"], optional: &[] },
            Way { required: &["table"], optional: &[] },
        ],
    }],
    variants: &[],
};

static TABLE: Table = plain(
    "Rules for every pair of terms of two inputs.",
    &[&[
        required("rows", Kind::Text, "The input whose terms are the rows, from top to bottom."),
        required("columns", Kind::Text, "The input whose terms are the columns, left to right."),
        required(
            "cells",
            Kind::Own { allowed: rules::cells_in_words, schema: rules::cells_schema },
            "For each output a grid of its terms; `-` stands for no rule.",
        ),
    ]],
);

pub(super) fn sampling_in_words() -> String {
    Sampling::NAMES.to_owned()
}

fn sampling_schema() -> Value {
    json!({
        "type": "string", "default": "exact",
        "pattern": "^(exact|(endpoints|midpoint|trapezoid|left-end|vertices):[0-9]+)$",
    })
}

pub(super) fn fallback_in_words() -> String {
    "\"none\", \"middle\" or a finite number".to_owned()
}

fn fallback_schema() -> Value {
    json!({ "oneOf": [{ "enum": ["none", "middle"] }, { "type": "number" }], "default": "none" })
}
