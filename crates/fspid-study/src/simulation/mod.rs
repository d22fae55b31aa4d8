//! Flying a study: every controller's trace, measures and verdict, and whether requirements are met.

mod csv;
mod ending;
mod json;
mod text;
mod words;

pub(crate) use ending::on_its_own;
pub use ending::{Ending, FAILS_BY_ITSELF, FailedFlight};
pub(crate) use json::own_flight;
pub use words::WRONG_WAY;

use fspid_lti::LtiError;
use fspid_sim::signal::Edge;
use fspid_sim::stability::{Unstable, instability, is_lost_at_a_limit};
use fspid_sim::{
    Controller, Flyer, NamedController, RestPoint, Scenario, SimError, Trace, simulate,
};

use crate::analysis::{AtRest, RestGains};
pub use crate::judgement::Judgement;
use crate::judgement::{flown_on_their_own, judge};
use crate::metrics::{Absent, FlightMetrics, Verdict};
use fspid_scenario::file::{RangeRule, Study};

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
    /// The air moves around the aircraft.
    pub in_moving_air: bool,
}

impl ControllerResult {
    /// A flight of a study and its measures; `unstable` is what its loop at rest counts for there.
    #[must_use]
    pub fn of(
        study: &Study,
        name: &str,
        (trace, edges): (Trace, &[Edge]),
        (at_rest, unstable): (AtRest, Option<Unstable>),
    ) -> Self {
        let scenario = &study.scenario;
        let (timing, pushes_s) = (scenario.timing, scenario.pushes_s());
        let named = scenario.controllers.iter().find(|it| it.name == name);
        // Who flies without equations is no controller that could fly on.
        let has_equations = at_rest.gains != RestGains::Unknown;
        let is_open = has_equations && at_rest.unstable.is_none() && at_rest.undecided.is_none();
        let is_lost =
            is_open && named.is_some_and(|it| is_lost_at_a_limit(scenario, &it.controller, &trace));
        let at_rest = if is_lost { at_rest.lost_at_a_limit() } else { at_rest };
        let mut metrics = FlightMetrics::of(&trace, edges, timing, unstable, &pushes_s);
        if named.is_none() {
            metrics.saturated_share = metrics.saturated_share.and(Err(Absent::OwnWord));
        }
        Self {
            name: name.to_owned(),
            metrics,
            trace,
            at_rest,
            range_rule: study.range_rule,
            duration_s: timing.end_s(),
            in_moving_air: scenario.has_moving_air(),
        }
    }

    /// How the flight ended.
    #[must_use]
    pub fn ending(&self) -> Ending {
        let (measured, exit) = (self.metrics.verdict, self.trace.exit);
        Ending { measured, exit, range_rule: self.range_rule }
    }

    /// What the flight comes to.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.ending().verdict()
    }

    /// Why the flight fails whatever is required of it; empty for one that does not.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        self.ending().failures()
    }

    /// The flight, if it fails whatever is required of it.
    pub(crate) fn failed(&self, own_step_deg: Option<f64>) -> Option<FailedFlight> {
        let failures = self.failures();
        let controller = self.name.clone();
        (!failures.is_empty()).then_some(FailedFlight { controller, own_step_deg, failures })
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
        *failed_own_flights = flown_on_their_own(study, judgements)?;
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

/// A sampled loop that leaves the range of numbers, blamed on the gain that is farthest out.
pub(crate) fn too_large(error: SimError, named: &NamedController) -> SimError {
    let SimError::Linear(LtiError::NotFinite { .. } | LtiError::OutOfRange { .. }) = error else {
        return error;
    };
    let gains = named.controller.nominal();
    let all = [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)];
    let rate = ("rate_gain", named.controller.config().rate_gain_s);
    let largest = all.into_iter().fold(rate, |a, b| if b.1.abs() > a.1.abs() { b } else { a });
    let key = match &named.controller {
        Controller::SelfTuning(_) if largest.0 != "rate_gain" => format!("nominal.{}", largest.0),
        _ => largest.0.to_owned(),
    };
    SimError::TooLarge { key: format!("controller.{}.{key}", named.name), found: largest.1 }
}
