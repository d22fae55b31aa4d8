//! Flying a study: every controller's trace, measures and verdict, and whether requirements are met.

mod csv;
mod json;
mod text;

pub(crate) use json::finite;
pub(crate) use text::left_validity;

use fspid_lti::LtiError;
use fspid_sim::stability::instability;
use fspid_sim::{Controller, NamedController, SimError, Trace, simulate};

use crate::file::Study;
use crate::metrics::FlightMetrics;
pub use crate::requirement::Judgement;
use crate::requirement::{flown_on_their_own, judge};

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
    /// Flies the study; and once more for ready sets that ask for a step which its command does not have.
    ///
    /// # Errors
    /// [`SimError`] where the plants cannot be sampled; an unstable loop is a result, not an error.
    pub fn of(study: &Study) -> Result<Self, SimError> {
        let mut simulation = Self::as_commanded(study)?;
        flown_on_their_own(study, &mut simulation.judgements)?;
        Ok(simulation)
    }

    /// Flies the study with its own command alone.
    pub(crate) fn as_commanded(study: &Study) -> Result<Self, SimError> {
        let scenario = &study.scenario;
        let flight = simulate(scenario)?;
        let results = scenario
            .controllers
            .iter()
            .zip(flight.traces)
            .map(|(named, trace)| {
                let unstable = instability(scenario, &named.controller)
                    .map_err(|error| too_large(error, named))?;
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

/// A sampled loop that leaves the range of numbers, blamed on the gain that is farthest out.
pub(crate) fn too_large(error: SimError, named: &NamedController) -> SimError {
    let SimError::Linear(LtiError::NotFinite { .. } | LtiError::OutOfRange { .. }) = error else {
        return error;
    };
    let gains = named.controller.nominal();
    let all = [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)];
    let rate = ("rate_gain", named.controller.shell().rate_gain_s);
    let largest = all.into_iter().fold(rate, |a, b| if b.1.abs() > a.1.abs() { b } else { a });
    let key = match &named.controller {
        Controller::SelfTuning(_) if largest.0 != "rate_gain" => format!("nominal.{}", largest.0),
        _ => largest.0.to_owned(),
    };
    SimError::TooLarge { key: format!("controller.{}.{key}", named.name), found: largest.1 }
}
