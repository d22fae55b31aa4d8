//! What disturbs the loop, and where it enters.

use super::shape::{Shape, amplitude};
use crate::error::SimError;
use crate::timing::Timing;

/// Where a disturbance enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// Added to the servo's command, nose up positive.
    Servo,
    /// Added to the elevator behind the servo, nose up positive: a steady gust's moment.
    Elevator,
    /// Added to the measured pitch.
    Measurement,
}

impl Entry {
    /// All places.
    pub const ALL: [Self; 3] = [Self::Servo, Self::Elevator, Self::Measurement];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Servo => "servo",
            Self::Elevator => "elevator",
            Self::Measurement => "measurement",
        }
    }
}

/// A disturbance: a shape, its size and where it enters. Held from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    entry: Entry,
    amplitude_rad: f64,
    shape: Shape,
}

impl Disturbance {
    /// `amplitude_rad` (for noise: the standard deviation) times `shape`, entering at `entry`.
    ///
    /// # Errors
    /// [`SimError::Number`] for an amplitude that is not finite or a shape out of its range.
    pub fn new(entry: Entry, amplitude_rad: f64, shape: Shape) -> Result<Self, SimError> {
        let amplitude_rad = amplitude("amplitude", amplitude_rad)?;
        Ok(Self { entry, amplitude_rad, shape: shape.checked()? })
    }

    /// Where it enters.
    #[must_use]
    pub fn entry(&self) -> Entry {
        self.entry
    }

    /// When it begins, s.
    #[must_use]
    pub fn starts_s(&self) -> f64 {
        self.shape.starts_s()
    }

    /// The same so much earlier.
    pub(crate) fn earlier(&self, by_s: f64) -> Self {
        Self { shape: self.shape.clone().earlier(by_s), ..self.clone() }
    }

    /// True for noise, which never stands still.
    #[must_use]
    pub fn is_noise(&self) -> bool {
        matches!(self.shape, Shape::Noise { .. })
    }

    /// True for what keeps its value between the times at which it moves: neither noise nor a sine.
    pub(crate) fn stands_still(&self) -> bool {
        !matches!(self.shape, Shape::Noise { .. } | Shape::Sine { .. })
    }

    /// True for what moves for ever.
    pub(crate) fn goes_on(&self) -> bool {
        self.shape.goes_on()
    }

    /// True for one of some size that has begun by then.
    pub(crate) fn acts_by(&self, at_s: f64) -> bool {
        self.amplitude_rad != 0.0 && self.shape.starts_s() <= at_s
    }

    /// As [`Shape::period_s`].
    pub(crate) fn period_s(&self) -> Option<(f64, f64)> {
        self.shape.period_s()
    }

    /// Its amplitude, rad, and its shape.
    pub(crate) fn part(&self) -> (f64, &Shape) {
        (self.amplitude_rad, &self.shape)
    }

    pub(crate) fn add_to(&self, values: &mut [f64], timing: Timing, stream: u64) {
        self.shape.add_to(values, self.amplitude_rad, timing, stream);
    }
}
