//! A longitudinal motion that runs away without a swing.

use super::absent::Absent;
use super::level::Judgement;
use super::model::PitchModel;
use super::phugoid::{SPEED, speed_stability};
use crate::modes::{AircraftMode, ModeName};

/// The fastest longitudinal motion that runs away without a swing, whichever half of the motion it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Divergence {
    /// Its pole.
    pub real_rad_s: f64,
    /// Time in s in which it doubles.
    pub doubles_s: f64,
    /// What that is worth.
    pub level: Judgement,
}

impl Divergence {
    /// The fastest divergence of a model; none where no real pole is on the right, and of a model of which no mode is known.
    ///
    /// Near neutral static stability and beyond it, short period and phugoid lend each other poles, so that what runs away
    /// has neither name.
    #[must_use]
    pub fn of(model: &PitchModel) -> Option<Self> {
        let poles = match model.modes() {
            Ok(modes) => modes.iter().map(|mode| mode.pole).collect(),
            // None of the three is the integral of the pitch rate.
            Err(Absent::SlowPair) => model.plant().poles().ok()?,
            Err(_) => return None,
        };
        let real = poles.into_iter().filter(|pole| pole.im == 0.0 && pole.re > 0.0);
        let pole = real.max_by(|left, right| left.re.total_cmp(&right.re))?;
        let level = speed_stability(&AircraftMode { name: ModeName::Phugoid, pole });
        Some(Self {
            real_rad_s: pole.re,
            doubles_s: core::f64::consts::LN_2 / pole.re,
            level: Judgement::new(&SPEED, pole.re, level),
        })
    }
}
