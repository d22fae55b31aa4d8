//! Levels of flying qualities, the requirements they come from, and how sure those are.

use std::fmt;

/// How good a flying quality is.
///
/// Levels as MIL-F-8785C 1.5 has them: the better one compares as the smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Clearly adequate for the mission.
    One,
    /// Adequate with more work for the pilot or less effect.
    Two,
    /// The aircraft can be controlled safely, with excessive work or inadequate effect.
    Three,
    /// Outside of all levels.
    Worse,
}

impl Level {
    /// The best level of which the condition holds.
    pub(super) fn best(holds: impl Fn(usize) -> bool) -> Self {
        let levels = [Self::One, Self::Two, Self::Three];
        let found = levels.into_iter().enumerate().find(|(index, _)| holds(*index));
        found.map_or(Self::Worse, |(_, level)| level)
    }

    /// The best level whose bound a value reaches from above.
    pub(super) fn at_least(value: f64, bounds: [f64; 3]) -> Self {
        Self::best(|index| value >= bounds[index])
    }

    /// The best level whose bound a value reaches from below.
    pub(super) fn at_most(value: f64, bounds: [f64; 3]) -> Self {
        Self::best(|index| value <= bounds[index])
    }

    /// The best level whose bounds enclose a value; they belong to the level.
    pub(super) fn within(value: f64, bounds: [(f64, f64); 3]) -> Self {
        Self::best(|index| bounds[index].0 <= value && value <= bounds[index].1)
    }
}

impl fmt::Display for Level {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::One => "level 1",
            Self::Two => "level 2",
            Self::Three => "level 3",
            Self::Worse => "worse than level 3",
        })
    }
}

/// What is being flown, as MIL-F-8785C 1.4 sorts it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Category {
    /// Rapid manoeuvres, precise tracking or flight path: combat, terrain following, refuelling.
    A,
    /// Gradual manoeuvres: climb, cruise, descent.
    #[default]
    B,
    /// Near the ground: take-off, approach, landing.
    C,
}

impl Category {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::A, Self::B, Self::C];

    pub(super) fn pick<T>(self, [a, b, c]: [T; 3]) -> T {
        match self {
            Self::A => a,
            Self::B => b,
            Self::C => c,
        }
    }
}

/// What flies, as MIL-F-8785C 1.3 sorts it; class II as if based on land.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Small and light.
    I,
    /// Medium weight, low to medium manoeuvrability.
    II,
    /// Large and heavy, low to medium manoeuvrability.
    III,
    /// High manoeuvrability.
    IV,
}

impl Class {
    /// Whether it belongs to the classes for which tables demand quick responses.
    pub(super) fn quick(self) -> bool {
        matches!(self, Self::I | Self::IV)
    }
}

/// How far the numbers of a requirement can be trusted. The standards themselves were not at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Confidence {
    /// Two public transcriptions of the standard agree.
    Transcribed,
    /// Public transcriptions differ; the requirement's note says in what and which was taken.
    Disputed,
    /// Read off a chart by others; edges are good to some 5 %.
    Digitised,
    /// Known from use; to be read again before it is relied on.
    Recalled,
}

/// A requirement on a flying quality.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Requirement {
    /// What it is about.
    pub title: &'static str,
    /// Standard and clause.
    pub clause: &'static str,
    /// How sure its numbers are.
    pub confidence: Confidence,
    /// What should be known about them.
    pub note: &'static str,
}

/// A level, and by which requirement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judgement {
    /// The requirement.
    pub requirement: &'static Requirement,
    /// What was judged, in the unit of the requirement.
    pub value: f64,
    /// How good it is.
    pub level: Level,
}

impl Judgement {
    pub(super) fn new(requirement: &'static Requirement, value: f64, level: Level) -> Self {
        Self { requirement, value, level }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_belong_to_the_better_level() {
        assert_eq!(Level::at_least(0.04, [0.04, 0.0, -1.0]), Level::One);
        assert_eq!(Level::at_most(0.2, [0.1, 0.2, 0.25]), Level::Two);
        assert_eq!(Level::within(2.0, [(0.3, 1.3), (0.2, 2.0), (0.1, 9.0)]), Level::Two);
    }

    #[test]
    fn a_value_that_is_not_a_number_is_worse_than_all_levels() {
        assert_eq!(Level::at_least(f64::NAN, [0.0; 3]), Level::Worse);
        assert_eq!(Level::at_most(f64::NAN, [0.0; 3]), Level::Worse);
        assert_eq!(Level::Worse.to_string(), "worse than level 3");
    }
}
