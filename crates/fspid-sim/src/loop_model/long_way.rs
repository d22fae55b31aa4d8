//! Loop models with delays of so many samples that they are not expanded into states; stability is decided by winding number.

use fspid_core::Gains;
use fspid_lti::{DelayedLoop, DelayedPath, Matrix};

use super::{LoopModel, LoopSettings, Sensing};
use crate::error::SimError;

/// Most samples on their way that are states of a loop's matrix, whose cost grows with their cube: 200 take 0.5 s, 500
/// take 5 s, 1000 take 37 s. Of a longer way stability at rest is asked without it, and margins and poles are not.
pub const MOST_AS_STATES: usize = 400;

impl LoopSettings {
    /// Samples on their way around the loop: of commands, and of what the sensors show later.
    #[must_use]
    pub fn on_their_way(&self) -> usize {
        let rate = if self.uses_rate() { self.rate.remembered() } else { 0 };
        self.delay_samples.saturating_add(self.pitch.remembered()).saturating_add(rate)
    }

    /// True where these are too many to be states of a matrix.
    #[must_use]
    pub fn is_long(&self) -> bool {
        self.on_their_way() > MOST_AS_STATES
    }

    /// `Ok` where the loop may be asked as one matrix.
    ///
    /// # Errors
    /// A way that is longer than [`MOST_AS_STATES`].
    pub fn require_matrix(&self) -> Result<(), SimError> {
        match self.is_long() {
            true => Err(SimError::LongWay { samples: self.on_their_way(), most: MOST_AS_STATES }),
            false => Ok(()),
        }
    }

    /// The same loop without what is on its way.
    fn prompt(&self) -> Self {
        let prompt = |sensing: Sensing| Sensing { samples: 0, part: 0.0, keeps: 0, ..sensing };
        Self {
            delay_samples: 0,
            pitch: prompt(self.pitch),
            rate: prompt(self.rate),
            ..self.clone()
        }
    }
}

/// Where a sensor's value comes from: shares of the quantity, each so many samples old.
fn ages(sensing: &Sensing) -> [(usize, f64); 2] {
    [(sensing.samples, 1.0 - sensing.part), (sensing.samples + 1, sensing.part)]
}

impl LoopModel<f64> {
    /// The loop with dead times that are no states, broken at the arriving command. Everything goes around there, one
    /// way through the seen pitch and the controller's memory and one through the seen rate; along each of them dead
    /// times may stand anywhere, as long as gains stand still.
    ///
    /// # Errors
    /// A plant of more states than that is asked of, gains so large that an entry overflows, and a long way of gains that
    /// gather a seen rate of another age than the pitch angle.
    pub fn delayed(&self, gains: Gains<f64>) -> Result<DelayedLoop, SimError> {
        let settings = &self.settings;
        let sees_both = self.gathered.is_some_and(|it| it.by_rate != 0.0);
        if sees_both && ages(&settings.pitch) != ages(&settings.rate) {
            // What is gathered of both goes one way.
            settings.require_matrix()?;
        }
        let prompt = Self { settings: settings.prompt(), change: None, ..self.clone() };
        let (open, [by_pitch, by_rate]) = prompt.assembly(gains).ways();
        let mut paths: Vec<DelayedPath> = Vec::new();
        for (row, sensing) in [(by_pitch, settings.pitch), (by_rate, settings.rate)] {
            for (age, share) in ages(&sensing) {
                let row: Vec<f64> = row.iter().map(|by| share * by).collect();
                if row.iter().any(|&by| by != 0.0) {
                    paths.push(DelayedPath { row, samples: settings.delay_samples + age });
                }
            }
        }
        Ok(DelayedLoop::new(&Matrix::from_rows(&open.matrix)?, &open.entry, &paths)?)
    }

    /// Spectral radius of the closed loop where it is unstable, as [`fspid_lti::SampledLoop::unstable_radius`] says it,
    /// for a way of any length.
    ///
    /// # Errors
    /// A loop that is undecided, and poles that are not found.
    pub fn unstable_radius(&self, gains: Gains<f64>) -> Result<Option<f64>, SimError> {
        if self.settings.is_long() {
            return Ok(self.delayed(gains)?.unstable_radius()?);
        }
        Ok(self.open(gains, super::BreakPoint::default())?.unstable_radius()?)
    }
}
