//! The shapes that set-points and disturbances are made of.

use super::noise::standard_normal;
use crate::error::{SimError, finite, not_negative, positive};
use crate::timing::Timing;

/// A signal of amplitude 1 over time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// 1 from `at_s` on.
    Step {
        /// Start, s.
        at_s: f64,
    },
    /// 1 from `at_s` for `width_s`.
    Pulse {
        /// Start, s.
        at_s: f64,
        /// Length, s.
        width_s: f64,
    },
    /// 1 for `width_s`, then -1 for `width_s`, then 0.
    Doublet {
        /// Start, s.
        at_s: f64,
        /// Length of each half, s.
        width_s: f64,
    },
    /// 1 for a half period from `at_s` on, then -1 (bipolar) or 0 (unipolar) for one, and so on.
    Square {
        /// Start, s.
        at_s: f64,
        /// Half period, s.
        half_period_s: f64,
        /// Swings to -1 and not to 0.
        bipolar: bool,
    },
    /// From 0 at `at_s` in a straight line to 1 at `at_s + width_s`, then 1.
    Ramp {
        /// Start, s.
        at_s: f64,
        /// Length, s.
        width_s: f64,
    },
    /// $\sin 2 \pi f (t - t_0)$ from `at_s` on.
    Sine {
        /// Start, s.
        at_s: f64,
        /// Frequency, Hz.
        frequency_hz: f64,
    },
    /// White noise of standard deviation 1, a new value each sample of the loop, from `at_s` on: number k of
    /// its stream at sample k, so that another period is another noise.
    Noise {
        /// Start, s.
        at_s: f64,
        /// Seed; the same seed gives the same noise.
        seed: u64,
    },
}

impl Shape {
    /// The shape if its times are allowed.
    ///
    /// # Errors
    /// [`SimError::Number`] for a start that is negative or not finite, and for a length, period or
    /// frequency that is not finite and positive.
    pub fn checked(self) -> Result<Self, SimError> {
        match self {
            Self::Step { at_s } | Self::Noise { at_s, .. } => {
                not_negative("at_s", at_s)?;
            }
            Self::Pulse { at_s, width_s }
            | Self::Doublet { at_s, width_s }
            | Self::Ramp { at_s, width_s } => {
                not_negative("at_s", at_s)?;
                positive("width_s", width_s)?;
            }
            Self::Square { at_s, half_period_s, .. } => {
                not_negative("at_s", at_s)?;
                positive("half_period_s", half_period_s)?;
            }
            Self::Sine { at_s, frequency_hz } => {
                not_negative("at_s", at_s)?;
                positive("frequency_hz", frequency_hz)?;
            }
        }
        Ok(self)
    }

    /// Before this there is nothing, s.
    #[must_use]
    pub fn starts_s(&self) -> f64 {
        match *self {
            Self::Step { at_s }
            | Self::Pulse { at_s, .. }
            | Self::Doublet { at_s, .. }
            | Self::Square { at_s, .. }
            | Self::Ramp { at_s, .. }
            | Self::Sine { at_s, .. }
            | Self::Noise { at_s, .. } => at_s,
        }
    }

    /// Adds `amplitude` times the shape to `values`, one entry a sample. `stream` keeps the noises
    /// of one seed apart.
    pub(crate) fn add_to(&self, values: &mut [f64], amplitude: f64, timing: Timing, stream: u64) {
        match *self {
            Self::Ramp { at_s, width_s } => {
                let shape = |t: f64| ((t - at_s) / width_s).clamp(0.0, 1.0);
                add_function(values, timing, at_s, |_, t| amplitude * shape(t));
            }
            Self::Sine { at_s, frequency_hz } => {
                let shape = |t: f64| libm::sin(std::f64::consts::TAU * frequency_hz * (t - at_s));
                add_function(values, timing, at_s, |_, t| amplitude * shape(t));
            }
            Self::Noise { at_s, seed } => {
                let shape = |k| standard_normal(seed, stream, k);
                add_function(values, timing, at_s, |k, _| amplitude * shape(k));
            }
            _ => {
                let mut changes = self.levels(timing).into_iter().peekable();
                let mut level = 0.0;
                for (k, value) in values.iter_mut().enumerate() {
                    while let Some((_, change)) = changes.next_if(|&(from, _)| from <= k) {
                        level += change;
                    }
                    *value += amplitude * level;
                }
            }
        }
    }

    /// Changes of level of a piecewise constant shape: first sample, and how much is added there.
    pub(crate) fn levels(&self, timing: Timing) -> Vec<(usize, f64)> {
        let sample = |at_s: f64| timing.first_sample_at(at_s);
        match *self {
            Self::Step { at_s } => vec![(sample(at_s), 1.0)],
            Self::Pulse { at_s, width_s } => {
                vec![(sample(at_s), 1.0), (sample(at_s + width_s), -1.0)]
            }
            Self::Doublet { at_s, width_s } => vec![
                (sample(at_s), 1.0),
                (sample(at_s + width_s), -2.0),
                (sample(at_s + 2.0 * width_s), 1.0),
            ],
            Self::Square { at_s, half_period_s, bipolar } => {
                let fall = if bipolar { -2.0 } else { -1.0 };
                let mut levels = vec![(sample(at_s), 1.0)];
                // A period below the sample period could not be seen; one change a sample is most.
                for half in 1..timing.rows() {
                    let from = sample(at_s + half as f64 * half_period_s);
                    if from >= timing.rows() {
                        break;
                    }
                    levels.push((from, if half % 2 == 1 { fall } else { -fall }));
                }
                levels
            }
            Self::Ramp { .. } | Self::Sine { .. } | Self::Noise { .. } => Vec::new(),
        }
    }
}

fn add_function(
    values: &mut [f64],
    timing: Timing,
    at_s: f64,
    function: impl Fn(usize, f64) -> f64,
) {
    let from = timing.first_sample_at(at_s);
    for (k, value) in values.iter_mut().enumerate().skip(from) {
        *value += function(k, timing.time_s(k));
    }
}

/// The amplitude of a signal, if it is finite.
pub(super) fn amplitude(what: &'static str, value: f64) -> Result<f64, SimError> {
    finite(what, value)
}
