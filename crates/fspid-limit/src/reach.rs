//! The performance limit of a flight: lower bound by duality, upper bound by simulation.

use fspid_sim::Scenario;

use crate::bound::prove;
use crate::error::LimitError;
use crate::history::{Flown, commands, fly_commands};
use crate::measure::Measure;
use crate::programme::{Programme, Solution};
use crate::question::Question;
use crate::travel::Travel;

/// A solver spends a travel to its tolerance, and so do its commands in flight: within this share of it they keep to it.
const ROOM: f64 = 1e-6;
/// How often less travel is asked of the programme where its commands take more in flight than was allowed.
const LESS: usize = 4;

/// True for a flight that keeps within a travel, rad, to the tolerance of the solver.
#[must_use]
pub fn keeps_within(flown_rad: f64, travel_rad: f64) -> bool {
    flown_rad <= travel_rad * (1.0 + ROOM)
}

/// How good any controller could be within a travel.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The travel that was allowed, rad.
    pub travel_rad: f64,
    /// No history of commands gets below: proved, rad.
    pub proved: f64,
    /// What a history of commands reaches that the simulator flew within the travel; none where no commands of the
    /// programme kept to it, because it knows the actuator only from one side.
    pub reached: Option<Flown>,
}

/// The limit of a scenario's flight within a travel, rad; `stop` is asked now and then.
///
/// # Errors
/// [`LimitError`].
pub fn limit(
    scenario: &Scenario,
    question: &Question,
    asked: (Measure, Travel),
    travel_rad: f64,
    stop: fn() -> bool,
) -> Result<Limit, LimitError> {
    let programme = Programme::new(question, asked.0);
    let solution = programme.solve(travel_rad, stop)?;
    let proved = prove(question, asked.0, travel_rad, &solution.multipliers)?;
    let flyer = Flyer { scenario, question, programme: &programme, asked, stop };
    let reached = flyer.reached(travel_rad, solution)?;
    Ok(Limit { travel_rad, proved, reached })
}

/// Flies what a programme finds.
struct Flyer<'a> {
    scenario: &'a Scenario,
    question: &'a Question,
    programme: &'a Programme<'a>,
    asked: (Measure, Travel),
    stop: fn() -> bool,
}

impl Flyer<'_> {
    /// A flight within the travel, rad, from a solution for it on.
    fn reached(&self, travel_rad: f64, first: Solution) -> Result<Option<Flown>, LimitError> {
        let (mut solution, mut less_rad) = (first, travel_rad);
        for _ in 0..LESS {
            let flown =
                fly_commands(self.scenario, &commands(self.question, &solution), self.asked)?;
            if keeps_within(flown.travel_rad, travel_rad) {
                return Ok(Some(flown));
            }
            // The programme allows more than it is asked for where it counts for nothing what the servo moves.
            less_rad -= 1.01 * (flown.travel_rad - travel_rad);
            solution = match self.programme.solve(less_rad, self.stop) {
                Ok(solution) => solution,
                Err(LimitError::Stopped) => return Err(LimitError::Stopped),
                Err(_) => return Ok(None),
            };
        }
        Ok(None)
    }
}
