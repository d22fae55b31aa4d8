//! A flight that stops at each sample and waits for a command: the simulation loop with the controller left open, for callers
//! who bring their own.

mod small_motion;

use std::borrow::Borrow;

use fspid_core::Step;

use crate::actuated::Held;
use crate::aircraft::{AircraftFlight, AircraftMotion, AircraftSample, Wing};
use crate::autopilot::{AutopilotSample, AutopilotState, Commands, Cut, Observed, Throttle};
use crate::error::SimError;
use crate::external::Asked;
use crate::flown::{CommandPath, Perturbation};
use crate::instant::Instant;
use crate::propagation::{Motion, Propagation};
use crate::scenario::Prepared;
use crate::seen::Seen;
use crate::sensor::{Sensor, SensorState, Truth};
use crate::surroundings::held;
use crate::trace::{EndCause, Outcome};

/// A flight of a prepared scenario whose commands come from outside, one a sample; `P` is how it holds what is
/// prepared, `&Prepared` or `Arc<Prepared>`. Whoever answers with the steps of a controller flies it as
/// [`fly`](crate::fly) does, bit for bit.
#[derive(Clone, Debug)]
pub struct InFlight<P> {
    course: Course<P>,
    seen: Result<Seen, Outcome>,
}

impl<P: Borrow<Prepared>> InFlight<P> {
    /// At the first sample.
    ///
    /// # Errors
    /// [`SimError::Number`] for sensors whose delay is too long for memory; where another simulator cannot be started.
    pub fn start(prepared: P) -> Result<Self, SimError> {
        let mut course = Course::start(prepared, &Perturbation::NONE)?;
        let seen = course.look();
        Ok(Self { course, seen })
    }

    /// What is prepared.
    pub fn prepared(&self) -> &Prepared {
        self.course.prepared()
    }

    /// What is seen at the sample that waits for an answer.
    ///
    /// # Errors
    /// How the flight ended, where none waits any more.
    pub fn seen(&self) -> Result<Seen, Outcome> {
        self.seen
    }

    /// Answers the sample that waits, and flies on to the next one. What was there at the answered sample; `None`, with
    /// nothing done, for a flight that has ended.
    ///
    /// # Errors
    /// As [`fly`](crate::fly).
    pub fn act(&mut self, step: Step<f64>) -> Result<Option<Instant>, SimError> {
        let Ok(seen) = self.seen else {
            return Ok(None);
        };
        let (instant, command_rad) = self.course.take(seen, step);
        self.course.advance(command_rad)?;
        self.seen = self.course.look();
        Ok(Some(instant))
    }
}

/// Where a flight is. Each sample is looked at once, answered once and left once, in this order.
#[derive(Clone, Debug)]
pub(crate) struct Course<P> {
    prepared: P,
    k: usize,
    /// Place of the plant that holds.
    stage: usize,
    plant: Motion,
    sensors: Sensors,
    path: CommandPath,
    delayed: Delay,
    /// At the elevator, rad, and what an aircraft shows, of the sample that was looked at.
    disturbance_rad: f64,
    aircraft: Option<AircraftSample>,
    around: Option<Around>,
    /// What an external controller asks for beside its command.
    asked: Asked,
}

/// The autopilot around the loop.
#[derive(Clone, Debug)]
struct Around {
    state: AutopilotState,
    /// What it does at the sample that was looked at.
    sample: Option<AutopilotSample>,
    /// Which way pitch was cut at the sample before, and the command there, rad.
    own: Cut,
    cut: Cut,
    command_rad: f64,
}

impl Around {
    fn start(prepared: &Prepared, plant: &Motion) -> Result<Option<Self>, SimError> {
        let throttle = prepared.throttle.or_else(|| plant.throttle());
        let Some((autopilot, throttle)) = prepared.autopilot.as_ref().zip(throttle) else {
            return Ok(None);
        };
        let state = AutopilotState::start(autopilot, prepared.timing.dt_s(), throttle)?;
        Ok(Some(Self { state, sample: None, own: Cut::Not, cut: Cut::Not, command_rad: 0.0 }))
    }

    /// The pitch set-point that it adds, rad.
    fn look(&mut self, prepared: &Prepared, k: usize, observed: Option<Observed>) -> f64 {
        if let (Some(autopilot), Some(observed)) = (&prepared.autopilot, observed) {
            let at = (k, prepared.timing);
            self.sample = Some(self.state.answer(autopilot, at, &observed, self.cut));
        }
        self.state.commands().pitch_rad
    }

    /// Remembers which way pitch is cut: by the controller, or by what moves the elevator.
    fn take(&mut self, step: &Step<f64>, below: Cut) {
        self.own = self.own.after(step, self.command_rad);
        self.cut = self.own.or(below);
        self.command_rad = step.command_rad;
    }
}

impl<P: Borrow<Prepared>> Course<P> {
    pub(crate) fn start(prepared: P, perturbation: &Perturbation) -> Result<Self, SimError> {
        let all: &Prepared = prepared.borrow();
        let plant = all.stages[0].propagation.start()?;
        Ok(Self {
            k: 0,
            stage: 0,
            sensors: Sensors::start(all)?,
            path: perturbation.start()?,
            delayed: Delay::of(all.delay_samples),
            disturbance_rad: 0.0,
            aircraft: None,
            asked: Asked::default(),
            around: Around::start(all, &plant)?,
            plant,
            prepared,
        })
    }

    pub(crate) fn prepared(&self) -> &Prepared {
        self.prepared.borrow()
    }

    /// The plant as it is now.
    #[inline]
    pub(crate) fn propagation(&self) -> &Propagation {
        &self.prepared().stages[self.stage].propagation
    }

    /// Where it is.
    #[inline]
    pub(crate) fn plant(&self) -> &Motion {
        &self.plant
    }

    /// A signal at this sample; zero where there is none.
    #[inline]
    fn at(&self, column: impl Fn(&Prepared) -> &Option<Vec<f64>>) -> f64 {
        let values = column(self.prepared()).as_ref();
        values.and_then(|values| values.get(self.k)).copied().unwrap_or(0.0)
    }

    /// Looks at this sample; how the flight ended, where it is no longer flown.
    #[inline]
    pub(crate) fn look(&mut self) -> Result<Seen, Outcome> {
        self.look_at(|propagation, plant, disturbance_rad| {
            propagation.sample(plant, disturbance_rad)
        })
    }

    /// The same, by who knows what the plant shows beyond pitch.
    #[inline]
    pub(crate) fn look_at(
        &mut self,
        shown: impl FnOnce(&Propagation, &Motion, f64) -> Option<AircraftSample>,
    ) -> Result<Seen, Outcome> {
        let k = self.k;
        let prepared: &Prepared = self.prepared.borrow();
        let Some(&setpoint_rad) = prepared.setpoint_rad.get(k) else {
            return Err(self.completed());
        };
        while prepared.stages.get(self.stage + 1).is_some_and(|next| next.from <= k) {
            self.stage += 1;
        }
        let propagation = &prepared.stages[self.stage].propagation;
        let ended = |cause| Err(Outcome::ended_early(prepared.timing.time_s(k), cause));
        if let Some(loss) = self.plant.plant_loss() {
            return ended(EndCause::PlantLost(loss));
        }
        if self.plant.is_lost() {
            return ended(EndCause::Diverged);
        }
        if propagation.is_at_ground(&self.plant) {
            return ended(EndCause::HitGround);
        }
        let disturbance_rad = self.at(|prepared| &prepared.at_elevator);
        let theta_rad = self.plant.theta_rad();
        let q_rad_s = propagation.rate_rad_s(&self.plant, disturbance_rad);
        let aircraft = shown(propagation, &self.plant, disturbance_rad);
        // Another simulator says by itself which of its numbers are none.
        let flies_here = matches!(self.plant, Motion::Aircraft(_));
        if flies_here && aircraft.as_ref().is_some_and(|it| !it.is_finite()) {
            return ended(EndCause::Diverged);
        }
        let at_measurement = self.at(|prepared| &prepared.at_measurement);
        self.sensors.erect(&aircraft);
        let measurement_rad = self.sensors.pitch_rad(k, theta_rad) + at_measurement;
        let rate_rad_s = self.sensors.rate_rad_s(k, q_rad_s);
        (self.disturbance_rad, self.aircraft) = (disturbance_rad, aircraft);
        let measured = [measurement_rad, rate_rad_s];
        let setpoint_rad = match &mut self.around {
            Some(around) => {
                setpoint_rad + around.look(prepared, k, aircraft.as_ref().map(Observed::from))
            }
            None => setpoint_rad,
        };
        Ok(Seen { k, setpoint_rad, theta_rad, q_rad_s, measured })
    }

    /// How a flight ended of which every sample was flown.
    fn completed(&self) -> Outcome {
        let autopilot = self.prepared().autopilot.as_ref();
        let around = self.around.as_ref().zip(autopilot);
        let waits = around.and_then(|(around, autopilot)| around.state.waits_for(autopilot));
        waits.map_or(Outcome::Completed, |mode| Outcome::ModeNeverBegan { mode })
    }

    /// Takes the answer: what was there, and the command that arrives at the servo.
    #[inline]
    pub(crate) fn take(&mut self, seen: Seen, step: Step<f64>) -> (Instant, f64) {
        let arriving_rad = self.delayed.pass(self.path.pass(step.command_rad));
        let command_rad = arriving_rad + self.at(|prepared| &prepared.at_servo);
        let prepared: &Prepared = self.prepared.borrow();
        let propagation = &prepared.stages[self.stage].propagation;
        propagation.settle(&mut self.plant, command_rad);
        let elevator_rad = propagation.elevator_rad(&self.plant, self.disturbance_rad);
        let Seen { k, setpoint_rad, theta_rad, q_rad_s, measured } = seen;
        let aircraft = self.aircraft;
        if let Some(around) = &mut self.around {
            around.take(&step, propagation.cut(&self.plant, command_rad));
        }
        let autopilot = self.around.as_ref().and_then(|around| around.sample);
        let instant = Instant {
            k,
            setpoint_rad,
            theta_rad,
            q_rad_s,
            elevator_rad,
            measured,
            aircraft,
            autopilot,
            step,
        };
        (instant, command_rad)
    }

    /// What enters the plant until the next sample, beside the command.
    #[inline]
    pub(crate) fn held(&self) -> Held<'_> {
        let prepared = self.prepared();
        let air = (prepared.gusts(), prepared.gust_responses.as_deref());
        Held { autopilot: self.commands(), ..held(self.disturbance_rad, air, self.k) }
    }

    /// What an autopilot commands, and what an external controller asks for in its place; nothing without them.
    fn commands(&self) -> Commands {
        let commands = self.around.as_ref().map(|around| around.state.commands());
        let commands = commands.unwrap_or_default();
        let throttle = self.asked.throttle.zip(self.prepared().throttle);
        let throttle = throttle.map(|(fraction, Throttle { trim, travel })| {
            travel.min + (travel.max - travel.min) * fraction.clamp(0.0, 1.0) - trim
        });
        Commands {
            throttle: throttle.unwrap_or(commands.throttle),
            lateral_rad: self.asked.lateral_rad,
            ..commands
        }
    }

    /// What an aircraft shows of the sample that was looked at.
    #[inline]
    pub(crate) fn observed(&self) -> Option<&AircraftSample> {
        self.aircraft.as_ref()
    }

    /// Takes what an external controller asks for beside its command.
    #[inline]
    pub(crate) fn ask(&mut self, asked: Asked) {
        self.asked = asked;
    }

    /// An aircraft, where it is, and its elevator, rad.
    pub(crate) fn aircraft(&self) -> Option<(&AircraftFlight, &AircraftMotion, f64)> {
        let (Propagation::Aircraft(flight), Motion::Aircraft(motion)) =
            (self.propagation(), &self.plant)
        else {
            return None;
        };
        let disturbance_rad = self.at(|prepared| &prepared.at_elevator);
        Some((flight, motion, flight.elevator_rad(motion, disturbance_rad)))
    }

    /// An aircraft on its way to the next sample, which others fly; the sample counts as left.
    pub(crate) fn leave(&mut self, command_rad: f64) -> Option<Wing<'_>> {
        self.k += 1;
        self.wing(command_rad)
    }

    /// An aircraft with what is held until the next sample.
    pub(crate) fn wing(&mut self, command_rad: f64) -> Option<Wing<'_>> {
        let (autopilot, disturbance_rad) = (self.commands(), self.disturbance_rad);
        let prepared: &Prepared = self.prepared.borrow();
        let (Propagation::Aircraft(flight), Motion::Aircraft(motion)) =
            (&prepared.stages[self.stage].propagation, &mut self.plant)
        else {
            return None;
        };
        Some(Wing { flight, motion, command_rad, disturbance_rad, autopilot })
    }

    /// Flies to the next sample.
    #[inline]
    pub(crate) fn advance(&mut self, command_rad: f64) -> Result<(), SimError> {
        let autopilot = self.commands();
        let prepared: &Prepared = self.prepared.borrow();
        let air = (prepared.gusts(), prepared.gust_responses.as_deref());
        let held = Held { autopilot, ..held(self.disturbance_rad, air, self.k) };
        let propagation = &prepared.stages[self.stage].propagation;
        propagation.advance(&mut self.plant, command_rad, &held)?;
        self.k += 1;
        Ok(())
    }
}

pub(crate) use small_motion::{Alone, poles_of_mode, radii_alone};
pub use small_motion::{ModePoles, mode_poles};

/// Commands on their way, the oldest at `next`.
#[derive(Clone, Debug)]
struct Delay {
    commands_rad: Vec<f64>,
    next: usize,
}

impl Delay {
    fn of(samples: usize) -> Self {
        Self { commands_rad: vec![0.0; samples], next: 0 }
    }

    /// The commands on their way, the oldest first.
    fn in_order(&self) -> impl Iterator<Item = f64> {
        let (later, first) = self.commands_rad.split_at(self.next);
        first.iter().chain(later).copied()
    }

    /// Moves the command of a place among them.
    fn nudge(&mut self, place: usize, by_rad: f64) {
        let length = self.commands_rad.len().max(1);
        if let Some(command_rad) = self.commands_rad.get_mut((self.next + place) % length) {
            *command_rad += by_rad;
        }
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
#[derive(Clone, Debug)]
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

    fn each_mut(&mut self) -> impl Iterator<Item = &mut SensorState> {
        self.pitch.iter_mut().chain(&mut self.rate)
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
