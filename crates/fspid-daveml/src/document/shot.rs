//! Check cases.

use serde::{Deserialize, Serialize};

use crate::finding::Origin;

/// A check case: what the model answers to some inputs.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Shot {
    /// Name.
    pub name: String,
    /// What it checks.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Inputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Signal>,
    /// Variables on the way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub internals: Vec<Signal>,
    /// Outputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<Signal>,
    /// Where it was written.
    #[serde(skip)]
    pub origin: Origin,
}

/// A value in a check case.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// Name or identifier of the variable, as `by_name` says.
    pub variable: String,
    /// True for a name, false for an identifier.
    #[serde(default)]
    pub by_name: bool,
    /// Units; empty if they are not said.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub units: String,
    /// Value.
    pub value: f64,
    /// How far an answer may be off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Where it was written.
    #[serde(skip)]
    pub origin: Origin,
}
