//! The answer of the linear loop to a step of the command: no limit, no noise, gains at rest.

use fspid_core::{AntiWindup, Pid, PidConfig};
use fspid_sim::actuator::Actuator;
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Controller, NamedController, Plant, Scenario, SimError, Surroundings, Trace, simulate,
};

use super::equilibrium::equilibrium;
use super::loops::lasting_plants;

/// Height of the step, rad: the loop is linear, so that any will do.
const STEP_RAD: f64 = 1.0;

/// A controller's answer to a step.
pub(crate) struct StepResponse {
    /// Name of the controller.
    pub(crate) name: String,
    /// Times, s.
    pub(crate) time_s: Vec<f64>,
    /// Pitch per command.
    pub(crate) pitch: Vec<f64>,
}

/// The answer of every controller that has gains at rest, with the first plant.
///
/// # Errors
/// A plant that cannot be sampled.
pub(crate) fn step_responses(scenario: &Scenario) -> Result<Vec<StepResponse>, SimError> {
    let plants = lasting_plants(scenario)?;
    let Some((_, plant)) = plants.into_iter().next() else { return Ok(Vec::new()) };
    let actuator = scenario.actuator;
    let mut linear = Scenario {
        plant: Plant::from(plant),
        plant_changes: Vec::new(),
        setpoint: Profile::new(STEP_RAD, Shape::Step { at_s: 0.0 })?,
        disturbances: Vec::new(),
        controllers: Vec::new(),
        externals: Vec::new(),
        actuator: Actuator::new(actuator.lag()).with_delay(actuator.delay_samples())?,
        surroundings: surroundings(scenario)?,
        // Around a linear plant there is nothing that it could hold.
        autopilot: None,
        ..scenario.clone()
    };
    for named in &scenario.controllers {
        linear.controllers.extend(at_rest(named));
    }
    let flight = simulate(&linear)?;
    let answer = |(named, trace): (&NamedController, Trace)| {
        let pitch = trace.theta_rad.iter().map(|theta| theta / STEP_RAD).collect();
        StepResponse { name: named.name.clone(), time_s: trace.time_s, pitch }
    };
    Ok(linear.controllers.iter().zip(flight.traces).map(answer).collect())
}

/// The controller with the gains that it has at rest, without limits.
fn at_rest(named: &NamedController) -> Option<NamedController> {
    let gains = equilibrium(&named.controller).gains()?;
    let config = PidConfig {
        limits: None,
        slew_rad_s: None,
        anti_windup: AntiWindup::None,
        ..named.controller.config_at(gains)
    };
    let controller = Controller::Fixed(Pid::new(gains, config).ok()?);
    Some(NamedController { name: named.name.clone(), controller })
}

/// What sensors do to a measurement but for noise.
fn surroundings(scenario: &Scenario) -> Result<Surroundings, SimError> {
    let quiet = |sensor: Option<Sensor>, channel| {
        let model = sensor.as_ref().map(|sensor| *sensor.model());
        let model = model.map(|model| SensorModel {
            delay_s: model.delay_s,
            period_s: model.period_s,
            scale_error: model.scale_error,
            ..SensorModel::default()
        });
        model.map(|model| Sensor::new(model, 0, channel)).transpose()
    };
    Ok(Surroundings {
        weather: None,
        pitch_sensor: quiet(scenario.surroundings.pitch_sensor, PITCH)?,
        rate_sensor: quiet(scenario.surroundings.rate_sensor, RATE)?,
    })
}
