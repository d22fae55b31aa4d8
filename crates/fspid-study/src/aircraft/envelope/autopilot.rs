//! The controller of a scenario around the aircraft of a point.

use std::path::Path;

use fspid_lti::TransferFunction;
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{Controller, ElevatorSign, LinearPlant, NamedController, Scenario};

use crate::aircraft::failure::AircraftFailure;
use crate::file::{self, LoadError};
use crate::inference::Refused;

/// A radius this close below 1 counts as unstable, as in the simulation.
const MARGIN: f64 = 1e-9;

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
        let (name, dt_s) = (&self.controller.name, self.controller.controller.shell().dt_s);
        let gains = match self.controller.controller {
            Controller::Fixed(_) => "its gains",
            Controller::SelfTuning(_) => {
                "its nominal gains; what tuning makes of them is not judged"
            }
        };
        format!("loop of {name}, sampled every {dt_s} s, without limits, at {gains}")
    }

    /// Spectral radius of the sampled loop around a plant, below 1 if it is stable.
    pub(super) fn radius(&self, plant: &TransferFunction) -> Option<f64> {
        let (above, below) = (plant.numerator(), plant.denominator());
        let sign = ElevatorSign::NoseDownPositive;
        let plant = LinearPlant::new(above.coefficients(), below.coefficients(), sign).ok()?;
        let scenario = Scenario { plant: fspid_sim::Plant::Linear(plant), ..self.scenario.clone() };
        let controller = &self.controller.controller;
        loop_spectral_radius(&scenario, controller.nominal(), controller.shell()).ok()
    }
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
