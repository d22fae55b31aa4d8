//! Ready sets of requirements: data files of the program, one line a requirement.

use std::sync::OnceLock;

use fspid_data::REQUIREMENTS as SETS;

use super::condition::Air;
use super::read::requirement_set;
use super::{AskedIn, Conditions, Confidence, Origin, Requirement};
use crate::measure::Measure;

/// Names of the ready sets.
pub const SET_NAMES: [&str; SETS.len()] =
    [SETS[0].0, SETS[1].0, SETS[2].0, SETS[3].0, SETS[4].0, SETS[5].0];

/// Names of the ready sets, for lists of allowed words.
pub(crate) fn set_names() -> Vec<&'static str> {
    SET_NAMES.to_vec()
}

/// The text of a set by its name.
pub(crate) fn set_text(name: &str) -> Option<&'static str> {
    SETS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The set of that name, `None` if the program carries none.
#[must_use]
pub fn set(name: &str) -> Option<RequirementSet> {
    // Read once: scenarios ask for them again and again.
    static READ: OnceLock<Vec<RequirementSet>> = OnceLock::new();
    // The tests read every set that is carried.
    let read = |(name, text): (&str, &str)| requirement_set(text, name).ok();
    let sets = READ.get_or_init(|| SETS.into_iter().filter_map(read).collect());
    sets.iter().find(|set| set.name == name).cloned()
}

/// A set of requirements with what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct RequirementSet {
    /// Name in scenarios.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Where it is from.
    pub source: String,
    /// What else should be known, and what is not in it.
    pub notes: String,
    pub(crate) lines: Vec<SetLine>,
}

/// A line of a set: a requirement, and when it is asked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SetLine {
    pub(crate) id: String,
    pub(crate) measure: Measure,
    pub(crate) least: Option<f64>,
    pub(crate) most: Option<f64>,
    pub(crate) conditions: Conditions,
    pub(crate) clause: String,
    pub(crate) source: String,
    pub(crate) confidence: Confidence,
    pub(crate) note: Option<String>,
    /// Only at this level.
    pub(crate) level: Option<i64>,
    /// Only in this category.
    pub(crate) category: Option<String>,
    /// Only at this speed.
    pub(crate) speed: Option<String>,
    /// Only frequencies below the first aeroelastic mode count.
    pub(crate) below_aeroelastic_mode: bool,
    /// Only frequencies from the first aeroelastic mode on count.
    pub(crate) above_aeroelastic_mode: bool,
}

/// What is chosen of a set, where the standard leaves a choice.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Choices {
    pub(crate) level: i64,
    pub(crate) category: String,
    pub(crate) speed: String,
    pub(crate) air: Air,
    pub(crate) first_aeroelastic_mode_hz: Option<f64>,
    pub(crate) target_ft: Option<f64>,
    pub(crate) target_m: Option<f64>,
}

impl Choices {
    /// What holds where nothing is chosen.
    pub(crate) const DEFAULT_LEVEL: i64 = 1;
    /// As in `fspid aircraft qualities`: climb, cruise, descent.
    pub(crate) const DEFAULT_CATEGORY: &'static str = "B";
    /// From the lowest operating speed to the highest.
    pub(crate) const DEFAULT_SPEED: &'static str = "normal";
}

impl SetLine {
    /// The choices that some lines of a set depend on, by the key that makes them.
    fn depends_on(&self, key: &str) -> bool {
        match key {
            "level" => self.level.is_some(),
            "category" => self.category.is_some(),
            "speed" => self.speed.is_some(),
            "air" => self.conditions.air.is_some(),
            "target_ft" | "target_m" => self.takes_target(),
            _ => self.below_aeroelastic_mode || self.above_aeroelastic_mode,
        }
    }

    /// True for a line about an altitude that it does not name.
    fn takes_target(&self) -> bool {
        self.measure.takes("target_ft") && self.conditions.target_altitude_m().is_none()
    }

    fn is_asked(&self, choices: &Choices) -> bool {
        self.level.is_none_or(|level| level == choices.level)
            && self.category.as_ref().is_none_or(|category| *category == choices.category)
            && self.speed.as_ref().is_none_or(|speed| *speed == choices.speed)
            && self.conditions.air.is_none_or(|air| air == choices.air)
            // A rigid aircraft has nothing above its first aeroelastic mode.
            && !(self.above_aeroelastic_mode && choices.first_aeroelastic_mode_hz.is_none())
    }

    fn requirement(&self, set: &str, choices: &Choices) -> Requirement {
        let mode_hz = choices.first_aeroelastic_mode_hz;
        let mut conditions = self.conditions;
        if self.below_aeroelastic_mode {
            conditions.to_hz = mode_hz;
        }
        if self.takes_target() {
            conditions.target_ft = choices.target_ft;
            conditions.target_m = choices.target_m;
        }
        if self.above_aeroelastic_mode {
            conditions.from_hz = mode_hz;
        }
        Requirement {
            id: format!("{set}/{}", self.id),
            controller: None,
            measure: self.measure,
            least: self.least,
            most: self.most,
            conditions,
            origin: Origin {
                set: Some(set.to_owned()),
                clause: Some(self.clause.clone()),
                source: Some(self.source.clone()),
                confidence: Some(self.confidence),
                note: self.note.clone(),
            },
            cases: AskedIn::default(),
        }
    }
}

impl RequirementSet {
    /// Keys of the choices that the set leaves.
    pub(crate) fn takes(&self, key: &str) -> bool {
        self.lines.iter().any(|line| line.depends_on(key))
    }

    /// The requirements that are asked under these choices, in the order of the set.
    pub(crate) fn requirements(&self, choices: &Choices) -> Vec<Requirement> {
        let asked = self.lines.iter().filter(|line| line.is_asked(choices));
        asked.map(|line| line.requirement(&self.name, choices)).collect()
    }
}
