//! Rules: in words, as tables, or as grids for every pair of terms of two inputs.

mod grid;
mod lines;
mod tree;

use fspid_formats::rule_text::RuleReader;
use fspid_fuzzy::system::{Input, Output, Parts, Rule, RuleBlock};
use serde_json::{Value, json};

use super::spec::{LINES, TABLE};
use crate::keyed::Section;
use fspid_diagnostics::{Report, Span};

pub(super) use grid::in_words as cells_in_words;

/// The variables that rules may name.
#[derive(Clone, Copy)]
pub(super) struct Vocabulary<'a> {
    pub(super) inputs: &'a [Input],
    pub(super) outputs: &'a [Output],
    pub(super) reader: &'a RuleReader,
}

/// The rules of a block with their places.
pub(super) fn read(
    report: &mut Report,
    block: &Section,
    vocabulary: Vocabulary<'_>,
) -> Option<Vec<(Rule, Span)>> {
    if let Some(table) = block.get(TABLE) {
        return grid::read(report, table, vocabulary);
    }
    lines::read(report, block.get(LINES)?, &block.path(LINES), vocabulary)
}

/// The rules of a block as they are written: as grids where they fill a table, else line by line.
pub(super) fn write(block: &RuleBlock, parts: &Parts) -> String {
    grid::write(block, parts).unwrap_or_else(|| lines::write(block, parts))
}

pub(super) fn in_words() -> String {
    "rules such as \"if service is poor then tip is cheap\": a list of texts, or a text with one rule a line"
        .to_owned()
}

pub(super) fn schema() -> Value {
    let text = json!({ "type": "string" });
    let condition = json!({ "oneOf": [{ "const": "always" }, { "type": "object" }] });
    let properties = json!({
        "name": text, "enabled": { "type": "boolean", "default": true }, "rule": text,
        "when": condition, "then": { "type": "array", "items": { "type": "object" } },
        "weight": { "type": "number", "minimum": 0, "maximum": 1, "default": 1 },
    });
    let table = json!({
        "type": "object", "properties": properties, "additionalProperties": false,
        "oneOf": [{ "required": ["rule"] }, { "required": ["when", "then"] }],
    });
    json!({ "oneOf": [text, { "type": "array", "items": { "oneOf": [text, table] } }] })
}

pub(super) fn cells_schema() -> Value {
    json!({ "type": "object", "additionalProperties": { "type": "string" } })
}
