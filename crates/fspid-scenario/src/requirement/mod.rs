//! Requirements: what a loop must meet, and where that is from.
//!
//! A [`Requirement`] asks for a [`Measure`] within limits, under [`Conditions`]. Whether it is met, a study judges.
//! Ready sets are data files of the program, see [`SET_NAMES`] and [`set`].

mod condition;
mod confidence;
pub(crate) mod keys;
pub(crate) mod read;
mod set;

pub use condition::{Air, Conditions};
pub use confidence::Confidence;
pub(crate) use set::{Choices, set_names, set_text};
pub use set::{RequirementSet, SET_NAMES, set};

use crate::measure::Measure;

/// Limits of a measure; what is equal to a limit is within it.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// What it is called; unique in its study.
    pub id: String,
    /// Name of the controller it is asked of; all of them if there is none.
    pub controller: Option<String>,
    /// What is measured.
    pub measure: Measure,
    /// Smallest value that meets it, in the unit of the measure.
    pub least: Option<f64>,
    /// Largest value that meets it, in the unit of the measure.
    pub most: Option<f64>,
    /// What counts, and under which conditions.
    pub conditions: Conditions,
    /// Where it is from.
    pub origin: Origin,
    /// In which cases of a tuning or a contest it is asked.
    pub cases: AskedIn,
}

/// In which cases of a tuning or a contest something is asked: names of cases or of their groups.
///
/// The scenario as it is written, without the changes of a case, has no name and is in no group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AskedIn {
    /// In no others than these, and not of the scenario as it is written; everywhere if there are none.
    pub only: Vec<String>,
    /// In all but these.
    pub not: Vec<String>,
}

impl AskedIn {
    /// How the warning ends that something is not asked of the scenario as it is written.
    pub const NOT_AS_WRITTEN: &'static str =
        "is asked in some cases of tuning or contest only, not of the scenario as it is written";

    /// True if the scenario as it is written is asked.
    #[must_use]
    pub fn as_written(&self) -> bool {
        self.only.is_empty()
    }

    /// True if a case of this name and group is asked.
    #[must_use]
    pub fn case(&self, name: &str, group: &str) -> bool {
        let is_this = |it: &String| it == name || (it == group && !group.is_empty());
        (self.only.is_empty() || self.only.iter().any(is_this)) && !self.not.iter().any(is_this)
    }
}

/// Where a requirement is from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// Name of the ready set.
    pub set: Option<String>,
    /// Clause of its source.
    pub clause: Option<String>,
    /// The source.
    pub source: Option<String>,
    /// How sure its numbers are.
    pub confidence: Option<Confidence>,
    /// What else should be known.
    pub note: Option<String>,
}

impl Requirement {
    /// True for a value within the limits; false for NaN.
    #[must_use]
    pub fn is_met_by(&self, value: f64) -> bool {
        let value = self.measure.compared(value);
        let above = self.least.is_none_or(|least| value >= least);
        let below = self.most.is_none_or(|most| value <= most);
        above && below && !value.is_nan()
    }

    /// How far within the limits a value is; negative outside.
    #[must_use]
    pub fn slack(&self, value: f64) -> f64 {
        let value = self.measure.compared(value);
        let above = self.least.map(|least| value - least);
        let below = self.most.map(|most| most - value);
        above
            .into_iter()
            .chain(below)
            .fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
    }

    /// The limits in words, with the unit: "at least 45 deg", "0.3 to 2".
    #[must_use]
    pub fn limits_in_words(&self) -> String {
        let unit = match self.measure.unit() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        match (self.least, self.most) {
            _ if self.measure.is_yes_or_no() => {
                let [yes, _] = self.measure.yes_and_no();
                yes.to_owned()
            }
            (Some(least), Some(most)) => format!("{least} to {most}{unit}"),
            (Some(least), None) => format!("at least {least}{unit}"),
            (None, Some(most)) => format!("at most {most}{unit}"),
            (None, None) => "no limit".to_owned(),
        }
    }
}
