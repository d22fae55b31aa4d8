//! Taking over from a command that another gave bumps nothing, for every option.

use fspid_core::{AntiWindup, Controller, IntegralForm, Sample, State, Step};
use fspid_export::vectors::samples;
use proptest::prelude::*;

/// What may move the command between two samples that are the same: one sample of the integral, the derivative, and
/// what the gains move.
fn moves(
    controller: &Controller<f64>,
    tracked: &Step<f64>,
    next: &Step<f64>,
    state: &State<f64>,
    sample: &Sample<f64>,
) -> f64 {
    let (equations, dt_s) = (controller.equations(), controller.config().dt_s);
    let terms = |step: &Step<f64>| {
        let (weight, rate_gain_s) = equations.coupled(&step.gains);
        let Sample { setpoint_rad, measurement_rad, rate_rad_s } = *sample;
        step.gains.kp * (weight * setpoint_rad - measurement_rad)
            - if controller.uses_rate() { rate_gain_s * rate_rad_s } else { 0.0 }
    };
    let error_rad = sample.setpoint_rad - sample.measurement_rad;
    let derivative =
        state.derivative_rad_s().abs() * (tracked.gains.kd.abs() + next.gains.kd.abs());
    let bent = match controller.config().integral {
        IntegralForm::Bumpless => 0.0,
        IntegralForm::Literal => (next.gains.ki - tracked.gains.ki) * state.integral() * dt_s,
    };
    (terms(next) - terms(tracked)).abs()
        + derivative
        + (next.gains.ki * error_rad * dt_s).abs()
        + bent.abs()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_next_step_continues_from_the_command_of_another(
        controller in fspid_options::any_controller(),
        seed in any::<u64>(),
        command_rad in -0.4..0.4,
    ) {
        let mut state = State::new();
        let flown = samples::<f64>(seed, 40);
        for sample in &flown {
            controller.step(&mut state, *sample);
        }
        let sample = Sample { setpoint_rad: 0.1, measurement_rad: 0.07, rate_rad_s: 0.02 };
        let tracked = controller.track(&mut state, sample, command_rad);
        let config = controller.config();
        let within = config.limits.map_or(command_rad, |limits| limits.clamp(command_rad));
        prop_assert_eq!(tracked.command_rad.to_bits(), within.to_bits());
        let before = state;
        let next = controller.step(&mut state, sample);
        let bump_rad = (next.command_rad - within).abs();
        if let Some(slew_rad_s) = config.slew_rad_s {
            prop_assert!(bump_rad <= slew_rad_s * config.dt_s + 1e-12, "{}", bump_rad);
        }
        // Where a memory may hold the command.
        let clamps = matches!(config.anti_windup, AntiWindup::Clamping(_));
        if tracked.gains.ki.abs() > 1e-3 && !clamps {
            let most = moves(&controller, &tracked, &next, &before, &sample);
            prop_assert!(bump_rad <= most + 1e-9, "{} > {}", bump_rad, most);
        }
    }
}

#[test]
fn a_command_that_is_none_is_held_and_latched() {
    use fspid_core::{Faults, Gains, Pid, PidConfig};
    let pid = Pid::new(Gains { kp: 1.0, ki: 0.5, kd: 0.0 }, PidConfig::sampled_every(0.01))
        .expect("allowed");
    let (controller, mut state) = (Controller::Fixed(pid), State::new());
    let sample = Sample { setpoint_rad: 0.1, measurement_rad: 0.0, rate_rad_s: 0.0 };
    let step = controller.step(&mut state, sample);
    let held = controller.track(&mut state, sample, f64::NAN);
    assert_eq!(held.command_rad.to_bits(), step.command_rad.to_bits());
    assert_eq!(controller.track(&mut state, sample, 1e30).faults, state.take_faults());
    assert_eq!(held.faults, Faults::NOT_FINITE);
}
