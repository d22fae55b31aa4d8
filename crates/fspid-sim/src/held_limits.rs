//! Whether limits leave what holds an unstable plant where its flight ends.
//!
//! Around a rest limits do not act. Where there is none, because what is held takes more command than there is, a plant that is
//! unstable by itself leaves for good, however stable the loop would be around it.

use fspid_aircraft::ForceModel;
use fspid_core::Limits;

use crate::controller::Controller;
use crate::plant::LinearPlant;
use crate::scenario::Scenario;
use crate::signal::Entry;
use crate::trace::Trace;

/// A pole this far to the right, as a share of one and its size, is unstable, and no double pole at the origin after rounding.
const UNSTABLE: f64 = 1e-6;
/// Fewest samples of a last tenth of which something is said.
const LEAST_TAIL: usize = 10;

/// True where set-point and loads of the last sample, held on, take more than the limits of controller, servo or elevator of a
/// plant that is unstable by itself and stays to the end; of a nonlinear aircraft its linear model at the last of its trims, with
/// the travel of its own elevator. Without an integral rest is elsewhere, and outer loops command another set-point: of these it
/// is not asked.
pub(crate) fn are_exceeded(scenario: &Scenario, controller: &Controller, ki: f64) -> bool {
    if ki == 0.0 || scenario.autopilot.is_some() || is_unlimited(scenario, controller) {
        return false;
    }
    last_plant(scenario).is_some_and(|plant| {
        is_unstable(&plant) && Held::at_the_end(scenario, &plant).exceeds(scenario, controller)
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
fn last_plant(scenario: &Scenario) -> Option<LinearPlant> {
    match scenario.plant.aircraft() {
        Some(aircraft) => aircraft.lasting().ok()?.pop()?.1,
        None => scenario.lasting_plants().last().map(|(_, plant)| (*plant).clone()),
    }
}

fn is_unstable(plant: &LinearPlant) -> bool {
    let poles = plant.transfer_function().poles().unwrap_or_default();
    poles.iter().any(|pole| pole.re > UNSTABLE * (1.0 + pole.norm()))
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
    fn at_the_end(scenario: &Scenario, plant: &LinearPlant) -> Self {
        let setpoint = &scenario.setpoint;
        let setpoint_rad = match setpoint.is_sine() {
            true => 0.0,
            false => setpoint.sampled(scenario.timing).0.last().copied().unwrap_or(0.0),
        };
        let sensor = scenario.surroundings.pitch_sensor;
        let scale = 1.0 + sensor.map_or(0.0, |it| it.model().scale_error);
        let bias_rad = sensor.map_or(0.0, |it| it.bias());
        let load = |entry| last_load_rad(scenario, entry);
        let pitch_rad = (setpoint_rad - load(Entry::Measurement) - bias_rad) / scale;
        Self {
            elevator_rad: pitch_rad / plant.steady_gain(),
            at_servo_rad: load(Entry::Servo),
            at_elevator_rad: load(Entry::Elevator) + scenario.actuator.bias_rad(),
        }
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

/// What acts at a place at the last sample, rad; what never stands still counts by its mean, 0.
fn last_load_rad(scenario: &Scenario, entry: Entry) -> f64 {
    let timing = scenario.timing;
    let mut values = vec![0.0; timing.rows()];
    let held = scenario.disturbances.iter().filter(|it| it.entry() == entry && it.stands_still());
    held.for_each(|it| it.add_to(&mut values, timing, 0));
    values.last().copied().unwrap_or(0.0)
}

/// True where a flight of a plant that is unstable by itself ends at a limit of controller or servo with an error that is
/// larger than ever before and grows: through the last tenth of it, at every sample.
#[must_use]
pub fn is_lost_at_a_limit(scenario: &Scenario, controller: &Controller, trace: &Trace) -> bool {
    let rows = trace.rows();
    let tail = rows / 10;
    let is_cut = |command_rad: &f64| is_at_a_limit(scenario, controller, *command_rad);
    if tail < LEAST_TAIL || !trace.command_rad.last().is_some_and(is_cut) {
        return false;
    }
    let errors: Vec<f64> =
        trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| (r - y).abs()).collect();
    let Some((before, last)) = errors.split_at_checked(rows - tail) else { return false };
    let largest = before.iter().copied().fold(0.0, f64::max);
    let grows = last.windows(2).all(|two| two[0] < two[1]) && last.last() > Some(&largest);
    grows
        && trace.command_rad.iter().rev().take(tail).all(is_cut)
        && last_plant(scenario).is_some_and(|plant| is_unstable(&plant))
}

fn is_at_a_limit(scenario: &Scenario, controller: &Controller, command_rad: f64) -> bool {
    let own = controller.config().limits.as_ref().map(|it| (it.lower(), it.upper()));
    let at_end = |(least, most): (f64, f64)| command_rad <= least || command_rad >= most;
    let of_airframe = travel_of_airframe(scenario);
    own.into_iter().chain(limits_of_servo(scenario)).chain(of_airframe).any(at_end)
}
