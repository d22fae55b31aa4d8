//! The keys of a fuzzy system's file, from which the check, the schema and the defaults come.

use crate::keyed::document::Item;
use crate::keyed::word::words_of;
use crate::keyed::{
    BOOLEAN, FREE_TEXT, Key, Range, Section, TEXT, Table, choosing, defaulted, interval, name_in,
    one_of, optional, own, plain, required, table, tables, whole, word,
};
use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{Defuzzifier, Sampling, SetReading};
use serde_json::{Value, json};

use super::{activation, conclusion, membership, norm, rules};

/// The word that tells a fuzzy system from a scenario.
pub(super) const WORD: &str = "fuzzy-system";

pub(crate) const SCHEMA: Key<i64> = required("schema", whole(1, 1), "Version of this format.");
pub(crate) const KIND: Key<str> = required("kind", name_in(&[WORD]), "What the file describes.");
pub(crate) const SYSTEM_NAME: Key<str> =
    optional("name", FREE_TEXT, "Name in answers and reports.");
pub(crate) const INPUT: Key<[Section]> = required(
    "input",
    tables(&INPUT_TABLE, 1, 1000),
    "What goes in, in the order in which values are given.",
);
pub(crate) const OUTPUT: Key<[Section]> = required(
    "output",
    tables(&OUTPUT_TABLE, 1, 1000),
    "What comes out, in the order of the answers.",
);
pub(crate) const RULES: Key<[Section]> = optional(
    "rules",
    tables(&RULES_TABLE, 0, 1000),
    "Blocks of rules that share their norms, worked through in order.",
);

/// The file as a whole.
pub(crate) static FUZZY_SYSTEM: Table = plain(
    "A fuzzy system: what goes in, what comes out, and the rules between them.",
    &[&[&SCHEMA, &KIND, &SYSTEM_NAME, &DESCRIPTION, &INPUT, &OUTPUT, &RULES]],
);

pub(crate) const DESCRIPTION: Key<str> =
    optional("description", FREE_TEXT, "What it is or stands for, in a sentence.");
pub(crate) const NAME: Key<str> =
    required("name", TEXT, "Name in rules and answers; each only once.");
pub(crate) const RANGE: Key<(f64, f64)> = optional(
    "range",
    interval("", Range::Finite),
    "Where the variable lives: lowest and highest value.",
);
pub(crate) const ENABLED: Key<bool> = defaulted(
    "enabled",
    BOOLEAN,
    true,
    "Whether it takes part; what is switched off stays in the file.",
);

pub(crate) const OUT_OF_RANGE: Key<OutOfRange> = defaulted(
    "out_of_range",
    word(),
    OutOfRange::Evaluate,
    "A value outside the range is moved to its end, taken as it is, or refused.",
);
pub(crate) const INPUT_TERMS: Key<Item> = optional(
    "terms",
    own(membership::terms_in_words, membership::terms_schema),
    "Fuzzy sets by name, in order.",
);

static INPUT_TABLE: Table =
    plain("An input.", &[&[&NAME, &DESCRIPTION, &ENABLED, &RANGE, &OUT_OF_RANGE, &INPUT_TERMS]]);

words_of!(SetReading { Tsukamoto = "tsukamoto", InverseTsukamoto = "inverse-tsukamoto" });

pub(crate) const CLAMP: Key<bool> =
    defaulted("clamp", BOOLEAN, false, "Whether an answer outside the range is moved to its end.");
pub(crate) const DEFUZZIFIER: Key<str> = defaulted(
    "defuzzifier",
    name_in(&Defuzzifier::NAMES),
    "centroid",
    "How the joined conclusions become a number.",
);
pub(crate) const SAMPLING: Key<Item> = optional(
    "sampling",
    own(sampling_in_words, sampling_schema),
    "How integrals are computed; exact if left out.",
);
pub(crate) const SET_READING: Key<SetReading> = defaulted(
    "set_reading",
    word(),
    SetReading::Tsukamoto,
    "Which number a weighted defuzzifier takes for a fuzzy set.",
);
pub(crate) const AGGREGATION: Key<Item> = optional(
    "aggregation",
    own(norm::or_in_words, norm::or_schema),
    "How the conclusions of several rules are joined; maximum if left out.",
);
pub(crate) const KEEP_PREVIOUS: Key<bool> = defaulted(
    "keep_previous",
    BOOLEAN,
    false,
    "Whether the previous answer stands where no rule fires.",
);
pub(crate) const FALLBACK: Key<Item> = optional(
    "fallback",
    own(fallback_in_words, fallback_schema),
    "The answer where no rule fires; none if left out.",
);
pub(crate) const OUTPUT_TERMS: Key<Item> = optional(
    "terms",
    own(conclusion::terms_in_words, conclusion::terms_schema),
    "What rules may conclude, by name, in order.",
);

static OUTPUT_TABLE: Table = plain(
    "An output.",
    &[
        &[&NAME, &DESCRIPTION, &ENABLED, &RANGE, &CLAMP, &DEFUZZIFIER, &SAMPLING],
        &[&SET_READING, &AGGREGATION, &KEEP_PREVIOUS, &FALLBACK, &OUTPUT_TERMS],
    ],
);

pub(crate) const BLOCK_NAME: Key<str> = optional("name", FREE_TEXT, "Name of the block.");
pub(crate) const AND: Key<Item> = optional(
    "and",
    own(norm::and_in_words, norm::and_schema),
    "What `and` means between statements; minimum if left out.",
);
pub(crate) const OR: Key<Item> = optional(
    "or",
    own(norm::or_in_words, norm::or_schema),
    "What `or` means between statements; maximum if left out.",
);
pub(crate) const IMPLICATION: Key<Item> = optional(
    "implication",
    own(norm::and_in_words, norm::and_schema),
    "How a rule's strength shapes its conclusion; minimum if left out.",
);
pub(crate) const ACTIVATION: Key<Item> = optional(
    "activation",
    own(activation::in_words, activation::schema),
    "Which rules act; all of them if left out.",
);
pub(crate) const LINES: Key<Item> =
    optional("lines", own(rules::in_words, rules::schema), "The rules in words, one a line.");
pub(crate) const TABLE: Key<Section> =
    optional("table", table(&GRIDS), "The rules of two inputs as grids of terms.");

static RULES_TABLE: Table = choosing(
    "A block of rules.",
    &[
        &[&BLOCK_NAME, &DESCRIPTION, &ENABLED, &AND, &OR, &IMPLICATION, &ACTIVATION],
        &[&LINES, &TABLE],
    ],
    &[one_of!(LINES, TABLE)],
);

pub(crate) const ROWS: Key<str> =
    required("rows", TEXT, "The input whose terms are the rows, from top to bottom.");
pub(crate) const COLUMNS: Key<str> =
    required("columns", TEXT, "The input whose terms are the columns, left to right.");
pub(crate) const CELLS: Key<Item> = required(
    "cells",
    own(rules::cells_in_words, rules::cells_schema),
    "For each output a grid of its terms; `-` stands for no rule.",
);

static GRIDS: Table =
    plain("Rules for every pair of terms of two inputs.", &[&[&ROWS, &COLUMNS, &CELLS]]);

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
