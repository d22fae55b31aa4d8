//! Self-tuners that see something else than the change of the error, bend their inputs, or move more
//! than the gains: recomputed by their definitions.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{NOMINAL, Random, T, fspid, pid, sample, supervisor};
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{
    ConfigError, Faults, Fspid, GainCoupling, Gains, InputScale, InputSets, Law, PidConfig,
    ReferenceModel, Sample, SecondInput, SetCentres, State, TunerSettings,
};

const OUTPUT_SCALE: Gains<f64> = Gains { kp: 0.2, ki: 0.05, kd: 0.1 };
const INPUT_SCALE: InputScale<f64> = InputScale { error_per_rad: 40.0, change_per_rad: 11.0 };
const MODEL: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 1.5, damping: 0.8 };
const ALL: [SecondInput<f64>; 3] =
    [SecondInput::Change, SecondInput::Rate, SecondInput::ModelError(MODEL)];

fn settings(second_input: SecondInput<f64>) -> TunerSettings<f64> {
    TunerSettings {
        second_input,
        input_scale: INPUT_SCALE,
        output_scale: OUTPUT_SCALE,
        ..TunerSettings::literal()
    }
}

fn flown(controller: &Fspid<f64>, samples: &[Sample<f64>]) -> Vec<Gains<f64>> {
    let mut state = State::new();
    samples.iter().map(|&sample| controller.step(&mut state, sample).gains).collect()
}

/// The gains of the memoryless law for what is seen beside the error.
fn by_hand(sample: Sample<f64>, second: f64) -> Gains<f64> {
    let error = INPUT_SCALE.error_per_rad * (sample.setpoint_rad - sample.measurement_rad);
    let change = INPUT_SCALE.change_per_rad * second;
    let delta = supervisor::<f64>(OutOfRange::Clamp).infer(error, change).expect("finite").delta;
    Gains {
        kp: NOMINAL.kp + OUTPUT_SCALE.kp * delta.kp,
        ki: NOMINAL.ki + OUTPUT_SCALE.ki * delta.ki,
        kd: NOMINAL.kd + OUTPUT_SCALE.kd * delta.kd,
    }
}

#[test]
fn a_supervisor_that_sees_the_rate_is_asked_with_the_measured_rate_and_its_sign_turned() {
    let samples = Random(3).samples(400);
    let found = flown(&fspid(settings(SecondInput::Rate), PidConfig::sampled_every(T)), &samples);
    for (sample, found) in samples.iter().zip(found) {
        assert_eq!(found, by_hand(*sample, -sample.rate_rad_s));
    }
}

#[test]
fn a_supervisor_that_sees_a_model_is_asked_with_how_far_the_pitch_is_behind_it() {
    let samples: Vec<Sample<f64>> = Random(4).samples(400);
    let second_input = SecondInput::ModelError(MODEL);
    let found = flown(&fspid(settings(second_input), PidConfig::sampled_every(T)), &samples);
    // At rest at the first measurement; the set-point of a sample moves the model of the next.
    let (mut place, mut speed) = (samples[0].measurement_rad, 0.0);
    for (sample, found) in samples.iter().zip(found) {
        assert_eq!(found, by_hand(*sample, place - sample.measurement_rad));
        let ReferenceModel { bandwidth_rad_s: w, damping } = MODEL;
        speed += (w * w * (sample.setpoint_rad - place) - 2.0 * damping * w * speed) * T;
        place += speed * T;
    }
}

#[test]
fn a_reference_model_answers_a_step_as_the_differential_equation_does() {
    // Critically damped: y = 1 - (1 + wt) exp(-wt); the sampled model errs by the order of w T.
    let model = ReferenceModel { bandwidth_rad_s: 2.0, damping: 1.0 };
    let mut state = fspid_core::ModelState::at(0.0);
    for k in 0..500_u32 {
        let turned = 2.0 * f64::from(k) * T;
        let exact = 1.0 - (1.0 + turned) * libm::exp(-turned);
        assert!((state.pitch_rad - exact).abs() < 0.02, "{k}: {state:?} {exact}");
        state = model.next(state, 1.0, T);
    }
}

#[test]
fn rules_that_mirror_their_inputs_answer_steps_up_and_down_alike() {
    for second_input in ALL {
        let samples: Vec<Sample<f64>> = Random(5).samples(300);
        let mirrored: Vec<Sample<f64>> = samples
            .iter()
            .map(|s| sample(-s.setpoint_rad, -s.measurement_rad, -s.rate_rad_s))
            .collect();
        // An even surface: the printed rules asked for both signs.
        let sets = InputSets { error: SetCentres::new(0.2, 0.7).ok(), change: None };
        let tuned = TunerSettings { input_sets: sets, ..settings(second_input) };
        let (one, other) = (fspid(tuned, PidConfig::sampled_every(T)), {
            let turned = InputScale {
                error_per_rad: -INPUT_SCALE.error_per_rad,
                change_per_rad: -INPUT_SCALE.change_per_rad,
            };
            fspid(TunerSettings { input_scale: turned, ..tuned }, PidConfig::sampled_every(T))
        });
        assert_eq!(flown(&one, &samples), flown(&other, &mirrored), "{}", second_input.name());
    }
}

#[test]
fn what_follows_the_gains_acts_as_a_controller_with_other_weights_and_another_rate_loop() {
    let gain_coupling = GainCoupling { setpoint_weight: 0.3, rate_gain: 2.0 };
    let config = PidConfig { rate_gain_s: 0.4, ..PidConfig::sampled_every(T) };
    for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.5 }] {
        let tuned = TunerSettings { gain_coupling, law, ..settings(SecondInput::Rate) };
        let (controller, mut state) = (fspid(tuned, config), State::new());
        for sample in Random(6).samples(300) {
            let mut copy = state;
            let step = controller.step(&mut state, sample);
            let mut own = config;
            own.setpoint_weights.proportional += 0.3 * (step.gains.kp - NOMINAL.kp);
            own.rate_gain_s += 2.0 * (step.gains.kd - NOMINAL.kd);
            assert_eq!(controller.config_at(step.gains), own);
            let fixed = pid(step.gains, own).step(&mut copy, sample);
            assert_eq!(step.command_rad, fixed.command_rad);
        }
    }
}

#[test]
fn at_nominal_gains_nothing_has_followed_them() {
    let gain_coupling = GainCoupling { setpoint_weight: 0.3, rate_gain: 2.0 };
    let config = PidConfig { rate_gain_s: 0.4, ..PidConfig::sampled_every(T) };
    let tuned = TunerSettings { gain_coupling, ..settings(SecondInput::Change) };
    assert_eq!(fspid(tuned, config).config_at(NOMINAL), config);
}

#[test]
fn a_bent_input_reaches_the_even_sets_at_their_centres() {
    let places: SetCentres<f64> = SetCentres::new(0.1, 0.5).expect("in order");
    for (input, seen) in [(0.0, 0.0), (0.5, 5.0 / 3.0), (2.5, 10.0 / 3.0), (5.0, 5.0)] {
        for sign in [1.0, -1.0] {
            let warp = places.warp(sign * input, 5.0);
            assert!((warp - sign * seen).abs() < 1e-14, "{input}: {warp}");
        }
    }
    // Beyond the range nothing is bent, so that what is refused there still is.
    assert_eq!((places.warp(7.5, 5.0), places.warp(-7.5, 5.0)), (7.5, -7.5));
}

/// Straight from knot to knot: 0, the small centre, the medium one and the range go to its thirds.
#[test]
fn between_the_centres_an_input_is_bent_along_straight_lines() {
    for (small, medium, range) in [(0.1, 0.5, 5.0), (0.4, 0.9, 3.0), (0.25, 0.5, 1.0)] {
        let places: SetCentres<f64> = SetCentres::new(small, medium).expect("in order");
        let knots = [0.0, small * range, medium * range, range];
        for (n, ends) in knots.windows(2).enumerate() {
            for share in [0.125, 0.5, 0.75] {
                let input = ends[0] + share * (ends[1] - ends[0]);
                let seen = (n as f64 + share) * range / 3.0;
                let warp = places.warp(input, range);
                // A few roundings of numbers up to the range.
                assert!((warp - seen).abs() < 1e-15 * 4.0 * range, "{input}: {warp} {seen}");
            }
        }
    }
}

/// An export has its signs by the same comparison: a zero has no other bits there.
#[test]
fn a_zero_of_either_sign_is_bent_to_the_positive_one() {
    let places: SetCentres<f64> = SetCentres::new(0.1, 0.5).expect("in order");
    for zero in [0.0, -0.0] {
        assert_eq!(places.warp(zero, 5.0).to_bits(), 0.0_f64.to_bits());
    }
}

#[test]
fn bending_is_odd_and_increasing() {
    let mut random = Random(8);
    for _ in 0..200 {
        let small = 0.5 + 0.499 * random.signed();
        let medium = small + (1.0 - small) * (0.5 + 0.49 * random.signed());
        let places: SetCentres<f64> = SetCentres::new(small, medium).expect("in order");
        let mut last = -6.0;
        for k in -600..=600_i32 {
            let input = f64::from(k) * 0.01;
            let warp = places.warp(input, 5.0);
            assert!(warp >= last, "{small} {medium} {input}");
            assert_eq!(warp, -places.warp(-input, 5.0));
            last = warp;
        }
    }
}

#[test]
fn sets_that_are_not_in_order_are_refused() {
    let bad = [(0.0, 0.5), (0.5, 0.5), (0.6, 0.5), (0.5, 1.0), (-0.1, 0.5), (f64::NAN, 0.5)];
    for (small, medium) in bad.into_iter().chain([(0.5, f64::NAN), (0.5, f64::INFINITY)]) {
        let refused = SetCentres::new(small, medium);
        assert!(matches!(refused, Err(ConfigError::Number { .. })), "{small} {medium}");
    }
}

#[test]
fn a_model_that_the_sample_period_cannot_carry_is_refused() {
    let build = |bandwidth_rad_s: f64, damping: f64| {
        let second_input = SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping });
        Fspid::new(common::tuner(settings(second_input)), PidConfig::sampled_every(T))
    };
    assert!(build(50.0, 1.5).is_ok());
    for (bandwidth_rad_s, damping) in
        [(50.1, 1.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.6), (f64::NAN, 1.0), (1.0, f64::NAN)]
    {
        let refused = build(bandwidth_rad_s, damping);
        assert!(refused.is_err(), "{bandwidth_rad_s} {damping}");
    }
}

#[test]
fn the_fastest_and_most_damped_model_that_is_allowed_settles() {
    let model = ReferenceModel { bandwidth_rad_s: 50.0, damping: 1.5 };
    let mut state = fspid_core::ModelState::at(0.0);
    for _ in 0..2000 {
        state = model.next(state, 1.0, T);
    }
    assert!((state.pitch_rad - 1.0).abs() < 1e-12, "{state:?}");
}

#[test]
fn a_bad_sample_is_held_and_leaves_the_memory_as_it_was() {
    for second_input in ALL {
        let controller = fspid(settings(second_input), PidConfig::sampled_every(T));
        let mut state = State::new();
        for sample in Random(9).samples(20) {
            controller.step(&mut state, sample);
        }
        let before = state;
        for value in [f64::NAN, f64::INFINITY, 1e200] {
            for bad in [sample(value, 0.0, 0.0), sample(0.0, value, 0.0)] {
                let step = controller.step(&mut state, bad);
                assert_eq!(step.command_rad, before.command_rad);
                state.take_faults();
                assert_eq!(state, before, "{}", second_input.name());
            }
        }
    }
}

#[test]
fn a_bad_rate_is_at_fault_only_where_it_is_used() {
    let nan = sample(0.1, 0.0, f64::NAN);
    for (second_input, faulty) in ALL.into_iter().zip([false, true, false]) {
        let step =
            fspid(settings(second_input), PidConfig::sampled_every(T)).step(&mut State::new(), nan);
        assert_eq!(step.faults.contains(Faults::NOT_FINITE), faulty, "{}", second_input.name());
        let gain_coupling = GainCoupling { setpoint_weight: 0.0, rate_gain: 1.0 };
        let tuned = TunerSettings { gain_coupling, ..settings(second_input) };
        let step = fspid(tuned, PidConfig::sampled_every(T)).step(&mut State::new(), nan);
        assert!(step.faults.contains(Faults::NOT_FINITE), "{}", second_input.name());
    }
}

#[test]
fn a_controller_recovers_from_set_points_near_overflow() {
    let guard = fspid_core::Guard::new(1e290).expect("allowed");
    let config = PidConfig { guard, ..PidConfig::sampled_every(T) };
    let controller = fspid(settings(SecondInput::ModelError(MODEL)), config);
    let mut state = State::new();
    for far in [1e280, -1e290, 1e289] {
        controller.step(&mut state, sample(far, 0.0, 0.0));
    }
    state.take_faults();
    let step = controller.step(&mut state, sample(0.1, 0.0, 0.0));
    assert!(step.command_rad.is_finite());
    assert!(!step.faults.contains(Faults::OVERFLOW), "{:?}", step.faults);
}
