//! Flying a study: every controller's trace, measures and verdict, and whether requirements are met.

mod csv;
mod json;
mod text;
mod words;

pub(crate) use json::finite;
pub use words::WRONG_WAY;
pub use words::left_validity;

use fspid_lti::LtiError;
use fspid_sim::stability::instability;
use fspid_sim::{Controller, Exit, NamedController, SimError, Trace, simulate};

use crate::analysis::AtRest;
use crate::file::{RangeRule, Study};
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
    /// The loop at the gains that it has at rest.
    pub at_rest: AtRest,
    /// What is made of leaving the range of the aircraft's data.
    pub range_rule: RangeRule,
    /// How long the flight should have been, s.
    pub duration_s: f64,
}

impl ControllerResult {
    /// Why the flight fails whatever is required of it: a verdict without measures, a range that was left. Empty for
    /// one that does not.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let verdict = self.metrics.verdict;
        let mut failures: Vec<String> = Vec::new();
        if verdict.is_failure() {
            failures.push(verdict.to_string());
        }
        failures.extend(self.metrics.wrong_way.then(|| WRONG_WAY.to_owned()));
        failures
            .extend(failing_exit(self.trace.exit, self.range_rule).map(|it| left_validity(&it)));
        failures
    }
}

/// The range that was left, where that is a failure.
#[must_use]
pub fn failing_exit(exit: Option<Exit>, range_rule: RangeRule) -> Option<Exit> {
    match range_rule {
        RangeRule::Fails => exit,
        RangeRule::Warns | RangeRule::Linear | RangeRule::NoRange => None,
    }
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
    /// What is made of leaving the range of the aircraft's data.
    pub range_rule: RangeRule,
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
                // Numbers so large that the loop cannot be judged are refused by their keys.
                instability(scenario, &named.controller)
                    .map_err(|error| too_large(error, named))?;
                let at_rest = AtRest::of(scenario, &named.controller);
                let unstable = at_rest.unstable;
                let metrics = FlightMetrics::of(&trace, &flight.edges, scenario.timing, unstable);
                let (name, range_rule) = (named.name.clone(), study.range_rule);
                let duration_s = scenario.timing.end_s();
                Ok(ControllerResult { name, trace, metrics, at_rest, range_rule, duration_s })
            })
            .collect::<Result<Vec<_>, SimError>>()?;
        let judgements = judge(study, &results);
        let (scenario, range_rule) = (scenario.name.clone(), study.range_rule);
        Ok(Self { scenario, results, judgements, range_rule })
    }

    /// True if every requirement is met and no flight failed of which something is required.
    #[must_use]
    pub fn requirements_met(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.met)
            && self.failed_flights().next().is_none()
    }

    /// Flights that failed whatever is required of them, of controllers of which something is required.
    pub fn failed_flights(&self) -> impl Iterator<Item = &ControllerResult> {
        let asked = |result: &&ControllerResult| {
            self.judgements.iter().any(|judgement| {
                judgement.requirement.controller.as_ref().is_none_or(|name| *name == result.name)
            })
        };
        self.results.iter().filter(asked).filter(|result| !result.failures().is_empty())
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
