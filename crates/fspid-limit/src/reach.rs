//! The limit: proved from below, reached from above.

use fspid_sim::Scenario;

use crate::bound::prove;
use crate::error::LimitError;
use crate::history::{Flown, commands, fly_commands};
use crate::measure::Measure;
use crate::programme::Programme;
use crate::question::Question;
use crate::travel::Travel;

/// How good any controller could be within a travel.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The travel that was allowed, rad.
    pub travel_rad: f64,
    /// No history of commands gets below: proved, rad.
    pub proved: f64,
    /// What a history of commands reaches that the simulator flew, rad.
    pub reached: Flown,
}

/// The limit of a scenario's flight within a travel, rad; `stop` is asked now and then.
///
/// # Errors
/// [`LimitError`].
pub fn limit(
    scenario: &Scenario,
    question: &Question,
    (measure, travel): (Measure, Travel),
    travel_rad: f64,
    stop: fn() -> bool,
) -> Result<Limit, LimitError> {
    let solution = Programme::new(question, measure).solve(travel_rad, stop)?;
    let proved = prove(question, measure, travel_rad, &solution.multipliers)?;
    let reached = fly_commands(scenario, &commands(question, &solution), (measure, travel))?;
    Ok(Limit { travel_rad, proved, reached })
}
