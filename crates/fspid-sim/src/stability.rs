//! Whether fixed gains hold the plant: the spectral radius of the sampled closed loop.
//!
//! A loop that grows slowly looks good in a short window. This looks at its one-sample matrix
//! instead, built from the exact matrix of plant and servo, the delay, and the controller as it is
//! implemented:
//!
//! $$ z_{k+1} = M z_k, \qquad z = (x, \delta, \text{delayed commands}, I, d, y_{k-1}) $$

use fspid_core::{Gains, Shell};
use fspid_lti::{Complex, Matrix, eigenvalues, spectral_radius};

use crate::aircraft::AircraftPlant;
use crate::controller::Controller;
use crate::error::SimError;
use crate::plant::LinearPlant;
use crate::propagator::LinearStep;
use crate::scenario::Scenario;

/// A radius this close below 1 cannot be told from 1 after rounding; it counts as unstable.
const MARGIN: f64 = 1e-9;

/// A loop with fixed gains that does not hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstable {
    /// Spectral radius of the sampled closed loop, 1 or above.
    pub spectral_radius: f64,
    /// From when the plant is the one that is not held, s.
    pub from_s: f64,
}

/// The instability of a loop, if it has one: `None` for a stable loop and for loops this cannot
/// tell of (self-tuning gains, limits of the controller).
///
/// A nonlinear aircraft is judged by its linear model around the trim: where that grows, the flight
/// leaves the trim, however small the disturbance.
///
/// Limits of the servo are passed over: around rest, where they do not act, they save no loop that
/// is unstable without them. Deadband and play of an actuator are passed over as well, and so is
/// what sensors do to a measurement: the answer is that of the loop without them.
///
/// # Errors
/// [`SimError`] where the plant cannot be discretised, an aircraft has no linear model, or the
/// eigenvalues are not found.
pub fn instability(
    scenario: &Scenario,
    controller: &Controller,
) -> Result<Option<Unstable>, SimError> {
    let Controller::Fixed(pid) = controller else {
        return Ok(None);
    };
    if !pid.shell().is_linear() {
        return Ok(None);
    }
    let trimmed = scenario.plant.aircraft().map(AircraftPlant::linear).transpose()?;
    let around_trim = trimmed.iter().map(|plant| (0.0, plant));
    for (from_s, plant) in around_trim.chain(scenario.lasting_plants()) {
        let step = linear_step(scenario, plant, scenario.timing.dt_s())?;
        let radius = spectral_radius(&closed_loop(&step, pid.gains(), pid.shell())?)?;
        // Written so that NaN counts as unstable.
        if !(radius < 1.0 - MARGIN) {
            return Ok(Some(Unstable { spectral_radius: radius, from_s }));
        }
    }
    Ok(None)
}

/// Spectral radius of the sampled loop of one plant with fixed gains and no limits.
///
/// # Errors
/// [`SimError`] where the plant is an aircraft, cannot be discretised or the eigenvalues are not found.
pub fn loop_spectral_radius(
    scenario: &Scenario,
    gains: Gains<f64>,
    shell: &Shell<f64>,
) -> Result<f64, SimError> {
    let plant = scenario.plant.linear().ok_or(SimError::NotLinear)?;
    let step = linear_step(scenario, plant, shell.dt_s)?;
    Ok(spectral_radius(&closed_loop(&step, gains, shell)?)?)
}

/// Poles of the sampled loop of one plant with fixed gains and no limits.
///
/// # Errors
/// [`SimError`] where the plant is an aircraft, cannot be discretised or the eigenvalues are not found.
pub fn loop_poles(
    scenario: &Scenario,
    gains: Gains<f64>,
    shell: &Shell<f64>,
) -> Result<Vec<Complex>, SimError> {
    let plant = scenario.plant.linear().ok_or(SimError::NotLinear)?;
    let step = linear_step(scenario, plant, shell.dt_s)?;
    Ok(eigenvalues(&closed_loop(&step, gains, shell)?)?)
}

fn linear_step(
    scenario: &Scenario,
    plant: &LinearPlant,
    dt_s: f64,
) -> Result<LinearStep, SimError> {
    scenario.propagation(plant, dt_s)?.linear_step().ok_or(SimError::NotLinear)
}

/// Where the parts of the state stand.
struct Layout {
    plant: usize,
    delay: usize,
}

impl Layout {
    fn integral(&self) -> usize {
        self.plant + self.delay
    }
    fn derivative(&self) -> usize {
        self.integral() + 1
    }
    fn previous(&self) -> usize {
        self.integral() + 2
    }
    fn size(&self) -> usize {
        self.integral() + 3
    }
}

/// The one-sample matrix of the loop with the set-point at zero.
fn closed_loop(
    linear: &LinearStep,
    gains: Gains<f64>,
    shell: &Shell<f64>,
) -> Result<Matrix, SimError> {
    let plant = linear.states;
    let layout = Layout { plant, delay: linear.delay_samples };
    let controller = controller_rows(linear, gains, shell, &layout);

    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(layout.size());
    // The command that moves the servo now: the oldest of the queue, or this sample's own.
    let mut arriving = vec![0.0; layout.size()];
    if layout.delay == 0 {
        arriving.clone_from(&controller.command);
    } else {
        arriving[layout.plant] = 1.0;
    }
    for step in linear.rows.chunks_exact(plant + 2) {
        let mut values: Vec<f64> = arriving.iter().map(|a| a * step[plant]).collect();
        for (value, by_state) in values.iter_mut().zip(&step[..plant]) {
            *value += by_state;
        }
        rows.push(values);
    }
    for place in 0..layout.delay {
        let mut values = vec![0.0; layout.size()];
        if place + 1 == layout.delay {
            values.clone_from(&controller.command);
        } else {
            values[layout.plant + place + 1] = 1.0;
        }
        rows.push(values);
    }
    rows.push(controller.integral);
    rows.push(controller.derivative);
    let mut measurement = vec![0.0; layout.size()];
    measurement[0] = 1.0;
    rows.push(measurement);
    Ok(Matrix::from_rows(&rows)?)
}

/// Rows of the controller over the whole state: command, next integral, next derivative.
struct ControllerRows {
    command: Vec<f64>,
    integral: Vec<f64>,
    derivative: Vec<f64>,
}

fn controller_rows(
    linear: &LinearStep,
    gains: Gains<f64>,
    shell: &Shell<f64>,
    layout: &Layout,
) -> ControllerRows {
    let zeros = || vec![0.0; layout.size()];
    let Gains { kp, ki, kd } = gains;
    let dt_s = shell.dt_s;

    // The integral's own term of the command, rad; without a gain it is not part of the loop, and
    // its pole at 1 is not the loop's.
    let mut integral = zeros();
    if ki != 0.0 {
        integral[layout.integral()] = 1.0;
        integral[0] = -ki * dt_s;
    }
    let filter_s = shell.derivative.filter_s;
    let mut derivative = zeros();
    derivative[layout.derivative()] = filter_s / (filter_s + dt_s);
    derivative[0] = -1.0 / (filter_s + dt_s);
    derivative[layout.previous()] = 1.0 / (filter_s + dt_s);

    let mut command: Vec<f64> = integral.iter().zip(&derivative).map(|(i, d)| i + kd * d).collect();
    command[0] -= kp;
    for (value, q) in command.iter_mut().zip(&linear.rate_row) {
        *value -= shell.rate_gain_s * q;
    }
    ControllerRows { command, integral, derivative }
}
