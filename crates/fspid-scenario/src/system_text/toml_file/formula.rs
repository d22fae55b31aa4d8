//! Formulas, whose mistakes are told at their own column.

use fspid_fuzzy::formula::Formula;
use serde_json::{Value, json};

use super::fields::{Fields, below};
use fspid_diagnostics::Span;

/// The formula at a key that must be there, in these variables.
pub(super) fn formula(fields: &mut Fields<'_>, name: &str, variables: &[&str]) -> Option<Formula> {
    let text = fields.text(name, "a formula in quotes")?;
    let place = fields.get(name)?.item.place;
    match Formula::parse(text, variables) {
        Ok(formula) => Some(formula),
        Err(error) => {
            let place = within(fields.report.text(place), text, place, (error.position, 1));
            let kind = error.kind.to_string();
            let (message, allowed) = kind.split_once("; ").unwrap_or((&kind, ""));
            let path = below(fields.path, name);
            fields.report.value(place, &path, format!("in the formula: {message}"), allowed);
            None
        }
    }
}

/// Where so many bytes from `position` on of a text stand in the file; all of it if it is written
/// with escapes.
pub(super) fn within(
    written: &str,
    text: &str,
    whole: Span,
    (position, length): (usize, usize),
) -> Span {
    match written.find(text) {
        Some(begin) if !text.is_empty() => {
            let start = whole.start + begin + position;
            let end = (start + length).min(whole.start + begin + text.len());
            Span { start, end, ..whole }
        }
        _ => whole,
    }
}

/// A table with a formula in it.
pub(super) fn formula_schema() -> Value {
    json!({
        "type": "object", "required": ["formula"], "additionalProperties": false,
        "properties": { "formula": { "type": "string" } },
    })
}
