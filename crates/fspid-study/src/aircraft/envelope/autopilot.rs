//! The controller of a scenario around the aircraft of a point.

use std::path::Path;

use fspid_core::Gains;
use fspid_lti::TransferFunction;
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{Controller, ElevatorSign, LinearPlant, NamedController, Scenario};

use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::file::{self, LoadError};
use fspid_scenario::supervisor::Refused;

/// A radius this close below 1 counts as unstable, as in the simulation.
const MARGIN: f64 = 1e-9;

/// End of the search for a gain margin.
pub(super) const MOST_DB: f64 = 40.0;

/// Steps of that search: two changes within one of them are not seen.
const STEP_DB: f64 = 0.5;

/// A sampled loop around rest, with the gains that it starts from and without limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loop {
    /// Below 1 if it is stable.
    pub(super) spectral_radius: f64,
    /// How fast its slowest motion dies out; negative if it grows.
    pub(super) decay_per_s: f64,
    /// How much the gains may rise before it is unstable; none if it is unstable already.
    pub(super) gain_margin_db: Option<f64>,
}

/// A controller with the servo and the sample period of its scenario.
#[derive(Clone, Debug)]
pub(super) struct Autopilot {
    scenario: Scenario,
    controller: NamedController,
}

impl Autopilot {
    /// The controller of that name, or the only one.
    pub(super) fn load(path: &Path, name: Option<&str>) -> Result<Self, AircraftFailure> {
        let scenario = file::load(path, &[]).map_err(unusable)?.scenario;
        let known: Vec<&str> = scenario.controllers.iter().map(|c| c.name.as_str()).collect();
        let found = match (name, scenario.controllers.as_slice()) {
            (None, [only]) => Some(only),
            (None, _) => None,
            (Some(name), all) => all.iter().find(|controller| controller.name == name),
        };
        let controller = found.cloned().ok_or_else(|| {
            let given =
                name.map_or("is missing".to_owned(), |name| format!("`{name}` is not there"));
            let known = known.join(", ");
            refused(format!("--controller {given}; the scenario has {known}"))
        })?;
        Ok(Self { scenario, controller })
    }

    pub(super) fn name(&self) -> &str {
        &self.controller.name
    }

    /// What the radius speaks of.
    pub(super) fn words(&self) -> String {
        let (name, dt_s) = (&self.controller.name, self.controller.controller.config().dt_s);
        let gains = match self.controller.controller {
            Controller::Fixed(_) => "its gains",
            Controller::SelfTuning(_) => {
                "its nominal gains; what tuning makes of them is not judged"
            }
        };
        format!("loop of {name}, sampled every {dt_s} s, without limits, at {gains}")
    }

    /// How the sampled loop around a plant stands.
    pub(super) fn judge(&self, plant: &TransferFunction) -> Option<Loop> {
        let (above, below) = (plant.numerator(), plant.denominator());
        let sign = ElevatorSign::NoseDownPositive;
        let plant = LinearPlant::new(above.coefficients(), below.coefficients(), sign).ok()?;
        let plant = fspid_sim::Plant::Linear(plant);
        let scenario = Scenario { plant, controllers: Vec::new(), ..self.scenario.clone() };
        let radius = self.radius(&scenario, 1.0)?;
        let stable = is_stable(radius);
        let gain_margin_db = if stable { self.gain_margin_db(&scenario) } else { None };
        let decay_per_s = -libm::log(radius) / self.dt_s();
        Some(Loop { spectral_radius: radius, decay_per_s, gain_margin_db })
    }

    fn dt_s(&self) -> f64 {
        self.controller.controller.config().dt_s
    }

    /// Spectral radius with everything that the controller commands times a factor.
    fn radius(&self, scenario: &Scenario, factor: f64) -> Option<f64> {
        let controller = &self.controller.controller;
        let Gains { kp, ki, kd } = controller.nominal();
        let gains = Gains { kp: kp * factor, ki: ki * factor, kd: kd * factor };
        let mut config = *controller.config();
        config.rate_gain_s *= factor;
        config.feedforward *= factor;
        loop_spectral_radius(scenario, gains, &config).ok()
    }

    /// First factor from 1 upwards at which the loop is not stable, in dB; the end of the search where there is none.
    fn gain_margin_db(&self, scenario: &Scenario) -> Option<f64> {
        let holds = |db: f64| Some(is_stable(self.radius(scenario, libm::pow(10.0, db / 20.0))?));
        let mut below = 0.0;
        while below < MOST_DB {
            let above = below + STEP_DB;
            if !holds(above)? {
                return bisected((below, above), holds);
            }
            below = above;
        }
        Some(MOST_DB)
    }
}

/// Where a condition that holds at the first end stops to hold, to a hundredth of a decibel.
fn bisected(
    (mut below, mut above): (f64, f64),
    holds: impl Fn(f64) -> Option<bool>,
) -> Option<f64> {
    while above - below > 0.01 {
        let middle = 0.5 * (below + above);
        match holds(middle)? {
            true => below = middle,
            false => above = middle,
        }
    }
    Some(below)
}

/// Whether a loop of this spectral radius is stable; NaN is not.
pub(super) fn is_stable(radius: f64) -> bool {
    radius < 1.0 - MARGIN
}

fn unusable(error: LoadError) -> AircraftFailure {
    match error {
        LoadError::Unreadable { path, reason } => AircraftFailure::Unreadable { path, reason },
        LoadError::Problems(problems) => AircraftFailure::Problems(problems),
    }
}

fn refused(problem: String) -> AircraftFailure {
    AircraftFailure::Refused(Refused::one(problem))
}
