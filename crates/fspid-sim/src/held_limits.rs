//! Saturation at the end of a flight: whether actuator and command limits leave enough authority to hold an unstable or
//! integrating plant at the final set-points and loads.
//!
//! Around a rest limits do not act. Where there is none, because what is held takes more command than there is, a plant that is
//! unstable by itself, or integrates, leaves for good, however stable the loop would be around it.

use fspid_aircraft::ForceModel;
use fspid_core::{AntiWindup, Gains, Limits};

use crate::controller::Controller;
use crate::integral_limits::HeldIntegral;
use crate::plant::LinearPlant;
use crate::rest::{RestPoint, pitches_without_integral};
use crate::scenario::Scenario;
use crate::signal::Entry;

/// A pole this far to the left, as a share of one and its size, comes to rest by itself; one nearer the axis may be on it but
/// for rounding.
const AT_REST: f64 = 1e-6;
/// True where set-point and loads of the last sample, held on, take more than the limits of controller, servo or elevator of a
/// plant that does not come to rest by itself and stays to the end; of a nonlinear aircraft its linear model at the last of its
/// trims, with the travel of its own elevator. Outer loops command another set-point: with them it is asked of plants alone
/// that integrate, whose rest takes the same at every pitch.
pub(crate) fn are_exceeded(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> bool {
    if is_unlimited(scenario, controller) {
        return false;
    }
    last_plant(scenario).is_some_and(|plant| {
        let is_asked = scenario.autopilot.is_none() || plant.steady_gain().is_infinite();
        let exceeds = |held: Held| held.exceeds(scenario, controller);
        is_asked
            && moves_by_itself(&plant)
            && Held::at_the_end(scenario, &plant, controller, gains).into_iter().any(exceeds)
    })
}

fn is_unlimited(scenario: &Scenario, controller: &Controller) -> bool {
    controller.config().limits.is_none()
        && limits_of_servo(scenario).next().is_none()
        && travel_of_airframe(scenario).is_none()
}

/// Ends of the travel of an aircraft's own elevator, whatever moves it, rad from its place at the trim; none without an end.
fn travel_of_airframe(scenario: &Scenario) -> Option<(f64, f64)> {
    let plant = scenario.plant.aircraft()?;
    let (trim_rad, travel) =
        (plant.trim().point.elevator_rad, plant.aircraft().model().travel().elevator_rad);
    // The trailing edge goes down where the command, nose up positive, is negative.
    let ends = (trim_rad - travel.max, trim_rad - travel.min);
    (ends.0.is_finite() || ends.1.is_finite()).then_some(ends)
}

/// Limits of commands and of travel of what moves the elevator, rad.
fn limits_of_servo(scenario: &Scenario) -> impl Iterator<Item = (f64, f64)> {
    let actuator = &scenario.actuator;
    [actuator.command_limits_rad(), actuator.travel_rad()].into_iter().flatten()
}

/// The linear plant that a flight ends with; none of an aircraft that has no trim then.
pub(crate) fn last_plant(scenario: &Scenario) -> Option<LinearPlant> {
    match scenario.plant.aircraft() {
        Some(aircraft) => aircraft.lasting().ok()?.pop()?.1,
        None => scenario.lasting_plants().last().map(|(_, plant)| (*plant).clone()),
    }
}

/// True for a plant that does not come to rest under a command that stands still: it is unstable, or integrates.
pub(crate) fn moves_by_itself(plant: &LinearPlant) -> bool {
    has_pole_from(plant, -AT_REST)
}

/// True where one of its poles is at least so far to the right, as a share of one and its size.
fn has_pole_from(plant: &LinearPlant, share: f64) -> bool {
    let poles = plant.transfer_function().poles().unwrap_or_default();
    poles.iter().any(|pole| pole.re > share * (1.0 + pole.norm()))
}

/// How a plant moves under a command that stands still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moves {
    /// It runs away: a pole lies to the right of the axis.
    Away,
    /// It goes on: a pole lies on the axis.
    On,
    /// It comes back to where it was.
    Back,
}

impl Moves {
    pub(crate) fn of(plant: &LinearPlant) -> Self {
        if has_pole_from(plant, AT_REST) {
            Self::Away
        } else if moves_by_itself(plant) {
            Self::On
        } else {
            Self::Back
        }
    }
}

/// What a rest takes, rad of elevator, nose up positive.
struct Held {
    /// At the elevator.
    elevator_rad: f64,
    /// Loads at servo and elevator.
    at_servo_rad: f64,
    at_elevator_rad: f64,
}

impl Held {
    /// At each rest that there is: without an integral there may be several.
    fn at_the_end(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
        gains: Gains<f64>,
    ) -> Vec<Self> {
        let [at_servo_rad, at_elevator_rad] = loads_at_the_end_rad(scenario);
        let held = |pitch_rad: f64| {
            let elevator_rad = pitch_rad / plant.steady_gain();
            Self { elevator_rad, at_servo_rad, at_elevator_rad }
        };
        let pitches_rad = pitches_at_the_end(scenario, plant, controller, gains);
        pitches_rad.into_iter().map(held).collect()
    }

    fn exceeds(&self, scenario: &Scenario, controller: &Controller) -> bool {
        let travelled_rad = self.elevator_rad - self.at_elevator_rad;
        let commanded_rad = travelled_rad - self.at_servo_rad;
        let beyond = |(least, most): (f64, f64), value: f64| value < least || value > most;
        let ends = |limits: &Limits<f64>| (limits.lower(), limits.upper());
        limits_of_servo(scenario).any(|limits| beyond(limits, travelled_rad))
            || travel_of_airframe(scenario).is_some_and(|it| beyond(it, self.elevator_rad))
            || controller.config().limits.as_ref().is_some_and(|it| beyond(ends(it), commanded_rad))
    }
}

/// Pitches, rad from the trim, at which set-point, loads and errors of the pitch sensor at the last sample, held on, let a plant
/// rest: one with an integral, several where there may be.
pub(crate) fn pitches_at_the_end(
    scenario: &Scenario,
    plant: &LinearPlant,
    controller: &Controller,
    gains: Gains<f64>,
) -> Vec<f64> {
    let setpoint_rad = scenario.held_at_the_end_rad();
    let [offset_rad, scale] = errors_of_pitch_sensor(scenario);
    let pitch_rad = |seen_rad: f64| (seen_rad - offset_rad) / scale;
    if gains.ki != 0.0 {
        let config = controller.config_at(gains);
        let held = HeldIntegral::at_the_end(scenario, plant, gains, &config);
        let seen_rad = held.and_then(|it| it.seen_at_limit_rad()).unwrap_or(setpoint_rad);
        return vec![pitch_rad(seen_rad)];
    }
    let at = RestPoint { setpoint_rad, load_rad: load_unseen_rad(scenario, plant) };
    let seen = pitches_without_integral(scenario, plant, controller, gains, at);
    seen.into_iter().map(pitch_rad).collect()
}

/// What the command is with nothing seen while loads and errors of the pitch sensor at the last sample are held on, rad.
pub(crate) fn load_unseen_rad(scenario: &Scenario, plant: &LinearPlant) -> f64 {
    let [at_servo_rad, at_elevator_rad] = loads_at_the_end_rad(scenario);
    let [offset_rad, scale] = errors_of_pitch_sensor(scenario);
    -offset_rad / scale / plant.steady_gain() - at_servo_rad - at_elevator_rad
}

/// What is added to the pitch at the last sample where it is seen, rad, and by what it is multiplied.
fn errors_of_pitch_sensor(scenario: &Scenario) -> [f64; 2] {
    let sensor = scenario.surroundings.pitch_sensor;
    let scale = 1.0 + sensor.map_or(0.0, |it| it.model().scale_error);
    let bias_rad = sensor.map_or(0.0, |it| it.bias());
    [last_load_rad(scenario, Entry::Measurement) + bias_rad, scale]
}

/// What acts at servo and elevator at the last sample, rad.
fn loads_at_the_end_rad(scenario: &Scenario) -> [f64; 2] {
    let at_elevator_rad = last_load_rad(scenario, Entry::Elevator) + scenario.actuator.bias_rad();
    [last_load_rad(scenario, Entry::Servo), at_elevator_rad]
}

/// What acts at a place at the last sample, rad; what never stands still counts by its mean, 0.
pub(crate) fn last_load_rad(scenario: &Scenario, entry: Entry) -> f64 {
    let timing = scenario.timing;
    let mut values = vec![0.0; timing.rows()];
    let held = scenario.disturbances.iter().filter(|it| it.entry() == entry && it.stands_still());
    held.for_each(|it| it.add_to(&mut values, timing, 0));
    values.last().copied().unwrap_or(0.0)
}

/// What limits a command and what moves the elevator.
#[derive(Clone, Debug)]
pub(crate) struct Ends {
    /// Of the controller's command, rad.
    own: Option<(f64, f64)>,
    /// Of what the servo is told and where it and the airframe let the elevator go, rad.
    of_servo: Vec<(f64, f64)>,
    /// Most that a command, and the elevator, move in a sample, rad.
    by_sample: [Option<f64>; 2],
    /// The integral has limits of its own, of which a command tells nothing.
    is_clamped: bool,
}

impl Ends {
    pub(crate) fn of(scenario: &Scenario, controller: &Controller) -> Self {
        let config = controller.config();
        let dt_s = scenario.timing.dt_s();
        let rates_rad_s = [config.slew_rad_s, scenario.actuator.rate_limit_rad_s()];
        Self {
            own: config.limits.as_ref().map(|it| (it.lower(), it.upper())),
            of_servo: limits_of_servo(scenario).chain(travel_of_airframe(scenario)).collect(),
            by_sample: rates_rad_s.map(|it| it.map(|rate_rad_s| rate_rad_s * dt_s)),
            is_clamped: matches!(config.anti_windup, AntiWindup::Clamping(_)),
        }
    }

    /// True where nothing has a limit.
    pub(crate) fn are_none(&self) -> bool {
        let has_none = self.own.is_none() && self.of_servo.is_empty();
        has_none && self.by_sample == [None; 2] && !self.is_clamped
    }

    /// True where a command, or with what acts at the servo what it is told, is at a limit.
    pub(crate) fn are_met(&self, command_rad: f64, at_servo_rad: f64) -> bool {
        let at_end = |value: f64, (least, most): (f64, f64)| value <= least || value >= most;
        let told_rad = command_rad + at_servo_rad;
        self.own.is_some_and(|it| at_end(command_rad, it))
            || self.of_servo.iter().any(|it| at_end(told_rad, *it))
    }

    /// True where command or elevator move in a sample by at least this share of the most that they may.
    pub(crate) fn are_met_by_moving(
        &self,
        share: f64,
        command_rad: f64,
        elevator_rad: f64,
    ) -> bool {
        let moved = self.by_sample.iter().zip([command_rad, elevator_rad]);
        moved.into_iter().any(|(most, by)| most.is_some_and(|most| by.abs() >= share * most))
    }
}
