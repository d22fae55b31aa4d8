//! What a controller tells beside its answers: what the supervisor sees, what a command is made of, what is plain, and
//! the words of files.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{NOMINAL, Random, T, fspid, sample, supervisor};
use fspid_core::equations::{Memory, Parts};
use fspid_core::fuzzy::{Network, NumberTable, OutOfRange, Supervisor};
use fspid_core::{
    Change, DeadZone, Derivative, Fspid, GainCoupling, Gains, InputScale, InputSets, Law,
    PidConfig, ReferenceModel, Sample, SecondInput, SelfTuner, SetCentres, SetpointWeights, State,
    TunerSettings,
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

/// Scaled increments where the supervisor sees these, in its units.
fn scaled(error: f64, change: f64) -> Gains<f64> {
    let delta = supervisor::<f64>(OutOfRange::Clamp).infer(error, change).expect("finite").delta;
    Gains {
        kp: OUTPUT_SCALE.kp * delta.kp,
        ki: OUTPUT_SCALE.ki * delta.ki,
        kd: OUTPUT_SCALE.kd * delta.kd,
    }
}

fn memoryless([error_rad, second]: [f64; 2]) -> Gains<f64> {
    let added = scaled(INPUT_SCALE.error_per_rad * error_rad, INPUT_SCALE.change_per_rad * second);
    Gains { kp: NOMINAL.kp + added.kp, ki: NOMINAL.ki + added.ki, kd: NOMINAL.kd + added.kd }
}

/// Error and what stands beside it in a flight, by their definitions.
fn inputs_by_hand(
    samples: &[Sample<f64>],
    second_input: SecondInput<f64>,
    change: Change,
) -> Vec<[f64; 2]> {
    let ReferenceModel { bandwidth_rad_s: w, damping } = MODEL;
    // Before the first sample everything has stood for ever.
    let mut error_prev = samples[0].setpoint_rad - samples[0].measurement_rad;
    let (mut place, mut speed) = (samples[0].measurement_rad, 0.0);
    let mut inputs = Vec::new();
    for &Sample { setpoint_rad, measurement_rad, rate_rad_s } in samples {
        let error = setpoint_rad - measurement_rad;
        let second = match (second_input, change) {
            (SecondInput::Change, Change::Rate) => (error - error_prev) / T,
            (SecondInput::Change, Change::Delta) => error - error_prev,
            (SecondInput::Rate, _) => -rate_rad_s,
            (SecondInput::ModelError(_), _) => place - measurement_rad,
        };
        inputs.push([error, second]);
        error_prev = error;
        speed += (w * w * (setpoint_rad - place) - 2.0 * damping * w * speed) * T;
        place += speed * T;
    }
    inputs
}

#[test]
fn a_step_that_is_told_its_own_inputs_or_its_own_gains_is_that_step() {
    let samples = Random(11).samples(200);
    for second_input in ALL {
        for change in [Change::Rate, Change::Delta] {
            let settings = TunerSettings { change, ..settings(second_input) };
            let (controller, mut state) =
                (fspid(settings, PidConfig::sampled_every(T)), State::new());
            let expected = inputs_by_hand(&samples, second_input, change);
            for (&sample, expected) in samples.iter().zip(expected) {
                let inputs = controller.inputs(&state, sample).expect("a good sample");
                assert_eq!(inputs, expected, "{} {change:?}", second_input.name());
                let (mut seeing, mut at, mut other) = (state, state, state);
                let step = controller.step(&mut state, sample);
                assert_eq!(controller.step_seeing(&mut seeing, sample, inputs), step);
                assert_eq!(controller.step_at(&mut at, sample, step.gains), step);
                assert_eq!((seeing, at), (state, state));
                // Seeing something else, it has the gains of that.
                let elsewhere = [0.5 * inputs[0] + 0.01, 0.3 - inputs[1]];
                let step = controller.step_seeing(&mut other, sample, elsewhere);
                assert_eq!(step.gains, memoryless(elsewhere));
            }
        }
    }
}

#[test]
fn a_sample_that_a_step_would_hold_has_no_inputs() {
    let bad =
        [(f64::NAN, 0.0, 0.0), (0.0, f64::INFINITY, 0.0), (1e30, 0.0, 0.0), (0.0, 0.0, f64::NAN)];
    for second_input in ALL {
        let controller = fspid(settings(second_input), PidConfig::sampled_every(T));
        for (setpoint, measurement, rate) in bad {
            let sample = sample(setpoint, measurement, rate);
            let held = !controller.step(&mut State::new(), sample).faults.is_empty();
            assert_eq!(controller.inputs(&State::new(), sample).is_none(), held, "{sample:?}");
            // The last one is a good sample for who does not see the rate.
            assert!(held || second_input != SecondInput::Rate, "{sample:?}");
        }
    }
}

#[test]
fn increments_where_something_is_seen_are_those_of_the_rules_behind_their_factors() {
    let of = |input_sets, policy, dead_zone| {
        let settings = TunerSettings { input_sets, dead_zone, ..settings(SecondInput::Change) };
        SelfTuner::new(NOMINAL, supervisor(policy), settings).expect("allowed")
    };
    let places = SetCentres::new(0.2, 0.7).expect("in order");
    let uneven = InputSets { error: Some(places), change: None };
    // In the supervisor's own units, where neither factors nor a dead zone matter.
    let dead_zone = Some(DeadZone { error_rad: 10.0, change_rad: 10.0 });
    for (error, change) in [(0.0, 0.0), (1.0, -2.0), (-4.5, 0.3), (5.0, 5.0)] {
        let even = of(InputSets::EVEN, OutOfRange::Error, dead_zone);
        assert_eq!(even.increments_where_seen(error, change), Some(scaled(error, change)));
        let bent = of(uneven, OutOfRange::Error, None).increments_where_seen(error, change);
        assert_eq!(bent, Some(scaled(places.warp(error, 5.0), change)));
    }
    for (error, change) in [(5.1, 0.0), (0.0, -5.1), (f64::NAN, 0.0)] {
        let refusing = of(InputSets::EVEN, OutOfRange::Error, None);
        assert_eq!(refusing.increments_where_seen(error, change), None);
    }
}

/// Everything that makes a part: weights, filter, rate loop, feed-forward, and what follows the gains.
fn every_part(feedforward: f64, gain_coupling: GainCoupling<f64>) -> Fspid<f64> {
    let config = PidConfig {
        rate_gain_s: 0.4,
        setpoint_weights: SetpointWeights { proportional: 0.6, derivative: 0.3 },
        feedforward,
        derivative: Derivative { filter_s: 0.05 },
        ..PidConfig::sampled_every(T)
    };
    fspid(TunerSettings { gain_coupling, ..settings(SecondInput::Rate) }, config)
}

#[test]
fn a_command_is_made_of_its_parts_to_the_bit_and_each_is_its_definition() {
    let follows = GainCoupling { setpoint_weight: 0.3, rate_gain: 2.0 };
    for (feedforward, coupling) in
        [(0.7, follows), (0.0, follows), (0.7, GainCoupling::NONE), (0.0, GainCoupling::NONE)]
    {
        let controller = every_part(feedforward, coupling);
        let (equations, mut state) = (controller.equations(), State::new());
        let mut integral = 0.0;
        for (k, &sample) in Random(12).samples(200).iter().enumerate() {
            let memory: Memory<f64> =
                state.memory().unwrap_or_else(|| equations.at_first(&sample, &NOMINAL));
            let step = controller.step(&mut state, sample);
            let gains = step.gains;
            let parts = equations.parts(&equations.free(&memory, &sample, &gains), &sample, &gains);
            let Sample { setpoint_rad: r, measurement_rad: y, rate_rad_s: q } = sample;

            let weight = 0.6 + coupling.setpoint_weight * (gains.kp - NOMINAL.kp);
            assert_eq!(parts.proportional_rad, gains.kp * (weight * r - y), "sample {k}");
            integral += gains.ki * (r - y) * T;
            assert_eq!(parts.integral_rad, integral, "sample {k}");
            assert_eq!(parts.derivative_rad, gains.kd * state.derivative_rad_s(), "sample {k}");
            let rate_gain_s = 0.4 + coupling.rate_gain * (gains.kd - NOMINAL.kd);
            assert_eq!(parts.rate_rad, rate_gain_s * q, "sample {k}");
            assert_eq!(parts.fed_forward_rad, feedforward * r, "sample {k}");

            let Parts { proportional_rad, integral_rad, derivative_rad, rate_rad, fed_forward_rad } =
                parts;
            let sum = proportional_rad + integral_rad + derivative_rad - rate_rad;
            assert_eq!((sum + fed_forward_rad).to_bits(), step.command_rad.to_bits(), "{k}");
        }
    }
}

#[test]
fn plain_is_a_change_of_error_seen_through_even_sets_by_rules_of_labels_that_nothing_follows() {
    let places = SetCentres::new(0.2, 0.7).ok();
    let literal = TunerSettings::<f64>::literal();
    let sets = |error, change| TunerSettings { input_sets: InputSets { error, change }, ..literal };
    let follows = |setpoint_weight, rate_gain| TunerSettings {
        gain_coupling: GainCoupling { setpoint_weight, rate_gain },
        ..literal
    };
    let plain = [
        literal,
        TunerSettings {
            change: Change::Delta,
            law: Law::Accumulating { leakage_per_s: 0.5 },
            ..literal
        },
        TunerSettings { input_scale: INPUT_SCALE, output_scale: OUTPUT_SCALE, ..literal },
    ];
    let not_plain = [
        settings(SecondInput::Rate),
        settings(SecondInput::ModelError(MODEL)),
        sets(places, None),
        sets(None, places),
        sets(places, places),
        follows(0.3, 0.0),
        follows(0.0, 2.0),
    ];
    let told = plain.map(|settings| (settings, true)).into_iter();
    for (settings, plain) in told.chain(not_plain.map(|settings| (settings, false))) {
        assert_eq!(settings.is_plain(), plain, "{settings:?}");
        assert_eq!(common::tuner(settings).is_plain(), plain, "{settings:?}");
        let InputSets { error, change } = settings.input_sets;
        assert_eq!(settings.input_sets.are_even(), error.is_none() && change.is_none());
    }
    // The same settings around numbers or a network are not plain.
    let numbers = NumberTable::new([[[0.0; 7]; 7]; 3]).expect("finite");
    let network = Network::new([[0.0; 8]; 6]).expect("finite");
    let policy = OutOfRange::Clamp;
    for other in [
        Supervisor::of_numbers(&numbers, 5.0, policy),
        Supervisor::of_network(&network, 5.0, policy),
    ] {
        let tuner = SelfTuner::new(NOMINAL, other.expect("allowed"), literal).expect("allowed");
        assert!(tuner.settings().is_plain() && !tuner.is_plain());
    }
}

/// Scenarios and answers are full of them: a word that changes makes files of before unreadable.
#[test]
fn second_inputs_and_laws_are_called_in_files_as_ever() {
    assert_eq!(
        ALL.map(|input| (input.name(), input.beside())),
        [
            ("error-and-change", "change of error"),
            ("error-and-rate", "pitch rate, sign turned"),
            ("error-and-model-error", "error of the reference model"),
        ]
    );
    let laws = [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.0 }];
    assert_eq!(laws.map(|law| law.name()), ["memoryless", "accumulating"]);
}
