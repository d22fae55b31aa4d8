//! Runs of the controllers recomputed by a plain loop of their definitions: equal bits.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{NOMINAL, Random, T, error, fspid, pid, sample, supervisor};
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{
    Change, Derivative, ErrorSign, Gains, InputScale, IntegralForm, Law, PidConfig, Sample,
    SetpointWeights, State, TunerSettings,
};

const OUTPUT_SCALE: Gains<f64> = Gains { kp: 0.2, ki: 0.05, kd: 0.1 };
/// Supervisor units per rad: degrees, and a fifth of degrees per second.
const INPUT_SCALE: InputScale<f64> = InputScale {
    error_per_rad: 180.0 / std::f64::consts::PI,
    change_per_rad: 36.0 / std::f64::consts::PI,
};

/// The definitions, once more. `tuning` is the law, what the supervisor sees as change, and +1 or
/// -1 for the sign of its error; without it the gains stay nominal.
fn by_hand(
    samples: &[Sample<f64>],
    nominal: Gains<f64>,
    config: &PidConfig<f64>,
    tuning: Option<(Law<f64>, Change, f64)>,
) -> Vec<f64> {
    let supervisor = supervisor::<f64>(OutOfRange::Clamp);
    let Gains { mut kp, mut ki, mut kd } = nominal;
    let (mut sum, mut integral, mut d) = (0.0, 0.0, 0.0);
    let (mut e_prev, mut x_prev) = (f64::NAN, f64::NAN);
    let SetpointWeights { proportional: b, derivative: c } = config.setpoint_weights;
    let tf = config.derivative.filter_s;
    let mut commands = Vec::new();
    for (k, &Sample { setpoint_rad: r, measurement_rad: y, rate_rad_s: q }) in
        samples.iter().enumerate()
    {
        let e = r - y;
        if let Some((law, change, sign)) = tuning {
            let delta = if k == 0 { 0.0 } else { e - e_prev };
            let change = if change == Change::Rate { delta / T } else { delta };
            let seen = (INPUT_SCALE.error_per_rad * e, INPUT_SCALE.change_per_rad * change);
            let add = supervisor.infer(sign * seen.0, sign * seen.1).expect("finite").delta;
            let add =
                (OUTPUT_SCALE.kp * add.kp, OUTPUT_SCALE.ki * add.ki, OUTPUT_SCALE.kd * add.kd);
            if law == Law::Memoryless {
                (kp, ki, kd) = (nominal.kp + add.0, nominal.ki + add.1, nominal.kd + add.2);
            } else {
                (kp, ki, kd) = (kp + add.0 * T, ki + add.1 * T, kd + add.2 * T);
            }
        }
        sum += e;
        integral = if config.integral == IntegralForm::Literal {
            ki * sum * T
        } else {
            integral + ki * e * T
        };
        let x = c * r - y;
        if k > 0 {
            d = if tf > 0.0 { (tf * d + (x - x_prev)) / (tf + T) } else { (x - x_prev) / T };
        }
        commands.push(kp * (b * r - y) + integral + kd * d - config.rate_gain_s * q);
        if config.feedforward != 0.0 {
            *commands.last_mut().expect("one") += config.feedforward * r;
        }
        (e_prev, x_prev) = (e, x);
    }
    commands
}

fn bits(commands: impl IntoIterator<Item = f64>) -> Vec<u64> {
    commands.into_iter().map(f64::to_bits).collect()
}

fn assert_pid_as_by_hand(gains: Gains<f64>, config: PidConfig<f64>) {
    let samples = Random(1).samples(400);
    let (controller, mut state) = (pid(gains, config), State::new());
    let ours = samples.iter().map(|&s| controller.step(&mut state, s).command_rad);
    assert_eq!(bits(ours), bits(by_hand(&samples, gains, &config, None)), "{config:?}");
}

#[test]
fn a_proportional_controller_with_a_rate_loop_is_its_definition() {
    let mut config = PidConfig::sampled_every(T);
    config.rate_gain_s = 0.9144;
    let kp = 3.5287;
    assert_pid_as_by_hand(Gains { kp, ..Gains::ZERO }, config);
}

#[test]
fn a_pid_is_its_definition_with_either_integral() {
    for integral in [IntegralForm::Bumpless, IntegralForm::Literal] {
        let config = PidConfig { integral, ..PidConfig::sampled_every(T) };
        assert_pid_as_by_hand(NOMINAL, config);
    }
}

#[test]
fn what_is_fed_forward_comes_on_top_whatever_the_gains_are() {
    for feedforward in [0.7, -0.4] {
        let config = PidConfig { feedforward, rate_gain_s: 0.2, ..PidConfig::sampled_every(T) };
        assert_pid_as_by_hand(NOMINAL, config);
        assert_pid_as_by_hand(Gains { kp: 0.0, ..NOMINAL }, config);
    }
}

#[test]
fn set_point_weights_and_derivative_filter_are_their_definitions() {
    for (proportional, derivative) in [(1.0, 1.0), (0.6, 0.0), (0.0, 0.3)] {
        for filter_s in [0.0, 0.05] {
            let config = PidConfig {
                setpoint_weights: SetpointWeights { proportional, derivative },
                derivative: Derivative { filter_s },
                rate_gain_s: 0.3,
                ..PidConfig::sampled_every(T)
            };
            assert_pid_as_by_hand(NOMINAL, config);
        }
    }
}

#[test]
fn a_self_tuning_controller_is_its_definition_under_every_law_sign_and_change() {
    let samples = Random(2).samples(400);
    for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.0 }] {
        for change in [Change::Rate, Change::Delta] {
            for (error_sign, sign) in [
                (ErrorSign::SetpointMinusMeasurement, 1.0),
                (ErrorSign::MeasurementMinusSetpoint, -1.0),
            ] {
                for integral in [IntegralForm::Bumpless, IntegralForm::Literal] {
                    let settings = TunerSettings {
                        error_sign,
                        change,
                        input_scale: INPUT_SCALE,
                        output_scale: OUTPUT_SCALE,
                        law,
                        ..TunerSettings::literal()
                    };
                    let config =
                        PidConfig { integral, rate_gain_s: 0.2, ..PidConfig::sampled_every(T) };
                    let (controller, mut state) = (fspid(settings, config), State::new());
                    let ours = samples.iter().map(|&s| controller.step(&mut state, s).command_rad);
                    let tuning = Some((law, change, sign));
                    let theirs = by_hand(&samples, NOMINAL, &config, tuning);
                    assert_eq!(bits(ours), bits(theirs), "{settings:?} {integral:?}");
                }
            }
        }
    }
}

#[test]
fn a_self_tuner_without_output_scale_is_the_fixed_controller_bit_for_bit() {
    for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.5 }] {
        let settings = TunerSettings { output_scale: Gains::ZERO, law, ..TunerSettings::literal() };
        let config = PidConfig::sampled_every(T);
        let (tuned, fixed) = (fspid(settings, config), pid(NOMINAL, config));
        let (mut state_tuned, mut state_fixed) = (State::new(), State::new());
        for sample in Random(3).samples(400) {
            let (tuned, fixed) =
                (tuned.step(&mut state_tuned, sample), fixed.step(&mut state_fixed, sample));
            assert_eq!(tuned.command_rad.to_bits(), fixed.command_rad.to_bits());
            assert_eq!(tuned, fixed);
        }
        assert_eq!(state_tuned, state_fixed);
    }
}

/// The commands of two controllers that differ in `ki` alone, at a zero error and with the memory
/// of a hundred samples at an error of 0.1 rad.
fn commands_before_and_after_a_change_of_ki(integral: IntegralForm) -> [f64; 2] {
    let config = PidConfig { integral, ..PidConfig::sampled_every(T) };
    let before = pid(NOMINAL, config);
    let after = pid(Gains { ki: 1.5, ..NOMINAL }, config);
    let mut state = State::new();
    for _ in 0..100 {
        before.step(&mut state, error(0.1));
    }
    [before, after].map(|controller| {
        let mut state = state;
        controller.step(&mut state, error(0.0)).command_rad
    })
}

#[test]
fn a_change_of_ki_alone_leaves_the_command_where_it_was() {
    let [before, after] = commands_before_and_after_a_change_of_ki(IntegralForm::Bumpless);
    assert_eq!(before.to_bits(), after.to_bits());
}

#[test]
fn the_literal_integral_makes_a_change_of_ki_jump_by_itself_times_the_integrated_error() {
    let [before, after] = commands_before_and_after_a_change_of_ki(IntegralForm::Literal);
    let jump = (1.5 - 0.5) * (100.0 * 0.1) * T;
    // The derivative takes both commands near -10, where each rounding is up to 9e-16.
    assert!((after - before - jump).abs() < 1e-14, "{before} {after}");
}

#[test]
fn the_isa_form_is_the_parallel_form_with_a_filter() {
    let gains = Gains::from_isa(2.0, 4.0, 0.5).expect("allowed");
    let (kp, ki, kd) = (2.0, 0.5, 1.0);
    assert_eq!(gains, Gains { kp, ki, kd });
    let filter_s = 0.5 / 8.0;
    assert_eq!(Derivative::from_isa(0.5, 8.0), Ok(Derivative { filter_s }));
    let no_integral = Gains::from_isa(2.0, f64::INFINITY, 0.5).expect("allowed");
    assert_eq!(no_integral, Gains { ki: 0.0, ..gains });
    let no_filter = Derivative { filter_s: 0.0 };
    assert_eq!(Derivative::from_isa(0.5, f64::INFINITY), Ok(no_filter));
}

/// The literal integral used to be the sum of e·T times ki, which differs from the definition
/// ki·Σe·T in the last digits: nobody could recompute a run to the bit.
#[test]
fn the_literal_integral_multiplies_in_the_order_of_its_definition() {
    let config = PidConfig { integral: IntegralForm::Literal, ..PidConfig::sampled_every(T) };
    let ki = 0.3;
    let controller = pid(Gains { ki, ..Gains::ZERO }, config);
    let (mut state, mut sum) = (State::new(), 0.0);
    for k in 0..1000 {
        let r = 0.1 + f64::from(k) * 1e-3;
        sum += r;
        let step = controller.step(&mut state, sample(r, 0.0, 0.0));
        assert_eq!(step.command_rad.to_bits(), (ki * sum * T).to_bits(), "sample {k}");
    }
}
