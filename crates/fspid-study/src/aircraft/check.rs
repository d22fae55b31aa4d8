//! Is the file of an aircraft right, and are its numbers those of an aircraft?

use fspid_aircraft::data::{AircraftData, ModelData};
use serde_json::{Value, json};

use super::condition::Question;
use super::list::kind;
use super::load::load;
use super::modes::{Modes, modes};
use crate::json::with_null_reasons;
use fspid_scenario::aircraft::AircraftFailure;

/// An aircraft that can be read, with its motions and what is hardly meant.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedAircraft {
    file: String,
    data: AircraftData,
    /// At the flight condition of its data; none of tables, which have none, and where it has no trim.
    modes: Option<Modes>,
    /// Sentences beside the answer.
    pub warnings: Vec<String>,
}

/// Checks an aircraft file: everything that is wrong with it, or its motions at the flight condition of its data.
///
/// # Errors
/// [`AircraftFailure`]: as [`load`].
pub fn check(file: &str) -> Result<CheckedAircraft, AircraftFailure> {
    let data = load(file)?;
    let mut warnings = data.doubts();
    let question = Question { aircraft: file, ..Question::default() };
    let modes = match &data.model {
        ModelData::Forces(tables) => {
            warnings.extend(tables.held.iter().cloned());
            None
        }
        ModelData::Linear(_) | ModelData::Derivatives(_) => match modes(&question) {
            Ok(modes) => Some(modes),
            Err(failure) => {
                warnings.push(format!("at the flight condition of its data: {failure}"));
                None
            }
        },
    };
    Ok(CheckedAircraft { file: file.to_owned(), data, modes, warnings })
}

impl CheckedAircraft {
    /// The answer for people, in two lines.
    #[must_use]
    pub fn text(&self) -> String {
        let motions = match (&self.modes, &self.data.model) {
            (Some(modes), _) => modes.in_words(),
            (None, ModelData::Forces(_)) => {
                "tables have no flight condition of their own; trim it at one".to_owned()
            }
            (None, _) => "it cannot be trimmed at the flight condition of its data".to_owned(),
        };
        format!("{}: good; {}\n{motions}\n", self.file, self.data.title)
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let answer = json!({
            "schema": 1, "file": self.file, "kind": "aircraft", "good": true, "name": self.data.name,
            "model": kind(&self.data.model), "warnings": self.warnings,
            "modes": self.modes.as_ref().map(Modes::json),
        });
        with_null_reasons(
            answer,
            &[(
                "modes",
                "it was not trimmed: tables have no flight condition of their own, or a warning says why",
            )],
        )
    }
}
