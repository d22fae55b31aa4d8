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

    /// The same so much earlier, to the nanosecond; noise, whose numbers go with the samples, as it is.
    pub(super) fn earlier(mut self, by_s: f64) -> Self {
        match &mut self {
            Self::Step { at_s }
            | Self::Pulse { at_s, .. }
            | Self::Doublet { at_s, .. }
            | Self::Square { at_s, .. }
            | Self::Ramp { at_s, .. }
            | Self::Sine { at_s, .. } => *at_s = libm::round((*at_s - by_s) * 1e9) / 1e9,
            Self::Noise { .. } => {}
        }
        self
    }

    /// True for what moves for ever: what else there is keeps its value from some time on.
    pub(crate) fn goes_on(&self) -> bool {
        matches!(self, Self::Square { .. } | Self::Sine { .. } | Self::Noise { .. })
    }

    /// From when on and with which period it swings, s; none for what does not.
    pub(crate) fn period_s(&self) -> Option<(f64, f64)> {
        match *self {
            Self::Square { at_s, half_period_s, .. } => Some((at_s, 2.0 * half_period_s)),
            Self::Sine { at_s, frequency_hz } => Some((at_s, 1.0 / frequency_hz)),
            _ => None,
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

    /// The times at which the shape begins, jumps or bends, s. After the last it stays as it is, or swings for ever.
    fn breaks(&self) -> Vec<f64> {
        match *self {
            Self::Step { at_s }
            | Self::Square { at_s, .. }
            | Self::Sine { at_s, .. }
            | Self::Noise { at_s, .. } => vec![at_s],
            Self::Pulse { at_s, width_s } | Self::Ramp { at_s, width_s } => {
                vec![at_s, at_s + width_s]
            }
            Self::Doublet { at_s, width_s } => vec![at_s, at_s + width_s, at_s + 2.0 * width_s],
        }
    }

    /// Least and largest value between two breaks that follow each other; noise counts as nothing.
    fn between(&self, from_s: f64, to_s: f64) -> [f64; 2] {
        let from = |at_s: f64, ends: [f64; 2]| if from_s >= at_s { ends } else { [0.0; 2] };
        match *self {
            Self::Step { at_s } => from(at_s, [1.0; 2]),
            Self::Pulse { at_s, width_s } => {
                if from_s >= at_s + width_s {
                    [0.0; 2]
                } else {
                    from(at_s, [1.0; 2])
                }
            }
            Self::Doublet { at_s, width_s } => {
                if from_s >= at_s + 2.0 * width_s {
                    [0.0; 2]
                } else if from_s >= at_s + width_s {
                    [-1.0; 2]
                } else {
                    from(at_s, [1.0; 2])
                }
            }
            Self::Square { at_s, bipolar, .. } => {
                from(at_s, [if bipolar { -1.0 } else { 0.0 }, 1.0])
            }
            Self::Ramp { at_s, width_s } => {
                [from_s, to_s].map(|time_s| ((time_s - at_s) / width_s).clamp(0.0, 1.0))
            }
            Self::Sine { at_s, .. } => from(at_s, [-1.0, 1.0]),
            Self::Noise { .. } => [0.0; 2],
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

/// Least and largest value that a sum of shapes, each with its amplitude, comes to in all time; 0 is one of its
/// values. Noise is left out.
pub(crate) fn extremes(parts: &[(f64, &Shape)]) -> [f64; 2] {
    extremes_from(f64::NEG_INFINITY, parts)
}

/// The same from some time on.
pub(crate) fn extremes_from(begin_s: f64, parts: &[(f64, &Shape)]) -> [f64; 2] {
    let mut breaks: Vec<f64> = parts.iter().flat_map(|(_, shape)| shape.breaks()).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let mut ends = [0.0_f64; 2];
    for (place, &from_s) in breaks.iter().enumerate() {
        let to_s = breaks.get(place + 1).copied().unwrap_or(f64::INFINITY);
        if to_s <= begin_s {
            continue;
        }
        let from_s = from_s.max(begin_s);
        let sum = parts.iter().fold([0.0; 2], |[least, most], (amplitude, shape)| {
            let [one, other] = shape.between(from_s, to_s).map(|value| amplitude * value);
            [least + one.min(other), most + one.max(other)]
        });
        ends = [ends[0].min(sum[0]), ends[1].max(sum[1])];
    }
    ends
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extremes_of_a_sum_are_those_of_all_time_and_no_flight_of_a_minute_goes_beyond() {
        let (at_s, width_s) = (3.0, 4.0);
        let shapes = [
            (2.0, Shape::Step { at_s: 30.0 }, [0.0, 2.0]),
            (-2.0, Shape::Pulse { at_s, width_s }, [-2.0, 0.0]),
            (1.5, Shape::Doublet { at_s, width_s }, [-1.5, 1.5]),
            (-1.0, Shape::Square { at_s, half_period_s: 2.0, bipolar: false }, [-1.0, 0.0]),
            (1.0, Shape::Square { at_s, half_period_s: 2.0, bipolar: true }, [-1.0, 1.0]),
            (3.0, Shape::Ramp { at_s, width_s: 50.0 }, [0.0, 3.0]),
            (-0.5, Shape::Sine { at_s, frequency_hz: 0.3 }, [-0.5, 0.5]),
            (9.0, Shape::Noise { at_s, seed: 1 }, [0.0, 0.0]),
        ];
        let timing = Timing::new(0.1, 60.0).expect("allowed");
        for (place, (amplitude, shape, expected)) in shapes.iter().enumerate() {
            assert_eq!(extremes(&[(*amplitude, shape)]), *expected, "{shape:?}");
            for (more, beside, _) in &shapes[place..shapes.len() - 1] {
                let [least, most] = extremes(&[(*amplitude, shape), (*more, beside)]);
                let mut values = vec![0.0; timing.rows()];
                shape.add_to(&mut values, if place == 7 { 0.0 } else { *amplitude }, timing, 0);
                beside.add_to(&mut values, *more, timing, 0);
                assert!(values.iter().all(|value| (least..=most).contains(value)), "{shape:?}");
            }
        }
        // A step up and one down again: never both.
        let [up, down] = [Shape::Step { at_s: 1.0 }, Shape::Step { at_s: 500.0 }];
        assert_eq!(extremes(&[(1.0, &up), (-1.0, &down)]), [0.0, 1.0]);
    }
}
