//! Whether a flight held: what its error did from one third of the flight to the next.

use std::ops::ControlFlow;

use super::Perturbation;
use crate::closed_loop::fly_perturbed;
use crate::controller::Controller;
use crate::error::SimError;
use crate::scenario::{Prepared, Scenario};
use crate::sensor::Sensor;
use crate::trace::Outcome;

/// When a flight counts as not held: it diverged, or the swing $\max e - \min e$ of the error $e$
/// (set-point less true pitch angle) in its last third is above a floor and at least `growth` of that
/// in its middle third.
///
/// The floor is the largest of `floor_rad`, `floor_share` of the largest error of the unperturbed
/// flight and, for a flight that is disturbed to its end, twice the swing of its last third unperturbed.
///
/// What is slower than a third of the flight is judged by the part that is seen of it: fly at least
/// three periods of the slowest motion that matters. An oscillation that stays below the floor is not
/// seen, and one that has not yet come down to the size at which it lasts counts as held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Smallest ratio of the swings that is a failure. Somewhat below 1, so that an oscillation that
    /// lasts fails in spite of samples that miss its peaks.
    pub growth: f64,
    /// Floor as a share of the largest error of the unperturbed flight.
    pub floor_share: f64,
    /// Floor, rad.
    pub floor_rad: f64,
}

impl Default for Criterion {
    /// 0.995, 0.2 % and 0: samples of 30 or more a period miss peaks by at most 0.5 %.
    fn default() -> Self {
        Self { growth: 0.995, floor_share: 0.002, floor_rad: 0.0 }
    }
}

/// What the error of a flight did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Largest error, rad.
    pub largest_rad: f64,
    /// Largest less smallest error in each third of the flight, rad.
    pub swings_rad: [f64; 3],
    /// How the flight ended.
    pub outcome: Outcome,
}

/// Why a flight does not count as held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// It left every range.
    Diverged {
        /// When, s.
        at_s: f64,
    },
    /// The error goes on swinging.
    Swings {
        /// Swing of the middle third, rad.
        middle_rad: f64,
        /// Swing of the last third, rad.
        last_rad: f64,
    },
}

impl Envelope {
    /// Flies and watches.
    ///
    /// # Errors
    /// As [`fly_perturbed`].
    pub fn of(
        prepared: &Prepared,
        controller: &Controller,
        perturbation: &Perturbation,
    ) -> Result<Self, SimError> {
        let rows = prepared.timing().rows();
        let mut ends_rad = [(f64::INFINITY, f64::NEG_INFINITY); 3];
        let mut largest_rad = 0.0_f64;
        let outcome = fly_perturbed(prepared, controller, perturbation, |instant| {
            let error_rad = instant.setpoint_rad - instant.theta_rad;
            largest_rad = largest_rad.max(error_rad.abs());
            if let Some((least, most)) = ends_rad.get_mut(3 * instant.k / rows) {
                (*least, *most) = (least.min(error_rad), most.max(error_rad));
            }
            ControlFlow::Continue(())
        })?;
        // A third without samples has no swing.
        let swings_rad = ends_rad.map(|(least, most)| (most - least).max(0.0));
        Ok(Self { largest_rad, swings_rad, outcome })
    }

    /// Why the flight does not count as held with this floor, rad; `None` if it does.
    #[must_use]
    pub fn failure(&self, growth: f64, floor_rad: f64) -> Option<Failure> {
        if let Outcome::Diverged { at_s } = self.outcome {
            return Some(Failure::Diverged { at_s });
        }
        let [_, middle_rad, last_rad] = self.swings_rad;
        // Written so that NaN fails.
        let held = last_rad <= floor_rad || last_rad < growth * middle_rad;
        (!held).then_some(Failure::Swings { middle_rad, last_rad })
    }
}

impl Criterion {
    /// The floor that goes with an unperturbed flight, rad.
    pub(crate) fn floor_rad(&self, nominal: &Envelope, quiet: bool) -> f64 {
        let [_, _, last_rad] = nominal.swings_rad;
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
