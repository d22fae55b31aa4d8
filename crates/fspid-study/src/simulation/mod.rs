//! Flying a study: every controller's trace, measures and verdict, and whether requirements are met.

mod csv;
mod json;
mod own_flight;
mod text;

pub use crate::flight::{
    ControllerResult, Ending, FAILS_BY_ITSELF, FailedFlight, WRONG_WAY, flies_on,
};
pub use crate::judgement::Judgement;
pub(crate) use json::own_flight;

use fspid_sim::stability::{Unstable, instability};
use fspid_sim::{Flyer, RestPoint, Scenario, SimError, simulate};

use crate::analysis::{AtRest, too_large};
use crate::judgement::judge;
use fspid_scenario::file::{RangeRule, Study};

/// A study that has been flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Name of the scenario.
    pub scenario: String,
    /// One result a controller, in the file's order.
    pub results: Vec<ControllerResult>,
    /// One judgement for each requirement and controller it concerns.
    pub judgements: Vec<Judgement>,
    /// What is made of leaving the range of the aircraft's data.
    pub range_rule: RangeRule,
    /// Flights of ready sets' own that fail whatever is required of them.
    pub failed_own_flights: Vec<FailedFlight>,
}

impl Simulation {
    /// Flies the study; and once more for ready sets that ask for a step which its command does not have.
    ///
    /// # Errors
    /// [`SimError`] where the plants cannot be sampled; an unstable loop is a result, not an error.
    pub fn of(study: &Study) -> Result<Self, SimError> {
        let mut simulation = Self::as_commanded(study)?;
        let Self { judgements, failed_own_flights, .. } = &mut simulation;
        *failed_own_flights = own_flight::flown(study, judgements)?;
        Ok(simulation)
    }

    /// The same for the figures of a paper, which show a window and say nothing of what comes after: a loop that grows
    /// around a held set-point or load alone keeps the measures of its window. A note says that it grows.
    ///
    /// # Errors
    /// As [`Simulation::of`].
    pub fn of_window(study: &Study) -> Result<Self, SimError> {
        Self::flown(study, |unstable| unstable.at == RestPoint::TRIM)
    }

    /// Flies the study with its own command alone.
    pub(crate) fn as_commanded(study: &Study) -> Result<Self, SimError> {
        Self::flown(study, |_| true)
    }

    /// Flies the study; a loop that grows has no measures where it `counts`.
    fn flown(study: &Study, counts: impl Fn(&Unstable) -> bool) -> Result<Self, SimError> {
        let scenario = &study.scenario;
        let flight = simulate(scenario)?;
        let results = scenario
            .flyers()
            .zip(flight.traces)
            .map(|(flyer, trace)| {
                let at_rest = at_rest(scenario, flyer)?;
                let unstable = at_rest.unstable.filter(&counts);
                let (flown, rest) = ((trace, &flight.edges[..]), (at_rest, unstable));
                Ok(ControllerResult::of(study, flyer.name(), flown, rest))
            })
            .collect::<Result<Vec<_>, SimError>>()?;
        let judgements = judge(study, &results);
        let (scenario, range_rule) = (scenario.name.clone(), study.range_rule);
        let failed_own_flights = Vec::new();
        Ok(Self { scenario, results, judgements, range_rule, failed_own_flights })
    }

    /// True if every requirement is met and no flight failed of which something is required.
    #[must_use]
    pub fn requirements_met(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.met)
            && self.failed_flights().iter().all(|failed| !self.is_asked(failed))
    }

    /// Flights that failed whatever is required of them: those of the scenario, then those of ready sets' own.
    #[must_use]
    pub fn failed_flights(&self) -> Vec<FailedFlight> {
        let flown = self.results.iter().filter_map(|result| result.failed(None));
        flown.chain(self.failed_own_flights.iter().cloned()).collect()
    }

    /// True for a flight of a controller of which something is required.
    #[must_use]
    pub fn is_asked(&self, failed: &FailedFlight) -> bool {
        self.judgements.iter().any(|judgement| {
            let asked = judgement.requirement.controller.as_ref();
            asked.is_none_or(|name| *name == failed.controller)
        })
    }

    /// The result of the controller with this name.
    #[must_use]
    pub fn result(&self, name: &str) -> Option<&ControllerResult> {
        self.results.iter().find(|result| result.name == name)
    }
}

/// The loop of who flies, at the gains that it has at rest.
fn at_rest(scenario: &Scenario, flyer: Flyer<'_>) -> Result<AtRest, SimError> {
    let Flyer::Own(named) = flyer else { return Ok(AtRest::unknown()) };
    // Numbers so large that the loop cannot be judged are refused by their keys.
    // What another simulator flies has no loop that could be asked, which is told beside its flight.
    if scenario.plant.external().is_none() {
        instability(scenario, &named.controller).map_err(|error| too_large(error, named))?;
    }
    Ok(AtRest::of(scenario, &named.controller))
}
