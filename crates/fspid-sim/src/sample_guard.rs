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

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, Guard, Pid, PidConfig};

    use super::*;
    use crate::closed_loop::simulate;
    use crate::plant::{ElevatorSign, LinearPlant};
    use crate::scenario::NamedController;
    use crate::signal::{Disturbance, Profile, Shape};
    use crate::timing::Timing;

    const LIMIT_RAD: f64 = 0.5;

    fn guarded(limit_rad: f64) -> Controller {
        let guard = Guard::new(limit_rad).expect("allowed");
        let config = PidConfig { guard, ..PidConfig::sampled_every(0.01) };
        let gains = Gains { kp: 1.0, ki: 0.0, kd: 1.0 };
        Controller::Fixed(Pid::new(gains, config).expect("allowed"))
    }

    /// A flight under a load at the measurement, from 0.5 s on.
    fn scenario(load_rad: f64) -> Scenario {
        let plant = LinearPlant::new(&[1.0], &[1.0, 1.0], ElevatorSign::NoseUpPositive);
        let step = Shape::Step { at_s: 0.5 };
        let load = Disturbance::new(Entry::Measurement, load_rad, step.clone());
        let setpoint = Profile::new(0.1, step).expect("allowed");
        let timing = Timing::new(0.01, 1.0).expect("allowed");
        let named = NamedController { name: "C".into(), controller: guarded(LIMIT_RAD) };
        Scenario {
            controllers: vec![named],
            disturbances: vec![load.expect("allowed")],
            ..Scenario::new("guarded", plant.expect("proper"), timing, setpoint)
        }
    }

    /// Whether the command is held of a flight that ends at a pitch and rate under a load at the measurement.
    fn is_held(load_rad: f64, [theta_rad, rate_rad_s]: [f64; 2], faults: Faults) -> bool {
        let own = scenario(load_rad);
        let mut trace = simulate(&own).expect("flies").traces.remove(0);
        trace.faults = faults;
        *trace.theta_rad.last_mut().expect("flown") = theta_rad;
        *trace.q_rad_s.last_mut().expect("flown") = rate_rad_s;
        holds_the_command(&own, &own.controllers[0].controller, &trace)
    }

    #[test]
    fn a_command_is_held_where_the_last_pitch_that_is_measured_is_beyond_the_guard() {
        let implausible = Faults::IMPLAUSIBLE;
        assert!(is_held(0.25, [0.3, 0.0], implausible) && is_held(-0.25, [-0.3, 0.0], implausible));
        assert!(
            !is_held(0.25, [0.2, 0.0], implausible) && !is_held(-0.25, [0.6, 0.0], implausible)
        );
        // Without a rate in its law a controller sees none; and without the fault nothing was held.
        assert!(
            !is_held(0.25, [0.0, 9.0], implausible) && !is_held(0.25, [0.3, 0.0], Faults::NONE)
        );
    }

    #[test]
    fn a_sample_at_the_guard_is_believed_and_a_guard_beyond_all_flights_is_none() {
        let controller = guarded(LIMIT_RAD);
        for (sample, wanted) in [
            ([LIMIT_RAD, -LIMIT_RAD, 0.0], false),
            ([0.51, 0.0, 0.0], true),
            ([0.0, -0.51, 0.0], true),
            ([0.0, 0.0, 9.0], false),
        ] {
            assert_eq!(is_beyond(&controller, sample), wanted, "{sample:?}");
        }
        assert!(is_set(&controller) && !is_set(&guarded(DIVERGED_RAD)));
    }
}
