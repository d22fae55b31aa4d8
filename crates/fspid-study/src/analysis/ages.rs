//! Whether margins that are taken with the largest age of a sensor's values are borne by the loop over all its ages as they come.

use fspid_sim::loop_model::SampledPlant;
use fspid_sim::{Controller, Doubt, LinearPlant, Rest, Scenario, SimError, Stand};

use super::Margins;
use crate::metrics::{Absent, WithinMargins};

/// Parts of a margin that are asked.
const PARTS: [f64; 4] = [0.999, 0.75, 0.5, 0.25];
/// Margins above are asked up to this, dB.
const MOST_DB: f64 = 40.0;
/// Most samples of a dead time that is asked: one that is longer is no question of ages.
const MOST_SAMPLES: f64 = 50.0;

/// A loop at rest with a sensor whose values change their age.
pub(super) struct Asked<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) plant: &'a LinearPlant,
    pub(super) rest: &'a Rest,
    pub(super) controller: &'a Controller,
}

impl Asked<'_> {
    /// The margins, or why they are none.
    pub(super) fn borne(&self, margins: Margins) -> Result<Result<Margins, Absent>, SimError> {
        let within = match self.gain_not_borne(&margins)? {
            Some(gain_db) => Some(WithinMargins::GainDb(gain_db)),
            None => self.delay_not_borne(&margins)?.map(WithinMargins::DelayS),
        };
        Ok(within.map_or(Ok(margins), |within| Err(Absent::AgesAsTheyCome { within })))
    }

    /// The smallest of some gains within the margins with which the loop grows.
    fn gain_not_borne(&self, margins: &Margins) -> Result<Option<f64>, SimError> {
        let mut found: Option<f64> = None;
        for end_db in margins.gain_margin_db {
            let end_db = end_db.clamp(-MOST_DB, MOST_DB);
            for gain_db in PARTS.map(|part| part * end_db) {
                let plant = self.plant.with_gain(libm::pow(10.0, gain_db / 20.0))?;
                if !self.grows(self.scenario, &plant)? {
                    continue;
                }
                found = found.filter(|it| it.abs() < gain_db.abs()).or(Some(gain_db));
            }
        }
        Ok(found)
    }

    /// The same of dead times of whole samples.
    fn delay_not_borne(&self, margins: &Margins) -> Result<Option<f64>, SimError> {
        let dt_s = self.scenario.timing.dt_s();
        let most = PARTS[0] * margins.delay_margin_s / dt_s;
        let own = self.scenario.actuator.delay_samples();
        let mut asked = PARTS.map(|part| (part / PARTS[0] * most).floor()).to_vec();
        asked.retain(|samples| *samples >= 1.0 && *samples <= MOST_SAMPLES);
        asked.dedup();
        let mut found = None;
        for samples in asked {
            let actuator = self.scenario.actuator.with_delay(own + samples as usize)?;
            let later = Scenario { actuator, ..self.scenario.clone() };
            if self.grows(&later, self.plant)? {
                found = Some(samples * dt_s);
            }
        }
        Ok(found)
    }

    fn grows(&self, scenario: &Scenario, plant: &LinearPlant) -> Result<bool, SimError> {
        let sampled = SampledPlant::of(scenario, plant)?;
        let stand = self.rest.stand(scenario, &sampled, self.controller)?;
        Ok(matches!(stand, Stand::Grows { .. } | Stand::Undecided(Doubt::ChangingAge)))
    }
}
