//! Whether a flight ends with a command that is held because its last sample is not believed.

use fspid_core::Faults;

use crate::controller::Controller;
use crate::held_limits::last_load_rad;
use crate::propagation::DIVERGED_RAD;
use crate::scenario::Scenario;
use crate::signal::Entry;
use crate::trace::Trace;

/// True where the last sample of a flight is beyond the controller's sample guard, so that its command is held.
pub(crate) fn holds_the_command(
    scenario: &Scenario,
    controller: &Controller,
    trace: &Trace,
) -> bool {
    let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
    let shown = |name: &str| trace.column(name).map(last);
    let theta_rad = shown("measured_theta_rad")
        .unwrap_or_else(|| last(&trace.theta_rad) + last_load_rad(scenario, Entry::Measurement));
    let rate_rad_s = shown("measured_q_rad_s").unwrap_or_else(|| last(&trace.q_rad_s));
    let sample = [last(&trace.setpoint_rad), theta_rad, rate_rad_s];
    // A fault that was latched before says nothing of the last sample.
    trace.faults.contains(Faults::IMPLAUSIBLE) && is_beyond(controller, sample)
}

/// True where a controller has a guard that a flight may meet: one nearer than where a flight counts as diverged.
pub(crate) fn is_set(controller: &Controller) -> bool {
    controller.config().guard.limit_rad() < DIVERGED_RAD
}

/// True where a sample is beyond a controller's guard, so that its command is held: set-point, pitch and rate, as it sees them.
pub(crate) fn is_beyond(controller: &Controller, sample: [f64; 3]) -> bool {
    let [setpoint_rad, theta_rad, rate_rad_s] = sample;
    let rate_rad_s = if controller.uses_rate() { rate_rad_s } else { 0.0 };
    let limit_rad = controller.config().guard.limit_rad();
    [setpoint_rad, theta_rad, rate_rad_s].iter().any(|value| value.abs() > limit_rad)
}
