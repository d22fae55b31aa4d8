//! The phugoid: how the slow half of the motion dies out or grows.

use fspid_lti::Mode;

use super::absent::Absent;
use super::level::{Confidence, Judgement, Level, Requirement};
use super::model::PitchModel;
use crate::modes::{AircraftMode, Growth, ModeName};

/// A slow oscillation.
pub(super) const DAMPING: Requirement = Requirement {
    title: "phugoid damping",
    clause: "MIL-F-8785C 3.2.1.2",
    confidence: Confidence::Transcribed,
    note: "damping at least 0.04, at least 0, doubling in no less than 55 s",
};

/// A slow motion that does not swing.
pub(super) const SPEED: Requirement = Requirement {
    title: "speed stability",
    clause: "MIL-F-8785C 3.2.1.1",
    confidence: Confidence::Recalled,
    note: "no divergence at levels 1 and 2, doubling in no less than 6 s at level 3",
};

/// Shortest time in s in which an oscillation of level 3 doubles.
const OSCILLATION_DOUBLES_S: f64 = 55.0;

/// Shortest time in s in which a divergence of level 3 doubles.
const DIVERGENCE_DOUBLES_S: f64 = 6.0;

/// Slow half of the longitudinal motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Phugoid {
    /// It swings.
    Oscillation {
        /// Frequency and damping.
        mode: Mode,
        /// Time to half or double.
        growth: Growth,
        /// What the damping is worth.
        level: Judgement,
    },
    /// It creeps: two real poles, of which this is the less stable.
    Creep {
        /// The pole.
        real_rad_s: f64,
        /// Time to half or double.
        growth: Growth,
        /// What its growth is worth.
        level: Judgement,
    },
}

impl Phugoid {
    /// Phugoid of a model.
    ///
    /// # Errors
    /// A model that holds the speed; modes that have lent each other a pole.
    pub fn of(model: &PitchModel) -> Result<Self, Absent> {
        let modes = model.modes()?;
        if modes.iter().any(|mode| mode.name == ModeName::ThirdOscillation) {
            return Err(Absent::ThirdOscillation);
        }
        let slow = modes.iter().filter(|mode| mode.name == ModeName::Phugoid);
        let least = slow.max_by(|left, right| left.pole.re.total_cmp(&right.pole.re));
        let mode = least.ok_or(Absent::NoPhugoid)?;
        if mode.oscillates() { oscillation(mode) } else { Ok(creep(mode)) }
    }

    /// What it is worth.
    #[must_use]
    pub fn level(&self) -> Judgement {
        match self {
            Self::Oscillation { level, .. } | Self::Creep { level, .. } => *level,
        }
    }
}

fn oscillation(mode: &AircraftMode) -> Result<Phugoid, Absent> {
    let (found, growth) = (mode.mode()?, mode.growth());
    let level = Level::best(|level| match level {
        0 => found.damping_ratio >= 0.04,
        1 => found.damping_ratio >= 0.0,
        _ => doubles_after(growth, OSCILLATION_DOUBLES_S),
    });
    let level = Judgement::new(&DAMPING, found.damping_ratio, level);
    Ok(Phugoid::Oscillation { mode: found, growth, level })
}

fn creep(mode: &AircraftMode) -> Phugoid {
    let (real_rad_s, growth) = (mode.pole.re, mode.growth());
    let level = Judgement::new(&SPEED, real_rad_s, speed_stability(mode));
    Phugoid::Creep { real_rad_s, growth, level }
}

/// What a motion that does not swing is worth.
pub(super) fn speed_stability(mode: &AircraftMode) -> Level {
    Level::best(|level| match level {
        0 | 1 => mode.pole.re <= 0.0,
        _ => doubles_after(mode.growth(), DIVERGENCE_DOUBLES_S),
    })
}

fn doubles_after(growth: Growth, least_s: f64) -> bool {
    match growth {
        Growth::Doubles(time_s) => time_s >= least_s,
        Growth::Halves(_) | Growth::Stays => true,
    }
}
