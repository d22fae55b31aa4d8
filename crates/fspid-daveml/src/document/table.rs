//! Breakpoints, tables and the variables that are read off them.

use serde::{Deserialize, Serialize};

use crate::document::header::Provenance;
use crate::finding::Origin;

/// Where the values of a table stand along one axis.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Breakpoints {
    /// Identifier.
    pub id: String,
    /// Name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Units.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub units: String,
    /// What it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Rising numbers.
    pub values: Vec<f64>,
    /// Where they were written.
    #[serde(skip)]
    pub origin: Origin,
}

/// A mention of something by its identifier.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(from = "String", into = "String")]
pub struct Mention {
    /// Identifier.
    pub id: String,
    /// Where it was written.
    pub origin: Origin,
}

impl From<String> for Mention {
    fn from(id: String) -> Self {
        Self { id, origin: Origin::default() }
    }
}

impl From<Mention> for String {
    fn from(mention: Mention) -> Self {
        mention.id
    }
}

/// Values on a grid; along the last axis they follow each other.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GridTable {
    /// Identifier.
    pub id: String,
    /// Name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Units.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub units: String,
    /// What it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Where it comes from.
    #[serde(default, skip_serializing_if = "Provenance::is_empty")]
    pub provenance: Provenance,
    /// The axes.
    pub breakpoints: Vec<Mention>,
    /// The values.
    pub values: Vec<f64>,
    /// Where it was written.
    #[serde(skip)]
    pub origin: Origin,
}

/// A variable that is read off a table.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TableFunction {
    /// Name.
    pub name: String,
    /// What it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Where it comes from.
    #[serde(default, skip_serializing_if = "Provenance::is_empty")]
    pub provenance: Provenance,
    /// A variable for each axis of the table.
    pub inputs: Vec<FunctionInput>,
    /// The variable that is made.
    pub output: Mention,
    /// The table.
    pub table: Mention,
    /// Where it was written.
    #[serde(skip)]
    pub origin: Origin,
}

/// A variable with which a table is entered.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct FunctionInput {
    /// Identifier of the variable.
    pub variable: Mention,
    /// Where the variable is held from below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Where the variable is held from above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// What happens beyond the breakpoints.
    #[serde(default)]
    pub extrapolate: Extrapolate,
}

/// At which end a table goes on straight beyond its breakpoints; at the others the value at the end is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extrapolate {
    /// At none.
    #[default]
    Neither,
    /// At the lower end.
    Min,
    /// At the upper end.
    Max,
    /// At both.
    Both,
}

impl Extrapolate {
    /// Every kind with its name.
    pub const ALL: [(&'static str, Self); 4] =
        [("neither", Self::Neither), ("min", Self::Min), ("max", Self::Max), ("both", Self::Both)];

    /// The kind with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|&(_, kind)| kind)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |&(name, _)| name)
    }
}
