//! One controller's flight with its measures, how it ended, and what is said of it.

mod ending;
mod words;

pub(crate) use ending::on_its_own;
pub use ending::{Ending, FAILS_BY_ITSELF, FailedFlight};
pub use words::WRONG_WAY;

use fspid_sim::signal::Edge;
use fspid_sim::stability::{Unstable, doubt_of_flight};
use fspid_sim::{NamedController, Noises, Plant, Scenario, Trace};

use crate::analysis::{AtRest, RestGains};
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
    /// Something limits the command or the elevator.
    pub is_limited: bool,
}

impl ControllerResult {
    /// A flight of a study and its measures, whose loop at rest is asked by the flight as it goes on; `unstable` is what that loop
    /// counts for there.
    #[must_use]
    pub fn of(
        study: &Study,
        name: &str,
        (trace, edges): (Trace, &[Edge]),
        (at_rest, unstable): (AtRest, Option<Unstable>),
    ) -> Self {
        let scenario = &study.scenario;
        let flies_on = flies_on(scenario, name, &at_rest);
        let doubt = flies_on.and_then(|it| doubt_of_flight(scenario, &it.controller, &trace));
        Self::measured(study, name, (trace, edges), (at_rest.doubted(doubt), unstable))
    }

    /// The same of a loop at rest that has been asked so.
    #[must_use]
    pub fn measured(
        study: &Study,
        name: &str,
        (trace, edges): (Trace, &[Edge]),
        (at_rest, unstable): (AtRest, Option<Unstable>),
    ) -> Self {
        let scenario = &study.scenario;
        let (timing, pushes_s) = (scenario.timing, scenario.pushes_s(Noises::None));
        let named = scenario.controllers.iter().find(|it| it.name == name);
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
            is_limited: is_limited(scenario, named),
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

/// The controller of that name where its flight, as it goes on, says more of its loop than the loop at rest: who flies without
/// equations is no controller that could fly on.
#[must_use]
pub fn flies_on<'a>(
    scenario: &'a Scenario,
    name: &str,
    at_rest: &AtRest,
) -> Option<&'a NamedController> {
    let has_equations = at_rest.gains != RestGains::Unknown;
    let is_open = has_equations && at_rest.unstable.is_none() && at_rest.undecided.is_none();
    scenario.controllers.iter().find(|it| is_open && it.name == name)
}

/// Whether the controller's own limits, those of the servo's command or the stops of the elevator end what is commanded. What
/// is not flown by equations of ours has limits that nobody here knows.
fn is_limited(scenario: &Scenario, named: Option<&NamedController>) -> bool {
    let actuator = &scenario.actuator;
    let of_controller = named.is_none_or(|it| it.controller.config().limits.is_some());
    let of_servo = actuator.command_limits_rad().or(actuator.travel_rad()).is_some();
    of_controller || of_servo || !matches!(scenario.plant, Plant::Linear(_))
}
