//! The controller of a scenario around the aircraft of a point.

use std::path::Path;

use fspid_core::{Gains, PidConfig};
use fspid_lti::TransferFunction;
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{Controller, ElevatorSign, LinearPlant, NamedController, Scenario};

use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::file::{self, GainSource, LoadError, Schedule, Study};
use fspid_scenario::supervisor::Refused;

/// A radius this close below 1 counts as unstable, as in the simulation.
const MARGIN: f64 = 1e-9;

/// End of the search for a gain margin.
pub(super) const MOST_DB: f64 = 40.0;

/// Steps of that search, either way: two changes within one of them are not seen.
const STEP_DB: f64 = 0.5;

/// A sampled loop around rest, with the gains that it starts from there and without limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loop {
    /// Below 1 if it is stable.
    pub(super) spectral_radius: f64,
    /// How fast its slowest motion dies out; negative if it grows.
    pub(super) decay_per_s: f64,
    /// How far the gains may rise or fall, whichever is less, before it is unstable; none if it is unstable already.
    pub(super) gain_margin_db: Option<f64>,
}

/// A controller with the servo and the sample period of its scenario.
#[derive(Clone, Debug)]
pub(super) struct Autopilot {
    scenario: Scenario,
    controller: NamedController,
    /// What its gains follow, and the factor that is in them.
    schedule: Option<(Schedule, f64)>,
}

/// The loop of a controller around one plant.
struct Around {
    scenario: Scenario,
    gains: Gains<f64>,
    config: PidConfig<f64>,
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
        "aircraft, loading and air are those of this command; of the scenario there are controller, actuator and sensors"
    }

    /// All of that in a line.
    pub(super) fn in_words(&self) -> String {
        format!("{}; {}", self.words(), self.whose())
    }

    /// How the sampled loop around a plant stands, with the gains that it has at a dynamic pressure.
    pub(super) fn judge(&self, plant: &TransferFunction, pressure_pa: f64) -> Option<Loop> {
        let (above, below) = (plant.numerator(), plant.denominator());
        let sign = ElevatorSign::NoseDownPositive;
        let plant = LinearPlant::new(above.coefficients(), below.coefficients(), sign).ok()?;
        let plant = fspid_sim::Plant::Linear(plant);
        let around = self.around(plant, pressure_pa)?;
        let radius = around.radius(1.0)?;
        let stable = is_stable(radius);
        let gain_margin_db = if stable { around.gain_margin_db() } else { None };
        let decay_per_s = -libm::log(radius) / self.dt_s();
        Some(Loop { spectral_radius: radius, decay_per_s, gain_margin_db })
    }

    fn dt_s(&self) -> f64 {
        self.controller.controller.config().dt_s
    }

    /// The loop around a plant; none where the schedule makes no gains at this pressure.
    fn around(&self, plant: fspid_sim::Plant, pressure_pa: f64) -> Option<Around> {
        let scenario = Scenario { plant, controllers: Vec::new(), ..self.scenario.clone() };
        let controller = &self.controller.controller;
        let own = Around { scenario, gains: controller.nominal(), config: *controller.config() };
        let Some((schedule, own_factor)) = self.schedule else { return Some(own) };
        let factor = schedule.factor(pressure_pa) / own_factor;
        // Written so that NaN fails.
        (factor > 0.0 && factor.is_finite()).then(|| own.times(factor))
    }
}

impl Around {
    /// The loop with everything that the controller commands times a factor.
    fn times(self, factor: f64) -> Self {
        let (gains, config) = self.scaled(factor);
        Self { gains, config, ..self }
    }

    fn scaled(&self, factor: f64) -> (Gains<f64>, PidConfig<f64>) {
        let (Gains { kp, ki, kd }, mut config) = (self.gains, self.config);
        config.rate_gain_s *= factor;
        config.feedforward *= factor;
        (Gains { kp: kp * factor, ki: ki * factor, kd: kd * factor }, config)
    }

    /// Spectral radius with everything that the controller commands times a factor.
    fn radius(&self, factor: f64) -> Option<f64> {
        let (gains, config) = self.scaled(factor);
        loop_spectral_radius(&self.scenario, gains, &config).ok()
    }

    /// The nearest factor to 1, upwards or downwards, at which the loop is not stable, as its size in dB; the end of the
    /// search where there is none.
    fn gain_margin_db(&self) -> Option<f64> {
        let mut inside_db = 0.0;
        while inside_db < MOST_DB {
            let outside_db = inside_db + STEP_DB;
            let (up, down) =
                (self.end((inside_db, outside_db), 1.0)?, self.end((inside_db, outside_db), -1.0)?);
            if let Some(nearest_db) = up.into_iter().chain(down).min_by(f64::total_cmp) {
                return Some(nearest_db);
            }
            inside_db = outside_db;
        }
        Some(MOST_DB)
    }

    /// Where the loop, stable at the nearer of two sizes of a change one way, stops to be so; an inner none where it does not.
    fn end(&self, (inside_db, outside_db): (f64, f64), way: f64) -> Option<Option<f64>> {
        let holds = |db: f64| Some(is_stable(self.radius(libm::pow(10.0, way * db / 20.0))?));
        match holds(outside_db)? {
            true => Some(None),
            false => bisected((inside_db, outside_db), holds).map(Some),
        }
    }
}

/// What the gains of a controller follow, and the factor at the scenario's own trim.
fn schedule(study: &Study, name: &str) -> Option<(Schedule, f64)> {
    let derived = study.derived_gains.iter().find(|gains| gains.controller == name)?;
    match derived.source {
        GainSource::Schedule { schedule, factor, .. } => Some((schedule, factor)),
        GainSource::Regulator => None,
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
