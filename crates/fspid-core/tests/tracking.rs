//! Taking part while another commands: the memory that is left, recomputed by its definition.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{NOMINAL, Random, T, fspid, pid, sample};
use fspid_core::{
    AntiWindup, Controller, ControllerSetting, Derivative, Faults, GainCoupling, Gains,
    IntegralForm, Limits, PidConfig, Sample, SecondInput, SetpointWeights, State, TunerSettings,
};

const FORMS: [IntegralForm; 2] = [IntegralForm::Bumpless, IntegralForm::Literal];
const FILTER_S: f64 = 0.05;
const FEEDFORWARD: f64 = 0.7;
const COUPLING: GainCoupling<f64> = GainCoupling { setpoint_weight: 0.3, rate_gain: 2.0 };

fn limits(lower: f64, upper: f64) -> Limits<f64> {
    Limits::new(ControllerSetting::OutputLimits, lower, upper).expect("lower is below upper")
}

/// Every term: weights, filter, rate loop, feed-forward; limits of the command of 0.4 rad.
fn config(integral: IntegralForm, anti_windup: AntiWindup<f64>) -> PidConfig<f64> {
    PidConfig {
        rate_gain_s: 0.4,
        setpoint_weights: SetpointWeights { proportional: 0.6, derivative: 0.3 },
        feedforward: FEEDFORWARD,
        derivative: Derivative { filter_s: FILTER_S },
        integral,
        anti_windup,
        limits: Some(limits(-0.4, 0.4)),
        ..PidConfig::sampled_every(T)
    }
}

/// Fixed gains, and gains that move and are followed by a weight and the rate loop.
fn controllers(config: PidConfig<f64>) -> [Controller<f64>; 2] {
    let settings = TunerSettings {
        second_input: SecondInput::Rate,
        output_scale: Gains { kp: 0.2, ki: 0.05, kd: 0.1 },
        gain_coupling: COUPLING,
        ..TunerSettings::literal()
    };
    [Controller::Fixed(pid(NOMINAL, config)), Controller::SelfTuning(fspid(settings, config))]
}

/// $u - k_p (b r - y) - k_d d + k_r q - k_f r$: what the other terms leave of a command.
fn left(
    controller: &Controller<f64>,
    gains: Gains<f64>,
    derivative: f64,
    sample: Sample<f64>,
    command_rad: f64,
) -> f64 {
    let follows = matches!(controller, Controller::SelfTuning(_));
    let GainCoupling { setpoint_weight, rate_gain } =
        if follows { COUPLING } else { GainCoupling::NONE };
    let weight = 0.6 + setpoint_weight * (gains.kp - NOMINAL.kp);
    let rate_gain_s = 0.4 + rate_gain * (gains.kd - NOMINAL.kd);
    let Sample { setpoint_rad: r, measurement_rad: y, rate_rad_s: q } = sample;
    command_rad - gains.kp * (weight * r - y) - gains.kd * derivative + rate_gain_s * q
        - FEEDFORWARD * r
}

/// A few roundings of numbers below 10; the literal form divides by ki T and multiplies again.
const ROUNDINGS: f64 = 1e-13;

#[test]
fn while_another_commands_the_integral_is_what_the_other_terms_leave_of_its_command() {
    let clamps = AntiWindup::Clamping(limits(-0.3, 0.2));
    let pulls = AntiWindup::BackCalculation { tracking_s: 0.5 };
    for anti_windup in [AntiWindup::None, AntiWindup::Conditional, pulls, clamps] {
        for form in FORMS {
            for controller in controllers(config(form, anti_windup)) {
                let (mut state, mut random) = (State::new(), Random(21));
                let (mut derivative, mut input_prev) = (0.0, None);
                for sample in Random(22).samples(300) {
                    let other_rad = 0.6 * random.signed();
                    let step = controller.track(&mut state, sample, other_rad);
                    // Within the limits, and told where they cut it.
                    assert_eq!(step.command_rad, other_rad.clamp(-0.4, 0.4));
                    assert_eq!(step.saturated, other_rad.abs() > 0.4);
                    assert_eq!(state.command_rad, step.command_rad);

                    let input = 0.3 * sample.setpoint_rad - sample.measurement_rad;
                    let moved = input - input_prev.unwrap_or(input);
                    derivative = (FILTER_S * derivative + moved) / (FILTER_S + T);
                    input_prev = Some(input);
                    let mut expected =
                        left(&controller, step.gains, derivative, sample, step.command_rad);
                    if anti_windup == clamps {
                        expected = expected.clamp(-0.3, 0.2);
                    }
                    let term_rad = match form {
                        IntegralForm::Bumpless => state.integral(),
                        IntegralForm::Literal => step.gains.ki * state.integral() * T,
                    };
                    let off = (term_rad - expected).abs();
                    assert!(off < ROUNDINGS, "{anti_windup:?} {form:?}: {term_rad} {expected}");
                }
            }
        }
    }
}

/// The derivative fades by Tf / (Tf + T) while what it acts on rests, and the integral takes one sample more.
#[test]
fn who_takes_over_at_an_unchanged_sample_moves_the_command_by_integral_and_fading_derivative_alone()
{
    for form in FORMS {
        let controller = Controller::Fixed(pid(NOMINAL, config(form, AntiWindup::None)));
        let (mut state, mut random) = (State::new(), Random(23));
        for sample in Random(24).samples(300) {
            let tracked = controller.track(&mut state, sample, 0.1 * random.signed());
            let (mut taken_over, derivative) = (state, state.derivative_rad_s());
            let next = controller.step(&mut taken_over, sample);
            let error_rad = sample.setpoint_rad - sample.measurement_rad;
            let fading = derivative * (FILTER_S / (FILTER_S + T) - 1.0);
            let expected = tracked.command_rad + NOMINAL.ki * error_rad * T + NOMINAL.kd * fading;
            let off = (next.command_rad - expected.clamp(-0.4, 0.4)).abs();
            assert!(off < ROUNDINGS, "{form:?}: {next:?} {expected}");
        }
    }
}

#[test]
fn without_an_integral_gain_tracking_leaves_the_memory_that_a_step_would() {
    for form in FORMS {
        let config = config(form, AntiWindup::None);
        let controller = Controller::Fixed(pid(Gains { ki: 0.0, ..NOMINAL }, config));
        let (mut state, mut stepped) = (State::new(), State::new());
        for sample in Random(25).samples(50) {
            controller.track(&mut state, sample, 0.25);
            controller.step(&mut stepped, sample);
            assert_eq!(state, State { command_rad: 0.25, ..stepped }, "{form:?}");
        }
    }
}

#[test]
fn a_bad_command_or_sample_is_held_while_another_commands_and_the_memory_stays() {
    let good = sample(0.1, 0.02, 0.3);
    let bad_sample = sample(f64::NAN, 0.02, 0.3);
    for controller in controllers(config(IntegralForm::Bumpless, AntiWindup::None)) {
        let mut state = State::new();
        controller.track(&mut state, good, 0.3);
        let before = state;
        for (sample, command_rad, fault) in [
            (good, f64::NAN, Faults::NOT_FINITE),
            (good, 1e30, Faults::IMPLAUSIBLE),
            (bad_sample, 0.1, Faults::NOT_FINITE),
        ] {
            let held = controller.track(&mut state, sample, command_rad);
            assert_eq!((held.command_rad, held.faults), (0.3, fault));
            assert_eq!(state.take_faults(), fault);
            assert_eq!(state, before);
        }
    }
}
