//! Convergence test of a perturbed flight: compares the error in successive thirds of the flight.

use std::fmt;
use std::ops::ControlFlow;

use super::Perturbation;
use crate::error::SimError;
use crate::scenario::{Prepared, Respondent, Scenario};
use crate::sensor::Sensor;
use crate::trace::{EarlyEnd, Outcome};

/// When a flight counts as not held. Looked at is the error (set-point less true pitch angle) in the last
/// third of the flight and in the third before. A flight is not held if
///
/// - it diverged or hit the ground, or
/// - the swing of the error, $\max e - \min e$, is above a floor and at least `growth` of that before, or
/// - its oscillation, the swing about its straight line of least squares, is above the floor and at
///   least `persistence` of that before.
///
/// The floor is the largest of `floor_rad`, `floor_share` of the largest error of the unperturbed
/// flight and, for a flight that is disturbed to its end, twice the swing of its last third unperturbed.
///
/// Errs on the side of not held: an oscillation that shrinks by less than `persistence` p asks counts as
/// one that lasts, so that a margin is that of a loop whose oscillation decays by $3 \ln(1/p) / t$ a
/// second in a flight of length t, and less so the longer it is. What is slower than a third of the flight is judged by the part that is seen
/// of it: fly at least three periods of the slowest motion that matters. What is not seen: an
/// oscillation below the floor, and one that is still shrinking fast towards a size at which it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Smallest ratio of swings that is a failure. Somewhat below 1, so that what lasts fails in spite
    /// of samples that miss its peaks.
    pub growth: f64,
    /// Smallest ratio of oscillations that is a failure.
    pub persistence: f64,
    /// Floor as a share of the largest error of the unperturbed flight.
    pub floor_share: f64,
    /// Floor, rad.
    pub floor_rad: f64,
}

impl Default for Criterion {
    /// 0.995, 0.75, 1 % and 0. Samples of 30 or more a period miss peaks by at most 0.5 %; an oscillation
    /// that comes down to a size at which it lasts was seen to lose 10 % from third to third on its way.
    fn default() -> Self {
        Self { growth: 0.995, persistence: 0.75, floor_share: 0.01, floor_rad: 0.0 }
    }
}

/// Evolution of a flight's error: its envelope over successive parts of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Largest error, rad.
    pub largest_rad: f64,
    /// Largest less smallest error in the middle and the last third of the flight, rad.
    pub swings_rad: [f64; 2],
    /// The same about a straight line, rad.
    pub oscillations_rad: [f64; 2],
    /// How the flight ended.
    pub outcome: Outcome,
}

/// Why a flight does not count as held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// It ended before its last sample.
    EndedEarly(EarlyEnd),
    /// The error swings as far as before, or further.
    Swings {
        /// Swing of the middle third, rad.
        middle_rad: f64,
        /// Swing of the last third, rad.
        last_rad: f64,
    },
    /// The error goes on oscillating.
    Oscillates {
        /// Oscillation of the middle third, rad.
        middle_rad: f64,
        /// Oscillation of the last third, rad.
        last_rad: f64,
    },
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EndedEarly(EarlyEnd { at_s, cause }) => write!(f, "{cause} at t = {at_s:.2} s"),
            Self::Swings { .. } => {
                f.write_str("in its last third the error swings as far as in its middle one")
            }
            Self::Oscillates { .. } => {
                f.write_str("in its last third the error goes on oscillating as in its middle one")
            }
        }
    }
}

impl Envelope {
    /// Flies and watches.
    ///
    /// # Errors
    /// As [`Respondent::fly`].
    pub fn of(
        prepared: &Prepared,
        respondent: Respondent<'_>,
        perturbation: &Perturbation,
    ) -> Result<Self, SimError> {
        let rows = prepared.timing().rows();
        let mut errors_rad = Vec::with_capacity(rows);
        let outcome = respondent.fly(prepared, perturbation, |instant| {
            errors_rad.push(instant.setpoint_rad - instant.theta_rad);
            ControlFlow::Continue(())
        })?;
        let third = |number: usize| {
            errors_rad.get(number * rows / 3..(number + 1) * rows / 3).unwrap_or_default()
        };
        Ok(Self {
            largest_rad: errors_rad.iter().fold(0.0, |most, error| most.max(error.abs())),
            swings_rad: [1, 2].map(|number| swing(third(number).iter().copied())),
            oscillations_rad: [1, 2].map(|number| oscillation(third(number))),
            outcome,
        })
    }

    /// Why the flight does not count as held above this floor, rad; `None` if it does.
    #[must_use]
    pub fn failure(&self, criterion: &Criterion, floor_rad: f64) -> Option<Failure> {
        match self.outcome {
            Outcome::EndedEarly(end) => return Some(Failure::EndedEarly(end)),
            // What a mode waits for says nothing of the pitch loop.
            Outcome::Completed | Outcome::ModeNeverBegan { .. } => {}
        }
        // Written so that NaN is not held.
        let holds = |[before, last]: [f64; 2], ratio| last <= floor_rad || last < ratio * before;
        let [middle_rad, last_rad] = self.swings_rad;
        if !holds(self.swings_rad, criterion.growth) {
            return Some(Failure::Swings { middle_rad, last_rad });
        }
        let [middle_rad, last_rad] = self.oscillations_rad;
        let lasts = !holds(self.oscillations_rad, criterion.persistence);
        lasts.then_some(Failure::Oscillates { middle_rad, last_rad })
    }
}

/// Largest less smallest; 0 of nothing.
fn swing(values: impl Iterator<Item = f64>) -> f64 {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (least, most) = values.fold(ends, |(least, most), x| (least.min(x), most.max(x)));
    (most - least).max(0.0)
}

/// Swing about the straight line of least squares.
fn oscillation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let numbered = || (0_u32..).map(f64::from).map(|k| k - middle).zip(values);
    let mean = values.iter().sum::<f64>() / count;
    let (products, squares) = numbered()
        .fold((0.0, 0.0), |(products, squares), (k, x)| (products + k * x, squares + k * k));
    let slope = if squares > 0.0 { products / squares } else { 0.0 };
    swing(numbered().map(|(k, x)| x - mean - slope * k))
}

impl Criterion {
    /// The floor that goes with an unperturbed flight, rad.
    pub(crate) fn floor_rad(&self, nominal: &Envelope, quiet: bool) -> f64 {
        let [_, last_rad] = nominal.swings_rad;
        let answered_rad = if quiet { 0.0 } else { 2.0 * last_rad };
        self.floor_rad.max(self.floor_share * nominal.largest_rad).max(answered_rad)
    }
}

/// True where nothing new happens to the loop after the first third of the flight, so that what still
/// swings then swings by itself.
pub(crate) fn is_quiet(scenario: &Scenario, prepared: &Prepared) -> bool {
    let from = prepared.timing.rows() / 3;
    let still = |values: &[f64]| {
        let later = values.get(from..).unwrap_or_default();
        later.windows(2).all(|pair| pair[0].to_bits() == pair[1].to_bits())
    };
    let entries = [&prepared.at_servo, &prepared.at_elevator, &prepared.at_measurement];
    let still_entries = entries.into_iter().flatten().all(|column| still(column));
    let calm = match (prepared.gusts(), &scenario.surroundings.weather) {
        (Some(gusts), _) => {
            (0..3).all(|part| still(&gusts.iter().map(|gust| gust[part]).collect::<Vec<f64>>()))
        }
        // What an aircraft meets depends on its way.
        (None, weather) => weather.is_none(),
    };
    let same_plant = prepared.stages.iter().all(|stage| stage.from <= from);
    let sensors = [prepared.pitch_sensor, prepared.rate_sensor];
    let silent = sensors.iter().flatten().all(is_silent);
    still(&prepared.setpoint_rad) && still_entries && calm && same_plant && silent
}

fn is_silent(sensor: &Sensor) -> bool {
    let model = sensor.model();
    !(model.noise_density > 0.0 || model.drift > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_does_not_oscillate_and_a_sine_on_it_does() {
        let line = |k: i32| 3.0 - 0.25 * f64::from(k);
        let values: Vec<f64> = (0..100).map(line).collect();
        assert!(oscillation(&values) < 1e-12);
        let sine = |k: i32| crate::math::sin_cos(0.7 * f64::from(k)).0;
        let values: Vec<f64> = (0..1000).map(|k| line(k) + sine(k)).collect();
        assert!((oscillation(&values) - 2.0).abs() < 0.02, "{}", oscillation(&values));
        assert_eq!(oscillation(&[]), 0.0);
    }

    #[test]
    fn what_shrinks_holds_and_what_lasts_or_is_no_number_does_not() {
        let flown = |swings_rad, oscillations_rad| {
            let outcome = Outcome::Completed;
            let envelope = Envelope { largest_rad: 1.0, swings_rad, oscillations_rad, outcome };
            envelope.failure(&Criterion::default(), 0.01)
        };
        assert_eq!(flown([0.5, 0.4], [0.5, 0.3]), None);
        assert_eq!(flown([0.001, 0.009], [0.001, 0.009]), None);
        assert!(matches!(flown([0.5, 0.5], [0.1, 0.05]), Some(Failure::Swings { .. })));
        assert!(matches!(flown([0.5, 0.4], [0.5, 0.4]), Some(Failure::Oscillates { .. })));
        assert!(flown([f64::NAN; 2], [0.1, 0.0]).is_some());
    }
}
