//! The scope of a claim: set-points and loads that it covers, and the effects that it excludes.

use core::fmt;

use crate::disturbances::Disturbed;
use crate::steps::{Commands, Ended, Stepped};

/// The constant set-points and loads that a claim is made for: everything up to these, either way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Set-points, rad from the trim.
    pub setpoint_rad: f64,
    /// Loads, rad of elevator: what the command has to make up for beside what the set-point asks of it.
    pub load_rad: f64,
}

impl Range {
    /// Return to rest, with the set-point at zero and no load.
    pub const REST: Self = Self { setpoint_rad: 0.0, load_rad: 0.0 };

    /// Both times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { setpoint_rad: factor * self.setpoint_rad, load_rad: factor * self.load_rad }
    }

    /// True for two numbers that are finite and not negative.
    #[must_use]
    pub fn is_allowed(self) -> bool {
        // Written so that NaN is not.
        [self.setpoint_rad, self.load_rad].iter().all(|value| *value >= 0.0 && value.is_finite())
    }

    /// True where everything of `other` lies within.
    #[must_use]
    pub fn covers(self, other: Self) -> bool {
        self.setpoint_rad >= other.setpoint_rad && self.load_rad >= other.load_rad
    }
}

/// What a certificate is asked for: the range of set-points and loads, and what of the scenario the claim
/// will not speak of.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Set-points and loads.
    pub range: Range,
    /// What is left out, in the order of [`LeftOut::ALL`].
    pub left_out: Vec<LeftOut>,
    /// What the scenario commands; or what in it is not flown in sets.
    pub commands: Result<Option<Commands>, &'static str>,
}

impl Asked {
    /// Return to rest, with nothing left out but what always is.
    #[must_use]
    pub fn rest() -> Self {
        Self::within(Range::REST)
    }

    /// A range, with nothing left out but what always is.
    #[must_use]
    pub fn within(range: Range) -> Self {
        let always = LeftOut::ALL.into_iter().filter(|one| one.always());
        Self { range, left_out: always.collect(), commands: Ok(None) }
    }
}

/// Everything that is said beside a verdict: where the claim holds, and what it does not speak of.
#[derive(Clone, Debug, PartialEq)]
pub struct Scope {
    /// Set-points and loads that the claim is made for.
    pub range: Range,
    /// The claim is about every constant set-point, however large, as long as no limit acts.
    pub any_setpoint: bool,
    /// The claim is about every constant load, as long as no limit acts.
    pub any_load: bool,
    /// How far rest may be from the set-point, rad: without an integral an error stays; infinite where nothing bounds it.
    pub rest_error_rad: f64,
    /// How far from rest the pitch angle may stay, rad: 0 where every deviation decreases for ever; above where
    /// resolution, or what is not known of the rules to the last digit, leaves something.
    pub remains_rad: f64,
    /// Limits that may act in larger motions, in words.
    pub limits: Vec<&'static str>,
    /// How far the pitch angle may be off, everything else at rest, so that none of them acts, rad; none
    /// where that is not covered.
    pub pitch_within_rad: Option<f64>,
    /// Why limits are left out; none where they are covered, or there are none.
    pub limits_left_out: Option<&'static str>,
    /// Steps from rest that are proved with the limits acting on the way.
    pub stepped: Option<Stepped>,
    /// The flights that a scenario commands, proved likewise.
    pub ended: Option<Ended>,
    /// What disturbances do at most, from rest.
    pub disturbed: Vec<Disturbed>,
    /// What the claim does not speak of.
    pub left_out: Vec<LeftOut>,
}

/// An effect that a claim excludes. The sentence is its `Display`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LeftOut {
    /// Rounding of the controller's own arithmetic.
    Rounding,
    /// The time while the set-point moves.
    MovingSetpoint,
    /// The aircraft is nonlinear.
    NonlinearAircraft,
    /// The plant changes in flight.
    PlantChange,
    /// Wind, gusts and turbulence.
    MovingAir,
    /// Noise of sensors or of the measurement.
    Noise,
    /// Bias of sensors that wanders.
    Drift,
    /// What a sensor shows between two samples.
    BetweenSamples,
    /// What the pitch sensor shows wrongly at rest.
    SeenPitch,
    /// Disturbances while they move.
    Disturbances,
    /// Numbers of the scenario that are drawn anew in campaigns.
    Dispersions,
    /// What the dispersions draw of all that acts on the loop from outside.
    DrawnCommands,
    /// What else the dispersions choose among.
    OtherChoices,
    /// Outer loops, which command the pitch set-point from what the aircraft does.
    OuterLoops,
    /// Configurations that move in flight, and fuel that is burnt.
    Configurations,
}

impl LeftOut {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Rounding,
        Self::MovingSetpoint,
        Self::NonlinearAircraft,
        Self::PlantChange,
        Self::MovingAir,
        Self::Noise,
        Self::Drift,
        Self::BetweenSamples,
        Self::SeenPitch,
        Self::Disturbances,
        Self::Dispersions,
        Self::DrawnCommands,
        Self::OtherChoices,
        Self::OuterLoops,
        Self::Configurations,
    ];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rounding => "rounding",
            Self::MovingSetpoint => "moving-setpoint",
            Self::NonlinearAircraft => "nonlinear-aircraft",
            Self::PlantChange => "plant-change",
            Self::MovingAir => "moving-air",
            Self::Noise => "noise",
            Self::Drift => "drift",
            Self::BetweenSamples => "between-samples",
            Self::SeenPitch => "seen-pitch",
            Self::Disturbances => "disturbances",
            Self::Dispersions => "dispersions",
            Self::DrawnCommands => "drawn-commands",
            Self::OtherChoices => "other-choices",
            Self::OuterLoops => "outer-loops",
            Self::Configurations => "configurations",
        }
    }

    /// The one with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// Whether every claim leaves it out, whatever the scenario.
    #[must_use]
    pub const fn always(self) -> bool {
        matches!(self, Self::Rounding | Self::MovingSetpoint)
    }

    /// Whether claims of growth leave it out as well. They are about gains, and so about no set-point or load.
    #[must_use]
    pub const fn of_growth(self) -> bool {
        !matches!(self, Self::MovingSetpoint | Self::Disturbances)
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rounding => "Rounding in the controller's own arithmetic is left out.",
            Self::MovingSetpoint => {
                "The claim is about constant set-points and loads: it says nothing of the time while they move."
            }
            Self::NonlinearAircraft => {
                "The aircraft is nonlinear: proved is a statement about its linear model at the trim."
            }
            Self::PlantChange => {
                "The plant changes in flight: the claim is about one plant that stays, not about the others, which have certificates of their own, nor about the passage from one to the next."
            }
            Self::MovingAir => "Wind, gusts and turbulence are left out: the air is calm.",
            Self::Noise => "Noise is left out: none at sensors, servo, elevator or measurement is in the claim.",
            Self::Drift => "Wandering bias of sensors is left out: a bias stands still.",
            Self::BetweenSamples => "A sensor is late by no whole number of samples: the claim is about one that shows a straight line between two samples.",
            Self::SeenPitch => "Rest is told of the pitch that the controller sees: by what its sensor shows wrongly the aircraft's own is off.",
            Self::Disturbances => "Disturbances count while they stand still, as loads.",
            Self::Dispersions => "The claim is about the nominal numbers, not about those that a campaign draws.",
            Self::DrawnCommands => "Set-points, disturbances, biases of sensors, moving air and noise count as they are written, not as the dispersions draw them.",
            Self::OtherChoices => "Of what the dispersions choose among, the claim is about one choice alone: others have certificates of their own.",
            Self::OuterLoops => "The claim is about the pitch loop alone, not about the outer loops around it and the set-points that they command.",
            Self::Configurations => {
                "The claim is about the configuration and the fuel of the start, not about what moves or is burnt after it."
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_what_it_names() {
        for one in LeftOut::ALL {
            assert_eq!(LeftOut::named(one.name()), Some(one));
            assert!(one.to_string().ends_with('.'));
        }
    }

    #[test]
    fn a_range_that_is_no_range_is_not_allowed() {
        assert!(Range::REST.is_allowed());
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(!Range { setpoint_rad: bad, ..Range::REST }.is_allowed());
        }
    }
}
