//! What each anti-windup promises, in both forms of the integral.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{NOMINAL, Random, T, error, integral_term, pid};
use fspid_core::{
    AntiWindup, ControllerSetting, Gains, IntegralForm, Limits, PidConfig, State, Step,
};
use proptest::prelude::*;

const FORMS: [IntegralForm; 2] = [IntegralForm::Bumpless, IntegralForm::Literal];
const ONLY_KI: Gains<f64> = Gains { kp: 0.0, ki: 0.5, kd: 0.0 };

fn limits(lower: f64, upper: f64) -> Limits<f64> {
    Limits::new(ControllerSetting::OutputLimits, lower, upper).expect("lower is below upper")
}

/// Command limits of one rad to both sides.
fn config(integral: IntegralForm, anti_windup: AntiWindup<f64>) -> PidConfig<f64> {
    PidConfig {
        integral,
        anti_windup,
        limits: Some(limits(-1.0, 1.0)),
        ..PidConfig::sampled_every(T)
    }
}

/// A memory whose integral term under [`ONLY_KI`] is `term_rad`, at a zero error.
fn wound_to(term_rad: f64, integral: IntegralForm) -> State<f64> {
    let bare = PidConfig { integral, ..PidConfig::sampled_every(T) };
    let (controller, mut state) = (pid(ONLY_KI, bare), State::new());
    controller.step(&mut state, error(term_rad / (ONLY_KI.ki * T)));
    controller.step(&mut state, error(0.0));
    state
}

#[test]
fn without_anti_windup_the_integral_winds_up_behind_the_limit() {
    for form in FORMS {
        let config = config(form, AntiWindup::None);
        let (controller, mut state) = (pid(ONLY_KI, config), State::new());
        for _ in 0..1000 {
            controller.step(&mut state, error(1.0));
        }
        // Ten seconds of an error of one: 0.5 · 10, after a thousand roundings below 1e-15 each.
        let term_rad = integral_term(&state, ONLY_KI.ki, config);
        assert!((term_rad - 5.0).abs() < 1e-12, "{form:?}: {term_rad}");
    }
}

#[test]
fn a_command_is_saturated_where_an_output_or_slew_limit_cut_it_to_either_side() {
    let (limited, mut slewed) =
        (config(IntegralForm::Bumpless, AntiWindup::None), PidConfig::sampled_every(T));
    slewed.slew_rad_s = Some(100.0);
    let only_kp = Gains { kp: 2.0, ..Gains::ZERO };
    for config in [limited, slewed] {
        for (error_rad, command_rad, saturated) in
            [(0.5, 1.0, false), (0.6, 1.0, true), (-0.5, -1.0, false), (-0.6, -1.0, true)]
        {
            let step = pid(only_kp, config).step(&mut State::new(), error(error_rad));
            assert_eq!((step.command_rad, step.saturated), (command_rad, saturated));
        }
    }
}

/// With no error the distance beyond the limit shrinks by (1 - T/Tt) a sample, which for T ≪ Tt is
/// a time constant of Tt.
#[test]
fn back_calculation_returns_to_the_limit_with_the_tracking_time_constant() {
    let tracking_s = 1.0;
    for form in FORMS {
        let config = config(form, AntiWindup::BackCalculation { tracking_s });
        let (controller, mut state) = (pid(ONLY_KI, config), wound_to(5.0, form));
        let mut beyond_rad = 4.0;
        for k in 1..=1000 {
            assert_eq!(controller.step(&mut state, error(0.0)).command_rad, 1.0);
            beyond_rad *= 1.0 - T / tracking_s;
            let found = integral_term(&state, ONLY_KI.ki, config) - 1.0;
            // A thousand samples, each with a few roundings of a number below 5.
            assert!((found - beyond_rad).abs() < 1e-12, "{form:?} {k}: {found} {beyond_rad}");
            if k == 100 {
                // One time constant; (1 - T/Tt)^(Tt/T) is below e^-1 by about T/(2 Tt) of it.
                let continuous = 4.0 / std::f64::consts::E;
                assert!((found / continuous - 1.0).abs() < 0.6 * T / tracking_s, "{found}");
            }
        }
    }
}

/// Under a lasting error e the integral comes to rest ki·e·Tt beyond the limit, before correction.
#[test]
fn back_calculation_rests_where_error_and_correction_balance() {
    let tracking_s = 0.5;
    for form in FORMS {
        let config = config(form, AntiWindup::BackCalculation { tracking_s });
        let (controller, mut state) = (pid(ONLY_KI, config), State::new());
        for _ in 0..5000 {
            controller.step(&mut state, error(0.8));
        }
        let beyond_rad = integral_term(&state, ONLY_KI.ki, config) - 1.0;
        let expected = ONLY_KI.ki * 0.8 * tracking_s * (1.0 - T / tracking_s);
        // (1 - T/Tt)^4000 is below 1e-35: only roundings are left.
        assert!((beyond_rad - expected).abs() < 1e-13, "{form:?}: {beyond_rad}");
    }
}

#[test]
fn back_calculation_within_one_period_takes_all_of_the_excess_back() {
    for form in FORMS {
        let config = config(form, AntiWindup::BackCalculation { tracking_s: T });
        let (controller, mut state) = (pid(ONLY_KI, config), wound_to(5.0, form));
        controller.step(&mut state, error(0.0));
        let term_rad = integral_term(&state, ONLY_KI.ki, config);
        assert!((term_rad - 1.0).abs() < 1e-15, "{form:?}: {term_rad}");
    }
}

/// A controller without integral action used to have its integral pulled, too, and kept the offset
/// for good: nothing brings an integral back whose gain is zero.
#[test]
fn back_calculation_leaves_a_controller_without_integral_action_alone() {
    for form in FORMS {
        let config = config(form, AntiWindup::BackCalculation { tracking_s: 0.1 });
        let (controller, mut state) =
            (pid(Gains { ki: 0.0, kd: 0.0, ..NOMINAL }, config), State::new());
        for _ in 0..100 {
            assert_eq!(controller.step(&mut state, error(3.0)).command_rad, 1.0);
        }
        assert_eq!(controller.step(&mut state, error(0.0)).command_rad, 0.0);
    }
}

/// The correction of the sum, which divides by ki·T, used to overflow: the memory stood still and
/// the command with it for as long as it was cut.
#[test]
fn back_calculation_of_a_sum_with_a_tiny_gain_still_answers() {
    let config = config(IntegralForm::Literal, AntiWindup::BackCalculation { tracking_s: 0.1 });
    let (controller, mut state) = (pid(Gains { ki: 1e-310, ..NOMINAL }, config), State::new());
    let step = controller.step(&mut state, error(3.0));
    assert_eq!(step.command_rad, 1.0);
    assert!(step.saturated && step.faults.is_empty(), "{step:?}");
}

#[test]
fn conditional_integration_stops_at_the_limit_and_turns_back_at_once() {
    for form in FORMS {
        let config = config(form, AntiWindup::Conditional);
        let (controller, mut state) = (pid(ONLY_KI, config), State::new());
        for _ in 0..1000 {
            controller.step(&mut state, error(1.0));
        }
        let term_rad = integral_term(&state, ONLY_KI.ki, config);
        // The last whole increment of 0.005 below the limit.
        assert!(term_rad <= 1.0 && term_rad > 0.995 - 1e-12, "{form:?}: {term_rad}");
        let step = controller.step(&mut state, error(-1.0));
        assert!(!step.saturated && step.command_rad < 1.0, "{form:?}: {step:?}");
    }
}

/// The direction used to be the sign of a product, which underflows to zero for small numbers: in
/// single precision an excess of 1e-25 rad let the integral go on outwards.
#[test]
fn conditional_integration_stops_for_the_smallest_excess() {
    let config = PidConfig {
        anti_windup: AntiWindup::Conditional,
        limits: Some(
            Limits::new(ControllerSetting::OutputLimits, -1.0, 1e-30)
                .expect("lower is below upper"),
        ),
        ..PidConfig::sampled_every(0.01_f32)
    };
    let only_ki = Gains { ki: 1.0, ..Gains::ZERO };
    let (controller, mut state) = (pid(only_ki, config), State::new());
    assert!(controller.step(&mut state, error(1e-23)).saturated);
    assert_eq!(integral_term(&state, 1.0, config), 0.0);
}

/// The direction is that of ki e: where this product underflows there is none, and the sum of the literal form takes
/// the error of a cut command. Its term, ki T times as much, is zero all the same.
#[test]
fn conditional_integration_lets_a_sum_grow_whose_drive_is_below_the_smallest_number() {
    let config = PidConfig {
        integral: IntegralForm::Literal,
        anti_windup: AntiWindup::Conditional,
        limits: Limits::new(ControllerSetting::OutputLimits, -1.0, 1e-30).ok(),
        ..PidConfig::sampled_every(0.01_f32)
    };
    let faint = Gains { kp: 1.0, ki: 1e-30, kd: 0.0 };
    let (controller, mut state) = (pid(faint, config), State::new());
    assert!(controller.step(&mut state, error(1e-20)).saturated);
    assert_eq!((state.integral(), integral_term(&state, faint.ki, config)), (1e-20, 0.0));
}

#[test]
fn clamping_bounds_the_integral_term_of_the_very_sample() {
    for form in FORMS {
        let config = config(form, AntiWindup::Clamping(limits(-0.1, 0.2)));
        let (controller, mut state) = (pid(ONLY_KI, config), State::new());
        // Each sample would move the term by 50: with bounds it is at one or the other.
        for (error_rad, bound_rad) in [(1e4, 0.2), (1e4, 0.2), (-1e4, -0.1), (1e4, 0.2)] {
            let step = controller.step(&mut state, error(error_rad));
            assert_eq!(step.command_rad, bound_rad, "{form:?}");
        }
    }
}

/// The flag used to tell of the command as it would have been with an unclamped integral.
#[test]
fn a_command_that_clamping_keeps_within_its_limits_is_not_saturated() {
    for form in FORMS {
        let config = config(form, AntiWindup::Clamping(limits(-0.1, 0.1)));
        let (controller, mut state) = (pid(ONLY_KI, config), State::new());
        let step = controller.step(&mut state, error(1e4));
        assert!(!step.saturated, "{form:?}: {step:?}");
    }
}

/// The clamped integral used to be reached by adding a difference, so that rounding left it beside
/// its limit, far beside after a large error: 50 + (0.1 - 50) is 0.1 + 1.5e-15.
#[test]
fn a_clamped_integral_is_exactly_its_limit() {
    let config = config(IntegralForm::Bumpless, AntiWindup::Clamping(limits(-0.1, 0.1)));
    let (controller, mut state) = (pid(ONLY_KI, config), State::new());
    controller.step(&mut state, error(1e4));
    assert_eq!(integral_term(&state, ONLY_KI.ki, config), 0.1);
}

fn anti_windups() -> impl Strategy<Value = AntiWindup<f64>> {
    prop_oneof![
        Just(AntiWindup::None),
        Just(AntiWindup::Clamping(limits(-0.4, 0.7))),
        Just(AntiWindup::Conditional),
        (T..5.0).prop_map(|tracking_s| AntiWindup::BackCalculation { tracking_s }),
    ]
}

fn forms() -> impl Strategy<Value = IntegralForm> {
    prop_oneof![Just(IntegralForm::Bumpless), Just(IntegralForm::Literal)]
}

proptest! {
    /// The law of conditional integration, for gains of either sign.
    #[test]
    fn conditional_integration_never_moves_the_integral_outwards(
        seed: u64, form in forms(), ki in -5.0..5.0,
    ) {
        let config = config(form, AntiWindup::Conditional);
        let controller = pid(Gains { ki, ..NOMINAL }, config);
        let (mut state, mut random) = (State::new(), Random(seed));
        for _ in 0..200 {
            let before = integral_term(&state, ki, config);
            let step = controller.step(&mut state, error(2.0 * random.signed()));
            let after = integral_term(&state, ki, config);
            if step.saturated {
                let outwards = if step.command_rad > 0.0 { after > before } else { after < before };
                prop_assert!(!outwards, "{before} {after} {step:?}");
            }
        }
    }

    #[test]
    fn a_clamped_integral_stays_within_its_limits(seed: u64, form in forms(), ki in -50.0..50.0) {
        let bounds = limits(-0.4, 0.7);
        let config = config(form, AntiWindup::Clamping(bounds));
        let controller = pid(Gains { ki, ..Gains::ZERO }, PidConfig { limits: None, ..config });
        let (mut state, mut random) = (State::new(), Random(seed));
        for _ in 0..200 {
            // Without other gains the command is the integral term.
            let term_rad = controller.step(&mut state, error(2.0 * random.signed())).command_rad;
            prop_assert_eq!(bounds.clamp(term_rad), term_rad);
            let kept_rad = integral_term(&state, ki, config);
            // The sum of the literal form is a quotient: one rounding more than the term.
            prop_assert!((bounds.clamp(kept_rad) - kept_rad).abs() < 1e-15, "{}", kept_rad);
        }
    }

    #[test]
    fn the_command_keeps_its_limits_and_its_slew_limit(
        seed: u64, anti_windup in anti_windups(), form in forms(),
        lower in -2.0..0.0, width in 1e-3..3.0, slew in prop::option::of(1e-2..100.0),
        size in prop::sample::select(vec![1e-9, 1e-4, 0.1, 1.0, 1e3, 1e7]),
    ) {
        let within = limits(lower, lower + width);
        let config = PidConfig {
            limits: Some(within),
            slew_rad_s: slew,
            rate_gain_s: 0.5,
            ..config(form, anti_windup)
        };
        let controller = pid(NOMINAL, config);
        let (mut state, mut random) = (State::new(), Random(seed));
        let mut last_rad = within.clamp(0.0);
        for _ in 0..200 {
            let sample = common::sample(size * random.signed(), size * random.signed(), random.signed());
            let Step { command_rad, .. } = controller.step(&mut state, sample);
            prop_assert!(within.lower() <= command_rad && command_rad <= within.upper());
            if let Some(slew) = slew && within.clamp(0.0) == 0.0 {
                // Two roundings of numbers below 3 in the limits, one here.
                prop_assert!((command_rad - last_rad).abs() <= slew * T + 1e-15);
            }
            last_rad = command_rad;
        }
    }
}
