//! The loop itself: measure, decide, move.

use crate::instant::Instant;
use std::ops::ControlFlow;

use fspid_core::{Faults, Gains, Sample, State, Step};

use crate::actuated::Held;
use crate::aircraft::AircraftSample;
use crate::controller::Controller;
use crate::error::SimError;
use crate::external::ControllerLoss;
use crate::flown::Perturbation;
use crate::propagation::{Motion, Propagation};
use crate::scenario::{Flyer, Prepared, Respondent, Scenario};
use crate::sensor::{Sensor, SensorState, Truth};
use crate::surroundings::held;
use crate::trace::{Outcome, Trace};

/// A scenario's flights: the trace of each controller, in the scenario's order.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// The steps in the command.
    pub edges: Vec<crate::signal::Edge>,
    /// One trace a controller.
    pub traces: Vec<Trace>,
}

/// Flies every controller of the scenario.
///
/// # Errors
/// [`SimError`] where the scenario's plants cannot be discretised or an external controller cannot be started; an
/// unstable loop is no error but a trace that ends with [`Outcome::Diverged`], and the ground one that ends with
/// [`Outcome::HitGround`].
pub fn simulate(scenario: &Scenario) -> Result<Flight, SimError> {
    let prepared = scenario.prepare()?;
    let traces = scenario.flyers().map(|flyer| record(&prepared, flyer));
    Ok(Flight { traces: traces.collect::<Result<_, _>>()?, edges: prepared.edges })
}

fn record(prepared: &Prepared, flyer: Flyer<'_>) -> Result<Trace, SimError> {
    let mut trace = Trace::with_room(prepared);
    let outcome = flyer.respondent().fly(prepared, &Perturbation::NONE, |instant| {
        trace.push(prepared, &instant);
        ControlFlow::Continue(())
    })?;
    trace.outcome = outcome;
    Ok(trace)
}

/// Flies one controller and shows every sample to `observer`, which may end the flight early.
/// Nothing is recorded and, after the start, nothing is allocated.
///
/// # Errors
/// [`SimError`] where a rate-limited sample cannot be computed (coefficients near overflow).
pub fn fly(
    prepared: &Prepared,
    controller: &Controller,
    observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    fly_perturbed(prepared, controller, &Perturbation::NONE, observer)
}

/// As [`fly`], with something put between controller and servo.
///
/// # Errors
/// As [`fly`]; [`SimError::Number`] for a perturbation that makes no sense.
pub fn fly_perturbed(
    prepared: &Prepared,
    controller: &Controller,
    perturbation: &Perturbation,
    mut observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    watch(prepared, controller, perturbation, |instant, _| observer(instant))
}

impl Respondent<'_> {
    /// Flies it, with equations as [`fly_perturbed`] does.
    ///
    /// # Errors
    /// As [`fly_perturbed`]; where an external controller cannot be started.
    pub fn fly(
        self,
        prepared: &Prepared,
        perturbation: &Perturbation,
        mut observer: impl FnMut(Instant) -> ControlFlow<()>,
    ) -> Result<Outcome, SimError> {
        match self {
            Self::Equations(controller) => {
                fly_perturbed(prepared, controller, perturbation, observer)
            }
            Self::External(external) => {
                let mut started = external.start()?;
                let answer = |sample| started.answer(sample);
                watch_answers(prepared, answer, perturbation, |instant, _| observer(instant))
            }
        }
    }
}

/// As [`fly`], with a function of what is seen in the controller's place: it answers commands in rad, nose up
/// positive. For experiments such as a relay's.
///
/// # Errors
/// As [`fly`].
pub fn fly_commanded(
    prepared: &Prepared,
    mut command_rad: impl FnMut(Sample<f64>) -> f64,
    mut observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let answer = |sample| {
        Ok(Step {
            command_rad: command_rad(sample),
            gains: Gains::ZERO,
            saturated: false,
            faults: Faults::NONE,
        })
    };
    watch_answers(prepared, answer, &Perturbation::NONE, |instant, _| observer(instant))
}

/// What is about to happen between a sample and the next.
pub(crate) struct Coming<'a> {
    pub(crate) propagation: &'a Propagation,
    pub(crate) motion: &'a Motion,
    /// The command that has arrived.
    pub(crate) command_rad: f64,
    pub(crate) held: &'a Held<'a>,
}

/// The flight itself; the observer sees each sample and what is about to happen.
pub(crate) fn watch(
    prepared: &Prepared,
    controller: &Controller,
    perturbation: &Perturbation,
    observer: impl FnMut(Instant, &Coming<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut memory = State::new();
    let answer = |sample| Ok(controller.step(&mut memory, sample));
    watch_answers(prepared, answer, perturbation, observer)
}

#[inline]
fn watch_answers(
    prepared: &Prepared,
    mut answer: impl FnMut(Sample<f64>) -> Result<Step<f64>, ControllerLoss>,
    perturbation: &Perturbation,
    mut observer: impl FnMut(Instant, &Coming<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut path = perturbation.start()?;
    let mut delayed = Delay::of(prepared.delay_samples);
    let mut stages = prepared.stages.iter().peekable();
    let Some(mut stage) = stages.next() else {
        return Ok(Outcome::Completed);
    };
    let mut plant = stage.propagation.at_rest();
    let mut sensors = Sensors::start(prepared)?;

    for (k, &setpoint_rad) in prepared.setpoint_rad.iter().enumerate() {
        while let Some(next) = stages.next_if(|next| next.from <= k) {
            stage = next;
        }
        let at = |column: &Option<Vec<f64>>| {
            column.as_ref().and_then(|values| values.get(k)).copied().unwrap_or(0.0)
        };
        let disturbance_rad = at(&prepared.at_elevator);
        let theta_rad = plant.theta_rad();
        if plant.is_lost() {
            return Ok(Outcome::Diverged { at_s: prepared.timing.time_s(k) });
        }
        if stage.propagation.is_at_ground(&plant) {
            return Ok(Outcome::HitGround { at_s: prepared.timing.time_s(k) });
        }
        let q_rad_s = stage.propagation.rate_rad_s(&plant, disturbance_rad);
        let aircraft = stage.propagation.sample(&plant, disturbance_rad);
        sensors.erect(&aircraft);
        let measurement_rad = sensors.pitch_rad(k, theta_rad) + at(&prepared.at_measurement);
        let rate_rad_s = sensors.rate_rad_s(k, q_rad_s);
        let sample = Sample { setpoint_rad, measurement_rad, rate_rad_s };
        let step = match answer(sample) {
            Ok(step) => step,
            Err(loss) => {
                return Ok(Outcome::ControllerLost { at_s: prepared.timing.time_s(k), loss });
            }
        };
        let arriving_rad = delayed.pass(path.pass(step.command_rad));
        let command_rad = arriving_rad + at(&prepared.at_servo);
        stage.propagation.settle(&mut plant, command_rad);
        let elevator_rad = stage.propagation.elevator_rad(&plant, disturbance_rad);
        let measured = [measurement_rad, rate_rad_s];
        let instant =
            Instant { k, setpoint_rad, theta_rad, q_rad_s, elevator_rad, measured, aircraft, step };
        let held = held(disturbance_rad, (prepared.gusts(), prepared.gust_responses.as_deref()), k);
        let propagation = &stage.propagation;
        let coming = Coming { propagation, motion: &plant, command_rad, held: &held };
        if observer(instant, &coming).is_break() {
            return Ok(Outcome::Completed);
        }
        stage.propagation.advance(&mut plant, command_rad, &held)?;
    }
    Ok(Outcome::Completed)
}

/// Commands on their way, the oldest at `next`.
struct Delay {
    commands_rad: Vec<f64>,
    next: usize,
}

impl Delay {
    fn of(samples: usize) -> Self {
        Self { commands_rad: vec![0.0; samples], next: 0 }
    }

    /// Takes a command and answers the one that arrives.
    #[inline]
    fn pass(&mut self, command_rad: f64) -> f64 {
        let Some(place) = self.commands_rad.get_mut(self.next) else {
            return command_rad;
        };
        let arriving_rad = std::mem::replace(place, command_rad);
        self.next += 1;
        if self.next == self.commands_rad.len() {
            self.next = 0;
        }
        arriving_rad
    }
}

/// What the controller sees through; nothing changes without a sensor.
struct Sensors {
    pitch: Option<SensorState>,
    rate: Option<SensorState>,
    apparent_vertical_rad: f64,
}

impl Sensors {
    fn start(prepared: &Prepared) -> Result<Self, SimError> {
        let dt_s = prepared.timing.dt_s();
        let start = |sensor: Option<Sensor>| sensor.map(|sensor| sensor.start(dt_s)).transpose();
        let (pitch, rate) = (start(prepared.pitch_sensor)?, start(prepared.rate_sensor)?);
        Ok(Self { pitch, rate, apparent_vertical_rad: 0.0 })
    }

    /// Lets gyros erect to the apparent vertical; that of a linear plant is the true one.
    fn erect(&mut self, aircraft: &Option<AircraftSample>) {
        self.apparent_vertical_rad = aircraft.map_or(0.0, |sample| sample.apparent_vertical_rad);
    }

    fn pitch_rad(&mut self, k: usize, value: f64) -> f64 {
        let apparent_vertical_rad = self.apparent_vertical_rad;
        seen(self.pitch.as_mut(), k, Truth { value, apparent_vertical_rad })
    }

    fn rate_rad_s(&mut self, k: usize, value: f64) -> f64 {
        seen(self.rate.as_mut(), k, Truth { value, ..Truth::default() })
    }
}

fn seen(sensor: Option<&mut SensorState>, k: usize, truth: Truth) -> f64 {
    sensor.map_or(truth.value, |sensor| sensor.measure(k, truth))
}
