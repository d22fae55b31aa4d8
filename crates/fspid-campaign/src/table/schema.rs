//! Columns: names, kinds, units, meanings, and the JSON in which a file carries them.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use serde_json::{Value, json};

use super::{Foreign, TableError};

/// Version of the JSON under [`COLUMNS_KEY`](super::COLUMNS_KEY) and of the file's layout.
const FORMAT: u64 = 1;

/// What the cells of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A number of 64 bits: `DOUBLE` in Parquet, `float` in the metadata.
    Float,
    /// A whole number of 64 bits with sign: `INT64`, `integer`.
    Integer,
    /// UTF-8 of at most [`MAX_TEXT_BYTES`](super::MAX_TEXT_BYTES): `BYTE_ARRAY` as `STRING`, `text`.
    Text,
    /// True or false: `BOOLEAN`, `boolean`.
    Boolean,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 4] = [Self::Float, Self::Integer, Self::Text, Self::Boolean];

    /// The word for it in metadata and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Integer => "integer",
            Self::Text => "text",
            Self::Boolean => "boolean",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A column: every cell is of its kind or absent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name, with the unit as its last part: `overshoot_pct`.
    pub name: String,
    /// What its cells are.
    pub kind: Kind,
    /// Unit for people: `%`, `rad/s`; empty where there is none.
    pub unit: String,
    /// What it means, in a sentence; may be empty.
    pub meaning: String,
}

impl Column {
    /// A column without unit and meaning.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self { name: name.into(), kind, unit: String::new(), meaning: String::new() }
    }

    /// The same column with a unit.
    #[must_use]
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self { unit: unit.into(), ..self }
    }

    /// The same column with a meaning.
    #[must_use]
    pub fn meaning(self, meaning: impl Into<String>) -> Self {
        Self { meaning: meaning.into(), ..self }
    }
}

/// Columns in a fixed order, at least one, no two of the same name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schema {
    columns: Vec<Column>,
}

impl Schema {
    /// Checks the columns.
    ///
    /// Names that differ in upper and lower case alone count as the same: SQL engines that people
    /// read these files with do not tell them apart.
    ///
    /// # Errors
    /// [`TableError::NoColumns`], [`TableError::ColumnName`], [`TableError::DuplicateColumn`].
    pub fn new(columns: Vec<Column>) -> Result<Self, TableError> {
        if columns.is_empty() {
            return Err(TableError::NoColumns);
        }
        let mut seen = BTreeMap::new();
        for (index, Column { name, .. }) in columns.iter().enumerate() {
            if name.is_empty() || name.chars().any(char::is_control) {
                return Err(TableError::ColumnName { index, name: name.clone() });
            }
            if let Some(first) = seen.insert(name.to_lowercase(), index) {
                return Err(TableError::DuplicateColumn {
                    name: name.clone(),
                    first,
                    second: index,
                });
            }
        }
        Ok(Self { columns })
    }

    /// The columns, in order.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Index of the column of that name, if there is one.
    #[must_use]
    pub fn position(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Index of the column of that name.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`] with the names there are.
    pub fn index(&self, name: &str) -> Result<usize, TableError> {
        self.position(name).ok_or_else(|| TableError::UnknownColumn {
            name: name.to_owned(),
            known: self.columns.iter().map(|column| column.name.clone()).collect(),
        })
    }

    /// The columns at some indices, in that order; indices that there are not are left out.
    ///
    /// # Errors
    /// As [`Schema::new`].
    pub fn select(&self, indices: &[usize]) -> Result<Self, TableError> {
        Self::new(indices.iter().filter_map(|&index| self.columns.get(index).cloned()).collect())
    }

    /// The columns as JSON for the metadata.
    pub(super) fn to_json(&self) -> String {
        let columns: Vec<Value> = self
            .columns
            .iter()
            .map(|Column { name, kind, unit, meaning }| {
                json!({ "name": name, "kind": kind.name(), "unit": unit, "meaning": meaning })
            })
            .collect();
        json!({ "format": FORMAT, "columns": columns }).to_string()
    }

    /// The columns of a file, from its metadata.
    pub(super) fn from_json(text: &str) -> Result<Self, Foreign> {
        let unreadable = || Foreign::Description { key: super::COLUMNS_KEY };
        let value: Value = serde_json::from_str(text).map_err(|_| unreadable())?;
        let format = value.get("format").and_then(Value::as_u64).ok_or_else(unreadable)?;
        if format != FORMAT {
            return Err(Foreign::Format { found: format, known: FORMAT });
        }
        let columns = value.get("columns").and_then(Value::as_array).ok_or_else(unreadable)?;
        let columns: Option<Vec<Column>> = columns.iter().map(column_from_json).collect();
        Self::new(columns.ok_or_else(unreadable)?).map_err(|_| unreadable())
    }
}

/// A column of the JSON, if it says everything.
fn column_from_json(value: &Value) -> Option<Column> {
    let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
    let kind = text("kind")?;
    let kind = Kind::ALL.into_iter().find(|known| known.name() == kind)?;
    Some(Column { name: text("name")?, kind, unit: text("unit")?, meaning: text("meaning")? })
}
