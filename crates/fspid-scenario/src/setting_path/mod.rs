//! Places of a scenario and what is put there.

pub(crate) mod renamed;
mod steps;

use std::fmt;

use fspid_diagnostics::Span;

use crate::keyed::document::{Item, Value};
use renamed::Renamed;
pub(crate) use steps::{Step, bare, path_of, steps};

/// A place in a scenario, as `--set` names it: `controller.FSPID.nominal.kp`,
/// `plant.preset.numerator[0]`.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingPath {
    text: String,
    steps: Vec<Step>,
}

impl SettingPath {
    /// Reads a path; `None` for a text that is none.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        Self::renamed(text).map(|(path, _)| path)
    }

    /// The same, and the key in it that was called by its old name.
    pub(crate) fn renamed(text: &str) -> Option<(Self, Option<&'static Renamed>)> {
        let mut steps = steps(text)?;
        let key = renamed::in_steps(&mut steps);
        let text = key.map_or_else(|| text.trim().to_owned(), |_| path_of(&steps));
        Some((Self { text, steps }, key))
    }

    /// That these steps lead to.
    pub(crate) fn of(steps: Vec<Step>) -> Self {
        Self { text: path_of(&steps), steps }
    }

    /// The way to it.
    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The first name in it.
    pub(crate) fn root(&self) -> &str {
        match self.steps.first() {
            Some(Step::Name(name)) => name,
            _ => "",
        }
    }

    /// As it was written, but for an old key.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// What is put at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// A number.
    Number(f64),
    /// A whole number, such as a seed.
    Integer(i64),
    /// A text, such as the name of a plant.
    Text(String),
    /// True or false.
    Boolean(bool),
    /// Numbers in rows.
    Rows(Vec<Vec<f64>>),
}

impl NewValue {
    /// As a document has it.
    pub(crate) fn value(&self, place: Span) -> Value {
        let item = |value| Item { place, value };
        match self {
            Self::Number(number) => Value::Float(*number),
            Self::Integer(integer) => Value::Integer(*integer as f64, Some(*integer)),
            Self::Text(text) => Value::Text(text.clone()),
            Self::Boolean(boolean) => Value::Boolean(*boolean),
            Self::Rows(rows) => {
                let row = |row: &Vec<f64>| {
                    Value::Array(row.iter().map(|number| item(Value::Float(*number))).collect())
                };
                Value::Array(rows.iter().map(|numbers| item(row(numbers))).collect())
            }
        }
    }
}

/// As `--set` takes it; reads back as the same bits.
impl fmt::Display for NewValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Integer(integer) => write!(f, "{integer}"),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Boolean(boolean) => write!(f, "{boolean}"),
            // As a list of lists of TOML.
            Self::Rows(rows) => write!(f, "{rows:?}"),
        }
    }
}
