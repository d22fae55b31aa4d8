//! What is made of a flight that leaves the range in which the aircraft's data are trusted.

use fspid_sim::Scenario;

use crate::file::spec::flight as keys;
use crate::file::spec::flight::ValidityWord;
use crate::file::spec::scenario::AIRCRAFT;
use crate::keyed::Section;

/// What is said of an aircraft that a linear model flies.
const LINEAR_AIRCRAFT: &str = "flown by a linear model, which has no height and no range: neither the ground nor the limits of the aircraft's data are asked";

/// What is made of a flight that leaves the range of its data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeRule {
    /// A plant that is no aircraft: nobody said where its numbers hold.
    NoRange,
    /// An aircraft flown by a linear model, which has neither speed nor height that could leave a range.
    Linear,
    /// It fails.
    Fails,
    /// It is told and does not fail.
    Warns,
}

impl RangeRule {
    pub(super) fn of(section: &Section, scenario: &Scenario) -> Self {
        let Some(part) = section.get(AIRCRAFT) else {
            return Self::NoRange;
        };
        match (scenario.plant.aircraft(), part.get(keys::VALIDITY)) {
            (None, _) => Self::Linear,
            (Some(_), Some(ValidityWord::Warn)) => Self::Warns,
            (Some(_), Some(ValidityWord::Fail) | None) => Self::Fails,
        }
    }

    /// What is said once of all flights.
    #[must_use]
    pub fn note(self) -> Option<&'static str> {
        match self {
            Self::Linear => Some(LINEAR_AIRCRAFT),
            Self::NoRange | Self::Fails | Self::Warns => None,
        }
    }
}
