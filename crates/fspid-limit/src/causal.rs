//! Somebody who knows plant, past and present, and not what comes: a reference beside the limit, which proves nothing.
//!
//! At every sample at which set-point, disturbances or air are not what they were, the rest of the flight is planned anew by
//! the same programme, as if everything stayed as it is now. A planner that had a travel to spend would spend all of it on
//! the first event; so travel has a price, one for the whole flight, and the price is chosen such that the flight spends
//! what it may. Gains that are tuned on the flight are chosen with the same hindsight.

use fspid_sim::Scenario;

use crate::error::LimitError;
use crate::history::{Flown, commands, fly_commands};
use crate::measure::Measure;
use crate::programme::{Begin, Coming, Programme, Solution, Spending};
use crate::question::Question;
use crate::travel::Travel;

/// Most samples at which something may change: each is planned anew.
pub const MOST_EVENTS: usize = 24;
/// Halvings of the price.
const HALVINGS: usize = 12;

/// What somebody reached who knows no future.
#[derive(Clone, Debug, PartialEq)]
pub struct Causal {
    /// How often it planned.
    pub plans: usize,
    /// What the simulator flew by its commands.
    pub reached: Flown,
}

/// What a planner without a future reaches within a travel, rad; `None` where something changes at more than
/// [`MOST_EVENTS`] samples, as noise and turbulence do.
///
/// # Errors
/// As [`limit`](crate::limit()).
pub fn causal(
    scenario: &Scenario,
    question: &Question,
    asked: (Measure, Travel),
    travel_rad: f64,
    stop: fn() -> bool,
) -> Result<Option<Causal>, LimitError> {
    let programme = Programme::new(question, asked.0);
    let events = events(question, &programme);
    if events.len() > MOST_EVENTS {
        return Ok(None);
    }
    let planner = Planner { question, programme: &programme, events: &events, stop };
    let mut best: Option<Flown> = None;
    // From a price that forbids all motion to one that forbids nothing.
    let (mut low, mut high) = (-8.0_f64, 3.0_f64);
    for _ in 0..HALVINGS {
        let exponent = 0.5 * (low + high);
        let flown = planner.flown(libm::exp10(exponent))?;
        let flown = fly_commands(scenario, &commands(question, &flown), asked)?;
        if flown.travel_rad <= travel_rad * (1.0 + 1e-6) {
            high = exponent;
            if best.as_ref().is_none_or(|best| flown.measure < best.measure) {
                best = Some(flown);
            }
        } else {
            low = exponent;
        }
    }
    Ok(best.map(|reached| Causal { plans: events.len(), reached }))
}

/// Samples at which something is not what it was, the first among them.
fn events(question: &Question, programme: &Programme<'_>) -> Vec<usize> {
    let Coming { setpoint_rad, entering } = programme.coming();
    let differs = |k: &usize| {
        let k = *k;
        k == 0
            || setpoint_rad.get(k) != setpoint_rad.get(k - 1)
            || question.at_servo(k).to_bits() != question.at_servo(k - 1).to_bits()
            || entering.get(k) != entering.get(k - 1)
    };
    // What changes at the last sample changes nothing any more.
    (0..question.rows.saturating_sub(1)).filter(differs).collect()
}

struct Planner<'a> {
    question: &'a Question,
    programme: &'a Programme<'a>,
    events: &'a [usize],
    stop: fn() -> bool,
}

impl Planner<'_> {
    /// The whole flight at a price of travel.
    fn flown(&self, price: f64) -> Result<Solution, LimitError> {
        let question = self.question;
        let (rows, delay) = (question.rows, question.delay());
        let all = self.programme.coming();
        let mut flight = Solution {
            value: 0.0,
            target_rad: vec![0.0; rows],
            deflection_rad: vec![0.0; rows],
            multipliers: crate::bound::Multipliers::default(),
        };
        let mut state = vec![0.0; question.plant.states];
        // Commands on their way, as they were given.
        let mut given_rad = vec![0.0; delay];
        for (place, &k) in self.events.iter().enumerate() {
            let until = self.events.get(place + 1).copied().unwrap_or(rows - 1);
            let now = |j: usize| if j < k { j } else { k };
            let setpoint: Vec<f64> = (0..rows).map(|j| at(all.setpoint_rad, now(j))).collect();
            let entering: Vec<Vec<f64>> =
                (0..rows).map(|j| all.entering.get(now(j)).cloned().unwrap_or_default()).collect();
            let arriving = |u: &f64| question.target_of(u + question.at_servo(k));
            let begin = Begin {
                sample: k,
                counted_rad: self.counted(&flight, k),
                before_rad: given_rad.iter().take(rows - 1 - k).map(arriving).collect(),
                state: state.clone(),
            };
            let coming = Coming { setpoint_rad: &setpoint, entering: &entering };
            let plan = self.programme.solve_from(&begin, Spending::At(price), coming, self.stop)?;
            // Commands as they are given now, for the servo as it is disturbed now.
            let new = (k + delay..until + delay).map(|j| {
                let target = at(&plan.target_rad, j.min(question.target_end() - 1));
                question.command_of(target) - question.at_servo(k)
            });
            given_rad.extend(new);
            for j in k..until {
                let target = question.target_of(given_rad[j - k] + question.at_servo(j));
                flight.target_rad[j] = target;
                flight.deflection_rad[j] =
                    state.get(question.plant.deflection).copied().unwrap_or(0.0);
                state = self.programme.moved(
                    &state,
                    target,
                    all.entering.get(j).map_or(&[], Vec::as_slice),
                );
            }
            given_rad.drain(..until - k);
        }
        Ok(flight)
    }

    /// What counted as travel at the sample before, rad.
    fn counted(&self, flight: &Solution, k: usize) -> Option<f64> {
        let counted = &self.question.counted;
        let before = k.checked_sub(1).filter(|before| *before >= counted.first)?;
        let of = match counted.state {
            Some(_) => &flight.deflection_rad,
            None => &flight.target_rad,
        };
        Some(at(of, before) + counted.offset(before))
    }
}

fn at(values: &[f64], k: usize) -> f64 {
    values.get(k).copied().unwrap_or(0.0)
}
