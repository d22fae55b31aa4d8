//! The controller of a scenario around the aircraft of a point.

use std::path::Path;

use fspid_aircraft::{Aircraft, TrimTarget};
use fspid_core::{Gains, Pid, PidConfig};
use fspid_sim::aircraft::{AircraftPlant, Forces};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{Controller, NamedController, Scenario, SimError, Surroundings};

use super::judged::Loop;
use crate::analysis::{AnalysedLoop, Analysis, Question};
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::file::{self, GainSource, LoadError, Schedule, Study};
use fspid_scenario::supervisor::Refused;

/// A controller with the servo, the sensors and the sample period of its scenario.
#[derive(Clone, Debug)]
pub(super) struct Autopilot {
    scenario: Scenario,
    controller: NamedController,
    /// What its gains follow, and the factor that is in them.
    schedule: Option<(Schedule, f64)>,
}

impl Autopilot {
    /// The controller of that name, or the only one.
    pub(super) fn load(path: &Path, name: Option<&str>) -> Result<Self, AircraftFailure> {
        let study = file::load(path, &[]).map_err(unusable)?;
        let scenario = &study.scenario;
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
        let schedule = schedule(&study, &controller.name);
        Ok(Self { scenario: study.scenario, controller, schedule })
    }

    pub(super) fn name(&self) -> &str {
        &self.controller.name
    }

    /// What the radius speaks of.
    pub(super) fn words(&self) -> String {
        let (name, dt_s) = (&self.controller.name, self.controller.controller.config().dt_s);
        let gains = match (&self.controller.controller, self.schedule) {
            (Controller::Fixed(_), None) => "its gains",
            (Controller::Fixed(_), Some(_)) => "its gains as scheduled at each point",
            (Controller::SelfTuning(_), _) => {
                "its nominal gains; what tuning makes of them is not judged"
            }
        };
        format!("loop of {name}, sampled every {dt_s} s, without limits, at {gains}")
    }

    /// Whose aircraft it is asked around.
    pub(super) const fn whose(&self) -> &'static str {
        "aircraft, loading and air are those of this command; of the scenario there are controller, actuator, sensors, leveller and damper, and neither set-point, disturbances nor outer loops"
    }

    /// All of that in a line.
    pub(super) fn in_words(&self) -> String {
        format!("{}; {}", self.words(), self.whose())
    }

    /// How the sampled loop around an aircraft in a flight stands, with the gains that it has at a dynamic pressure.
    pub(super) fn judge(
        &self,
        aircraft: &Aircraft<Forces>,
        target: TrimTarget,
        pressure_pa: f64,
    ) -> Loop {
        let dt_s = self.controller.controller.config().dt_s;
        match self.analysed(aircraft, target, pressure_pa) {
            Ok(found) => Loop::of(&found, dt_s),
            Err(reason) => Loop::not_asked(reason),
        }
    }

    /// The loop as `analyse` sees it, or why it cannot.
    fn analysed(
        &self,
        aircraft: &Aircraft<Forces>,
        target: TrimTarget,
        pressure_pa: f64,
    ) -> Result<AnalysedLoop, String> {
        let in_words = |error: SimError| error.to_string();
        let controller = self.controller_at(pressure_pa)?;
        let scenario = self.around(aircraft, target, controller).map_err(in_words)?;
        let question = Question { map_points: 0, ..Question::default() };
        let mut analysis = Analysis::of_scenario(&scenario, question).map_err(in_words)?;
        analysis.loops.pop().ok_or_else(|| in_words(SimError::NotLinear))
    }

    /// The controller with fixed gains, those that its schedule makes at this pressure.
    fn controller_at(&self, pressure_pa: f64) -> Result<Controller, String> {
        let own = &self.controller.controller;
        let factor = match self.schedule {
            Some((schedule, own_factor)) => schedule.factor(pressure_pa) / own_factor,
            None => 1.0,
        };
        // Written so that NaN fails.
        if !(factor > 0.0 && factor.is_finite()) {
            return Err("the schedule makes no gains there".to_owned());
        }
        let (gains, config) = scaled((own.nominal(), *own.config()), factor);
        Pid::new(gains, config).map(Controller::Fixed).map_err(|error| error.to_string())
    }

    /// The aircraft at rest in a flight with this controller: nothing is commanded, no air moves, no loop is around the pitch loop.
    fn around(
        &self,
        aircraft: &Aircraft<Forces>,
        target: TrimTarget,
        controller: Controller,
    ) -> Result<Scenario, SimError> {
        let plant = AircraftPlant::trimmed(aircraft.clone(), target)?;
        let plant = match self.scenario.plant.aircraft() {
            Some(own) => plant.with_lateral(own.lateral())?,
            None => plant,
        };
        let Scenario { name, timing, actuator, surroundings, .. } = &self.scenario;
        let setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 })?;
        Ok(Scenario {
            actuator: *actuator,
            surroundings: Surroundings { weather: None, ..surroundings.clone() },
            controllers: vec![NamedController { controller, ..self.controller.clone() }],
            ..Scenario::new(name, plant, *timing, setpoint)
        })
    }
}

/// Everything that a controller commands times a factor.
fn scaled(
    (Gains { kp, ki, kd }, mut config): (Gains<f64>, PidConfig<f64>),
    factor: f64,
) -> (Gains<f64>, PidConfig<f64>) {
    config.rate_gain_s *= factor;
    config.feedforward *= factor;
    (Gains { kp: kp * factor, ki: ki * factor, kd: kd * factor }, config)
}

/// What the gains of a controller follow, and the factor at the scenario's own trim.
fn schedule(study: &Study, name: &str) -> Option<(Schedule, f64)> {
    let derived = study.derived_gains.iter().find(|gains| gains.controller == name)?;
    match derived.source {
        GainSource::Schedule { schedule, factor, .. } => Some((schedule, factor)),
        GainSource::Regulator => None,
    }
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
