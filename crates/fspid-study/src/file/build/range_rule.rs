//! What is made of a flight that leaves the range in which the aircraft's data are trusted.

use fspid_sim::Scenario;

use crate::file::section::Section;
use crate::file::spec::flight::ValidityWord;

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
        let Some(part) = section.section("aircraft") else {
            return Self::NoRange;
        };
        match (scenario.plant.aircraft(), part.word("validity")) {
            (None, _) => Self::Linear,
            (Some(_), Some(ValidityWord::Warn)) => Self::Warns,
            (Some(_), Some(ValidityWord::Fail) | None) => Self::Fails,
        }
    }
}
