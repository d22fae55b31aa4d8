//! A history of commands, flown by the simulator.

use std::ops::ControlFlow;

use fspid_sim::{Outcome, Scenario, fly_commanded};

use crate::error::LimitError;
use crate::measure::Measure;
use crate::programme::Solution;
use crate::question::{Question, covered};
use crate::travel::Travel;

/// A flight by a history of commands, as the program's reports measure it.
#[derive(Clone, Debug, PartialEq)]
pub struct Flown {
    /// Commands, rad.
    pub command_rad: Vec<f64>,
    /// Pitch angle, rad.
    pub theta_rad: Vec<f64>,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: Vec<f64>,
    /// The measure, rad.
    pub measure: f64,
    /// The travel, rad.
    pub travel_rad: f64,
}

/// Flies commands, one a sample; behind the last they stay.
///
/// # Errors
/// As [`fly_commanded`]; [`LimitError::Solver`] for a flight that is lost.
pub fn fly_commands(
    scenario: &Scenario,
    commands_rad: &[f64],
    (measure, travel): (Measure, Travel),
) -> Result<Flown, LimitError> {
    let prepared = scenario.prepare()?;
    let mut next = commands_rad.iter().copied();
    let mut last = 0.0;
    let mut flown = Flown {
        command_rad: Vec::with_capacity(commands_rad.len()),
        theta_rad: Vec::new(),
        elevator_rad: Vec::new(),
        measure: 0.0,
        travel_rad: 0.0,
    };
    let mut errors_rad = Vec::new();
    let answer = |_: fspid_sim::core::Sample<f64>| {
        last = next.next().unwrap_or(last);
        last
    };
    let outcome = fly_commanded(&prepared, answer, |instant| {
        flown.command_rad.push(instant.step.command_rad);
        flown.theta_rad.push(instant.theta_rad);
        flown.elevator_rad.push(instant.elevator_rad);
        errors_rad.push(instant.setpoint_rad - instant.theta_rad);
        ControlFlow::Continue(())
    })?;
    if outcome != Outcome::Completed {
        return Err(LimitError::Solver { status: "its commands lose the aircraft".to_owned() });
    }
    flown.measure = measure.of(&errors_rad, scenario.timing.dt_s());
    flown.travel_rad = travel.of(&flown.command_rad, &flown.elevator_rad);
    Ok(flown)
}

/// A measure and a travel of columns of a flight, rad.
#[must_use]
pub fn measured(
    (measure, travel): (Measure, Travel),
    (setpoint_rad, theta_rad): (&[f64], &[f64]),
    (command_rad, elevator_rad): (&[f64], &[f64]),
    dt_s: f64,
) -> (f64, f64) {
    let errors: Vec<f64> = setpoint_rad.iter().zip(theta_rad).map(|(r, y)| r - y).collect();
    (measure.of(&errors, dt_s), travel.of(command_rad, elevator_rad))
}

/// The commands of a controller that make the actuator's targets of a solution, rad, one a sample.
pub(crate) fn commands(question: &Question, solution: &Solution) -> Vec<f64> {
    let (rows, delay) = (question.rows, question.delay());
    (0..rows)
        .map(|k| {
            // The command of this sample arrives `delay` later; the last ones never arrive.
            let arrives = (k + delay).min(question.target_end() - 1).max(delay.min(rows - 1));
            let target_rad = target(question, solution, arrives);
            question.allowed(k, question.command_of(target_rad) - question.at_servo(arrives))
        })
        .collect()
}

/// The target that brings the deflection where a solution has it at the next sample, rad.
pub(crate) fn target(question: &Question, solution: &Solution, k: usize) -> f64 {
    let plain = solution.target_rad.get(k).copied().unwrap_or(0.0);
    let Some(rate) = question.actuator.rate_limit_rad_s else { return plain };
    let here = solution.deflection_rad.get(k).copied().unwrap_or(0.0);
    let tau_s = question.actuator.lag.time_constant_s().unwrap_or(0.0);
    let gap = plain - here;
    if gap.abs() <= rate * tau_s {
        return plain;
    }
    // Held by its rate for a time d, then by the lag: R d + R τ (1 - e^(-(T - d) / τ)) of the way.
    let way = gap * covered(question.actuator, question.dt_s).midpoint();
    let reached = |held_s: f64| {
        let free = if tau_s > 0.0 {
            rate * tau_s * -libm::expm1(-(question.dt_s - held_s) / tau_s)
        } else {
            0.0
        };
        rate * held_s + free
    };
    let (mut least_s, mut most_s) = (0.0, question.dt_s);
    for _ in 0..60 {
        let middle_s = 0.5 * (least_s + most_s);
        *(if reached(middle_s) < way.abs() { &mut least_s } else { &mut most_s }) = middle_s;
    }
    here + (rate * (0.5 * (least_s + most_s)) + rate * tau_s).copysign(gap)
}
