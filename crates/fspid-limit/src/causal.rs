//! Best causal planner: a reference controller that knows the plant, the past and the present but not the future. A
//! comparison beside the limit, not a bound.
//!
//! At every sample at which set-point, disturbances or air are not what they were, the rest of the flight is planned anew by
//! the same programme, as if everything stayed as it is now. A planner that had a travel to spend would spend all of it on
//! the first event; so travel has a price, one for the whole flight, and the price is chosen such that the flight spends
//! what it may. Gains that are tuned on the flight are chosen with the same hindsight.
//!
//! Neither travel nor error need fall or rise with the price: plans go wrong that take everything for over. So every flight
//! is kept, whoever asked for it, and the best one within a travel is told.

use fspid_sim::Scenario;

use crate::error::LimitError;
use crate::history::{Flown, fly_commands, target};
use crate::measure::Measure;
use crate::programme::{Begin, Coming, Programme, Solution, Spending};
use crate::question::Question;
use crate::reach::keeps_within;
use crate::travel::Travel;

/// Most samples at which something may change: each is planned anew.
pub const MOST_EVENTS: usize = 24;
/// Exponents of the prices of which every search begins: from one that forbids nothing to one that forbids all motion.
const EXPONENTS: [i32; 2] = [-8, 3];
/// Halvings of what lies between two of them.
const HALVINGS: usize = 9;

/// Error reached by a flight, and the travel it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The measure, rad.
    pub measure: f64,
    /// The travel, rad.
    pub travel_rad: f64,
}

impl From<&Flown> for Reached {
    fn from(flown: &Flown) -> Self {
        Self { measure: flown.measure, travel_rad: flown.travel_rad }
    }
}

impl Reached {
    /// The least measure of these within a travel, rad; of equals the first.
    #[must_use]
    pub fn least_within(travel_rad: f64, all: impl IntoIterator<Item = Self>) -> Option<Self> {
        let within = all.into_iter().filter(|it| keeps_within(it.travel_rad, travel_rad));
        within.fold(None, |best: Option<Self>, it| match best {
            Some(best) if best.measure <= it.measure => Some(best),
            _ => Some(it),
        })
    }
}

/// A causal planner, with every flight that it has simulated.
#[derive(Debug)]
pub struct Planner<'a> {
    scenario: &'a Scenario,
    question: &'a Question,
    programme: Programme<'a>,
    asked: (Measure, Travel),
    events: Vec<usize>,
    stop: fn() -> bool,
    /// By the exponent of the price, ascending; nothing where its plans lose the aircraft or have no answer.
    flown: Vec<(f64, Option<Reached>)>,
}

impl<'a> Planner<'a> {
    /// Of a flight; `None` where something changes at more than [`MOST_EVENTS`] samples, as noise and turbulence do.
    #[must_use]
    pub fn new(
        scenario: &'a Scenario,
        question: &'a Question,
        asked: (Measure, Travel),
        stop: fn() -> bool,
    ) -> Option<Self> {
        let programme = Programme::new(question, asked.0);
        let events = events(question, &programme);
        let few = events.len() <= MOST_EVENTS;
        let flown = Vec::new();
        few.then_some(Self { scenario, question, programme, asked, events, stop, flown })
    }

    /// How often it plans in a flight.
    #[must_use]
    pub fn plans(&self) -> usize {
        self.events.len()
    }

    /// What every flight so far reached and took: the better for each travel that was searched.
    pub fn reached(&self) -> impl Iterator<Item = Reached> + '_ {
        self.flown.iter().filter_map(|(_, it)| *it)
    }

    /// Looks for the flights that come nearest to a travel, rad.
    ///
    /// # Errors
    /// [`LimitError::Stopped`]; errors of the scenario.
    pub fn search(&mut self, travel_rad: f64) -> Result<(), LimitError> {
        let keeps =
            |it: Option<Reached>| it.is_some_and(|it| keeps_within(it.travel_rad, travel_rad));
        let exponents = EXPONENTS[0]..=EXPONENTS[1];
        let mut begin = Vec::new();
        for exponent in exponents.map(f64::from) {
            begin.push((exponent, keeps(self.at(exponent)?)));
        }
        // Wherever one keeps to it and the next does not, the price is made as low as may be.
        for pair in begin.windows(2).filter(|pair| pair[0].1 != pair[1].1) {
            let [(mut low, from), (mut high, _)] = [pair[0], pair[1]];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if keeps(self.at(middle)?) == from { &mut low } else { &mut high }) = middle;
            }
        }
        Ok(())
    }

    /// The flight at a price, flown once.
    fn at(&mut self, exponent: f64) -> Result<Option<Reached>, LimitError> {
        match self.flown.binary_search_by(|(known, _)| known.total_cmp(&exponent)) {
            Ok(place) => Ok(self.flown.get(place).and_then(|(_, it)| *it)),
            Err(place) => {
                let reached = self.fly(libm::exp10(exponent))?;
                self.flown.insert(place, (exponent, reached));
                Ok(reached)
            }
        }
    }

    fn fly(&self, price: f64) -> Result<Option<Reached>, LimitError> {
        let planned = self
            .planned(price)
            .and_then(|planned| fly_commands(self.scenario, &planned, self.asked));
        match planned {
            Ok(flown) => Ok(Some(Reached::from(&flown))),
            // Nothing is reached at this price; others may do.
            Err(LimitError::Solver { .. } | LimitError::TravelTooSmall) => Ok(None),
            Err(other) => Err(other),
        }
    }

    /// The commands of the whole flight at a price of travel, rad, as they are given: nobody takes back what he gave before
    /// he knew better, even where the actuator cuts it.
    fn planned(&self, price: f64) -> Result<Vec<f64>, LimitError> {
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
        let mut commands_rad = Vec::with_capacity(rows);
        // Those on their way, as the plans have them: what they amount to where a rate limit holds the elevator.
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
            let quiet = question.quiet_as_at(k, at(&state, question.plant.deflection));
            let coming = Coming { setpoint_rad: &setpoint, entering: &entering, quiet_rad: &quiet };
            let plan = self.programme.solve_from(&begin, Spending::At(price), coming, self.stop)?;
            // Commands as they are given now, for the servo as it is disturbed now.
            let command = |target: f64| question.command_of(target) - question.at_servo(k);
            for j in k..until {
                let arrives = (j + delay).min(question.target_end() - 1);
                given_rad.push(question.allowed(j, command(at(&plan.target_rad, arrives))));
                let own = command(target(question, &plan, arrives));
                commands_rad.push(question.allowed(j, own));
            }
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
        Ok(commands_rad)
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

/// Samples at which something is not what it was, the first among them.
fn events(question: &Question, programme: &Programme<'_>) -> Vec<usize> {
    let Coming { setpoint_rad, entering, .. } = programme.coming();
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

fn at(values: &[f64], k: usize) -> f64 {
    values.get(k).copied().unwrap_or(0.0)
}
