//! Flying a study: every controller's trace, measures and verdict, and whether requirements are met.

mod csv;
mod json;
mod text;

pub(crate) use json::finite;
pub(crate) use text::left_validity;

use fspid_sim::stability::instability;
use fspid_sim::{SimError, Trace, simulate};

use crate::file::Study;
use crate::metrics::FlightMetrics;
pub use crate::requirement::Judgement;
use crate::requirement::judge;

/// One controller's flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerResult {
    /// Name of the controller.
    pub name: String,
    /// What happened.
    pub trace: Trace,
    /// What it amounts to.
    pub metrics: FlightMetrics,
}

/// A study that has been flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Name of the scenario.
    pub scenario: String,
    /// One result a controller, in the file's order.
    pub results: Vec<ControllerResult>,
    /// One judgement for each requirement and controller it concerns.
    pub judgements: Vec<Judgement>,
}

impl Simulation {
    /// Flies the study.
    ///
    /// # Errors
    /// [`SimError`] where the plants cannot be sampled; an unstable loop is a result, not an error.
    pub fn of(study: &Study) -> Result<Self, SimError> {
        let scenario = &study.scenario;
        let flight = simulate(scenario)?;
        let results = scenario
            .controllers
            .iter()
            .zip(flight.traces)
            .map(|(named, trace)| {
                let unstable = instability(scenario, &named.controller)?;
                let metrics = FlightMetrics::of(&trace, &flight.edges, scenario.timing, unstable);
                Ok(ControllerResult { name: named.name.clone(), trace, metrics })
            })
            .collect::<Result<Vec<_>, SimError>>()?;
        let judgements = judge(study, &results);
        Ok(Self { scenario: scenario.name.clone(), results, judgements })
    }

    /// True if every requirement is met.
    #[must_use]
    pub fn requirements_met(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.met)
    }

    /// The result of the controller with this name.
    #[must_use]
    pub fn result(&self, name: &str) -> Option<&ControllerResult> {
        self.results.iter().find(|result| result.name == name)
    }
}
