//! One bad sample does no harm: the output is held, the fault latched, the next good sample is
//! answered as if the bad one had not been.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]
#![allow(clippy::disallowed_methods, reason = "powers of two are exact everywhere")]

use crate::common;

use common::{NOMINAL, Random, T, error, fspid, gains, pid, sample, supervisor};
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{
    AntiWindup, ControllerSetting, Faults, Fspid, GainLimits, Gains, Guard, InputScale,
    IntegralForm, Law, Limits, Pid, PidConfig, Sample, SelfTuner, State, Step, TunerSettings,
};
use fspid_numeric::Real;

/// Every feature at once: rate loop, filter, limits, slew, back-calculation.
fn full_config<R: Real>(integral: IntegralForm) -> PidConfig<R> {
    let number = R::from_f64;
    let mut config = PidConfig::sampled_every(number(T));
    config.rate_gain_s = number(0.3);
    config.derivative.filter_s = number(0.05);
    config.integral = integral;
    config.anti_windup = AntiWindup::BackCalculation { tracking_s: number(1.0) };
    config.limits = Limits::new(ControllerSetting::OutputLimits, number(-0.5), number(0.5)).ok();
    config.slew_rad_s = Some(number(20.0));
    config
}

fn accumulating<R: Real>() -> TunerSettings<R> {
    let leakage_per_s = R::from_f64(0.1);
    TunerSettings { law: Law::Accumulating { leakage_per_s }, ..TunerSettings::literal() }
}

/// Either controller, to run the same test on both.
enum Controller<R> {
    Fixed(Pid<R>),
    Tuned(Box<Fspid<R>>),
}

impl<R: Real> Controller<R> {
    fn all(config: PidConfig<R>) -> [Self; 3] {
        [
            Self::Fixed(pid(gains(NOMINAL), config)),
            Self::Tuned(Box::new(fspid(TunerSettings::literal(), config))),
            Self::Tuned(Box::new(fspid(accumulating(), config))),
        ]
    }

    fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        match self {
            Self::Fixed(pid) => pid.step(state, sample),
            Self::Tuned(fspid) => fspid.step(state, sample),
        }
    }
}

/// The sample with `value` in its set-point, measurement or rate.
fn with<R>(sample: Sample<R>, place: usize, value: R) -> Sample<R> {
    match place {
        0 => Sample { setpoint_rad: value, ..sample },
        1 => Sample { measurement_rad: value, ..sample },
        _ => Sample { rate_rad_s: value, ..sample },
    }
}

fn one_bad_sample<R: Real>(bad: &[(R, Faults)]) {
    for form in [IntegralForm::Bumpless, IntegralForm::Literal] {
        for controller in Controller::all(full_config::<R>(form)) {
            for before in [0, 1, 60] {
                for place in 0..3 {
                    for &(value, fault) in bad {
                        let samples: Vec<Sample<R>> = Random(4).samples(before + 5);
                        let mut state = State::new();
                        let mut last = R::ZERO;
                        for &sample in &samples[..before] {
                            last = controller.step(&mut state, sample).command_rad;
                        }
                        let mut undisturbed = state;

                        let held = controller.step(&mut state, with(samples[before], place, value));
                        assert_eq!(held.command_rad.to_f64().to_bits(), last.to_f64().to_bits());
                        assert_eq!(held.faults, fault, "{value} in place {place}");

                        for &sample in &samples[before..] {
                            let (ours, theirs) = (
                                controller.step(&mut state, sample),
                                controller.step(&mut undisturbed, sample),
                            );
                            assert_eq!(
                                ours.command_rad.to_f64().to_bits(),
                                theirs.command_rad.to_f64().to_bits()
                            );
                            assert_eq!(ours.gains, theirs.gains);
                            assert_eq!(ours.faults, fault, "latched until it is taken");
                        }
                        assert_eq!(state.take_faults(), fault);
                        assert_eq!(state, undisturbed);
                    }
                }
            }
        }
    }
}

#[test]
fn one_bad_sample_holds_the_output_and_the_next_good_one_is_answered_normally() {
    one_bad_sample(&[
        (f64::NAN, Faults::NOT_FINITE),
        (-f64::NAN, Faults::NOT_FINITE),
        (f64::INFINITY, Faults::NOT_FINITE),
        (f64::NEG_INFINITY, Faults::NOT_FINITE),
        (3e38, Faults::IMPLAUSIBLE),
        (-3e38, Faults::IMPLAUSIBLE),
        (f64::MAX, Faults::IMPLAUSIBLE),
        (f64::MIN, Faults::IMPLAUSIBLE),
    ]);
    one_bad_sample(&[
        (f32::NAN, Faults::NOT_FINITE),
        (f32::INFINITY, Faults::NOT_FINITE),
        (f32::NEG_INFINITY, Faults::NOT_FINITE),
        (3e38, Faults::IMPLAUSIBLE),
        (f32::MIN, Faults::IMPLAUSIBLE),
    ]);
}

/// A denormal is a good sample: answered as zero but for its own size.
#[test]
fn a_denormal_sample_is_a_good_one() {
    for controller in Controller::all(full_config::<f64>(IntegralForm::Bumpless)) {
        for place in 0..3 {
            let (mut state, mut at_zero) = (State::new(), State::new());
            let sample = sample(0.01, 0.02, 0.03);
            let tiny = controller.step(&mut state, with(sample, place, 5e-324));
            let zero = controller.step(&mut at_zero, with(sample, place, 0.0));
            assert!(tiny.faults.is_empty());
            assert_eq!(tiny.command_rad.to_bits(), zero.command_rad.to_bits());
        }
    }
}

/// The rate of a controller without a rate loop used to reach the command as 0 · NaN, and the
/// sample was held as an overflow.
#[test]
fn a_rate_that_is_not_used_cannot_be_at_fault() {
    for controller in Controller::all(PidConfig::sampled_every(T)) {
        for rate in [f64::NAN, f64::INFINITY, 3e38, f64::MAX] {
            let (mut state, mut at_zero) = (State::new(), State::new());
            let step = controller.step(&mut state, sample(0.1, 0.0, rate));
            assert_eq!(step, controller.step(&mut at_zero, sample(0.1, 0.0, 0.0)));
            assert!(step.faults.is_empty());
        }
    }
}

/// A command that overflowed used to be answered with the limit, and the memory moved on.
#[test]
fn an_overflow_is_held_even_where_a_limit_would_hide_it() {
    let mut config = full_config::<f32>(IntegralForm::Bumpless);
    config.guard = Guard::new(3e38).expect("finite");
    let huge = pid(Gains { kp: 2e37, ..gains(NOMINAL) }, config);
    let mut state = State::new();
    let last = huge.step(&mut state, error(1e-38));
    let before = state;
    let held = huge.step(&mut state, error(100.0));
    assert_eq!(held.command_rad.to_bits(), last.command_rad.to_bits());
    assert_eq!(held.faults, Faults::OVERFLOW);
    state.take_faults();
    assert_eq!(state, before);
}

/// A finite but huge sample within a guard as wide as the number type used to be taken into the
/// memory, from where the change to any other sample overflowed: the output was held for ever.
#[test]
fn a_huge_sample_within_the_guard_does_not_lock_the_controller() {
    for form in [IntegralForm::Bumpless, IntegralForm::Literal] {
        let (plain, mut dead_beat) = (PidConfig::sampled_every(0.01_f32), full_config(form));
        dead_beat.derivative.filter_s = 0.0;
        dead_beat.anti_windup = AntiWindup::BackCalculation { tracking_s: 0.01 };
        let mut fast = PidConfig::sampled_every(1e-12_f32);
        // The error and what the derivative acts on are then different numbers.
        fast.setpoint_weights.derivative = 0.0;
        for mut config in [plain, full_config(form), dead_beat, fast] {
            (config.integral, config.guard) = (form, Guard::new(3e38).expect("finite"));
            let strong = Gains { kp: 1e9, ki: 1e9, kd: 1e9 };
            let input_scale = InputScale { error_per_rad: 1e9, change_per_rad: 1e9 };
            let keen = TunerSettings { input_scale, ..TunerSettings::literal() };
            let extreme = [
                Controller::Fixed(pid(strong, config)),
                Controller::Tuned(Box::new(fspid(keen, config))),
            ];
            for controller in Controller::all(config).iter().chain(&extreme) {
                // Every power of two up to 2^127, as an error and as an attitude that is commanded
                // and measured, at the first sample and after a good one.
                for n in 0..128_u32 {
                    let huge = 2_f32.powi(n.cast_signed());
                    let attitude = with(error(huge), 1, huge);
                    for (sample, before) in
                        [(error(huge), 0), (error(huge), 1), (attitude, 0), (attitude, 1)]
                    {
                        let mut state = State::new();
                        for _ in 0..before {
                            controller.step(&mut state, error(0.1));
                        }
                        controller.step(&mut state, sample);
                        state.take_faults();
                        let step = controller.step(&mut state, error(0.1));
                        assert!(step.faults.is_empty(), "2^{n}: {step:?} {config:?}");
                    }
                }
            }
        }
    }
}

/// The gains of the moment were told, which nothing remembers and no export knows.
#[test]
fn a_first_sample_that_overflows_is_answered_with_the_nominal_gains() {
    for controller in Controller::all(PidConfig::sampled_every(T)) {
        let mut state = State { integral: f64::MAX, ..State::new() };
        let held = controller.step(&mut state, sample(0.1, 0.02, 0.0));
        assert_eq!(held.faults, Faults::OVERFLOW);
        assert_eq!(held.gains, gains(NOMINAL));
    }
}

/// Gain limits used to turn an overflow of the gains into a number.
#[test]
fn gains_that_overflow_are_held_even_where_their_limits_would_hide_it() {
    let wide =
        Limits::new(ControllerSetting::GainLimits, -10.0, 10.0).expect("lower is below upper");
    let settings = TunerSettings {
        output_scale: Gains { kp: f64::MAX, ki: 0.0, kd: 0.0 },
        gain_limits: Some(GainLimits { kp: wide, ki: wide, kd: wide }),
        ..TunerSettings::literal()
    };
    let (controller, mut state) = (fspid(settings, PidConfig::sampled_every(T)), State::new());
    let held = controller.step(&mut state, error(3.0));
    assert_eq!((held.command_rad, held.gains), (0.0, NOMINAL));
    assert_eq!(held.faults, Faults::OVERFLOW);
}

/// A scaled error that overflowed used to be called out of range and answered with stale gains,
/// even by a supervisor that clamps.
#[test]
fn a_supervisor_input_that_overflows_holds_the_output() {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: f64::MAX, change_per_rad: 1.0 },
        ..TunerSettings::literal()
    };
    let (controller, mut state) = (fspid(settings, PidConfig::sampled_every(T)), State::new());
    let held = controller.step(&mut state, error(3.0));
    assert_eq!((held.command_rad, held.faults), (0.0, Faults::OVERFLOW));
    assert!(controller.step(&mut state, error(0.5)).command_rad != 0.0);
}

#[test]
fn a_supervisor_that_refuses_an_input_keeps_the_gains_and_the_loop_closed() {
    let tuner = SelfTuner::new(NOMINAL, supervisor(OutOfRange::Error), TunerSettings::literal());
    let config = PidConfig::sampled_every(T);
    let controller = Fspid::new(tuner.expect("allowed"), config).expect("allowed");
    let mut state = State::new();
    let inside = controller.step(&mut state, error(1.0));
    assert!(inside.gains != NOMINAL && inside.faults.is_empty());
    let outside = controller.step(&mut state, error(5.5));
    assert_eq!(outside.gains, inside.gains);
    assert_eq!(outside.faults, Faults::OUT_OF_RANGE);
    assert!(outside.command_rad > inside.command_rad);
}

#[test]
fn a_supervisor_whose_rules_underflow_says_so_and_answers_as_clamped() {
    let config = PidConfig::sampled_every(T);
    let answers = [OutOfRange::Evaluate, OutOfRange::Clamp].map(|policy| {
        let tuner = SelfTuner::new(NOMINAL, supervisor(policy), TunerSettings::literal());
        let controller = Fspid::new(tuner.expect("allowed"), config).expect("allowed");
        controller.step(&mut State::new(), error(1e3))
    });
    let [evaluated, clamped] = answers;
    assert_eq!(evaluated.faults, Faults::UNDERFLOW);
    assert_eq!(clamped.faults, Faults::NONE);
    assert_eq!(evaluated.gains, clamped.gains);
}

/// The held command of a fresh memory used to be 0 even where the limits exclude it.
#[test]
fn a_bad_first_sample_is_answered_within_the_limits() {
    let mut config = PidConfig::sampled_every(T);
    config.limits = Limits::new(ControllerSetting::OutputLimits, 0.1, 0.2).ok();
    let held = pid(NOMINAL, config).step(&mut State::new(), error(f64::NAN));
    assert_eq!(held.command_rad, 0.1);
}

#[test]
fn faults_add_up_and_name_themselves() {
    let (controller, mut state) = (pid(NOMINAL, PidConfig::sampled_every(T)), State::new());
    controller.step(&mut state, error(f64::NAN));
    let step = controller.step(&mut state, error(3e38));
    assert!(step.faults.contains(Faults::NOT_FINITE) && step.faults.contains(Faults::IMPLAUSIBLE));
    assert_eq!(step.faults.to_string(), "sample not finite, sample beyond the guard");
    assert_eq!(step.faults.bits(), 3);
    assert_eq!(state.take_faults(), step.faults);
    assert_eq!(state.take_faults().to_string(), "none");
}

/// Feeds samples of random bits, every fourth of them a plausible one, and checks every answer.
fn random_bits<R: Real>(guard: R, runs: u32, from_bits: impl Fn(u64) -> R) {
    for form in [IntegralForm::Bumpless, IntegralForm::Literal] {
        let mut config = full_config::<R>(form);
        config.guard = Guard::new(guard).expect("finite and positive");
        let mut unlimited = config;
        (unlimited.limits, unlimited.slew_rad_s) = (None, None);
        unlimited.anti_windup = AntiWindup::None;
        for (n, controller) in
            Controller::all(config).iter().chain(&Controller::all(unlimited)).enumerate()
        {
            let (mut state, mut random) = (State::new(), Random(5));
            let mut answered = 0;
            for k in 0..runs {
                let mut number = || {
                    if k % 4 == 0 { R::from_f64(random.signed()) } else { from_bits(random.bits()) }
                };
                let sample = Sample {
                    setpoint_rad: number(),
                    measurement_rad: number(),
                    rate_rad_s: number(),
                };
                let before = state;
                let step = controller.step(&mut state, sample);
                assert!(step.command_rad.is_finite(), "{sample:?} {step:?}");
                assert!(
                    step.gains.kp.is_finite()
                        && step.gains.ki.is_finite()
                        && step.gains.kd.is_finite()
                );
                if n < 3 {
                    assert!(step.command_rad.abs() <= R::HALF, "{sample:?} {step:?}");
                }
                if state.take_faults().is_empty() {
                    answered += 1;
                } else {
                    assert_eq!(state, before, "{sample:?}");
                }
            }
            assert!(answered >= runs / 4, "{answered} of {runs}");
        }
    }
}

/// Samples in each of the twelve runs below: more than two million in all.
const RUNS: u32 = 180_000;

#[test]
fn no_bit_pattern_makes_a_command_that_is_not_finite() {
    random_bits(Guard::<f64>::new(1e300).map(|_| 1e300).expect("finite"), RUNS, f64::from_bits);
}

#[test]
fn no_bit_pattern_makes_a_single_precision_command_that_is_not_finite() {
    random_bits(3e38, RUNS, |bits| f32::from_bits((bits >> 32) as u32));
}
