//! Formulas, whose mistakes are told at their own column.

use fspid_fuzzy::formula::Formula;
use serde_json::{Value, json};

use super::fields::Fields;

/// The formula at a key that must be there, in these variables.
pub(super) fn formula(fields: &mut Fields<'_>, name: &str, variables: &[&str]) -> Option<Formula> {
    let text = fields.text(name, "a formula in quotes")?;
    let _ = (text, variables);
    None
}

/// A table with a formula in it.
pub(super) fn formula_schema() -> Value {
    json!({
        "type": "object", "required": ["formula"], "additionalProperties": false,
        "properties": { "formula": { "type": "string" } },
    })
}
