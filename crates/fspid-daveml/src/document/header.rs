//! Where a model and its parts come from.

use serde::{Deserialize, Serialize};

/// What a model is and where it comes from.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Name of the model.
    pub name: String,
    /// Date of the file, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    /// Version of the file, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub version: String,
    /// What the model is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Who made it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub authors: Vec<Author>,
    /// Publications.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<Source>,
    /// Changes of the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modifications: Vec<Modification>,
}

/// Who made something.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Author {
    /// Name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Organisation.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub organisation: String,
    /// Address for mail.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub email: String,
}

/// A publication that numbers come from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Identifier.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub id: String,
    /// Author.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub author: String,
    /// Title.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Number of the report or book.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub accession: String,
    /// Date, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    /// Address on the net.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub address: String,
    /// What else is said of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// A change of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Modification {
    /// Identifier.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub id: String,
    /// Date, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    /// Who made it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub authors: Vec<Author>,
    /// What was changed.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// Where one part of the model comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Who made it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub authors: Vec<Author>,
    /// Date, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    /// Identifiers of publications.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<String>,
    /// What else is said.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

impl Provenance {
    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
