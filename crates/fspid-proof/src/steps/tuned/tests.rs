//! Bounds of gains that remember hold what the law makes of them.

use fspid_core::fuzzy::{OutOfRange, Supervisor};
use fspid_core::{
    Change, ControllerSetting, DeadZone, ErrorSign, GainLimits, Gains, InputScale, Law, Limits,
    ModelState, PidConfig, ReferenceModel, SecondInput, SelfTuner, TunerSettings,
};
use fspid_fuzzy::NumberTable;

use super::*;
use crate::gain_set::producible;
use crate::rest::drawn::Dice;

const DT_S: f64 = 0.02;
const RANGE: f64 = 5.0;
const MODEL: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 2.4, damping: 0.58 };

fn settings() -> TunerSettings<f64> {
    TunerSettings {
        input_scale: InputScale { error_per_rad: 40.0, change_per_rad: 8.0 },
        output_scale: Gains { kp: 0.2, ki: 0.05, kd: 0.1 },
        law: Law::Accumulating { leakage_per_s: 0.6 },
        ..TunerSettings::literal()
    }
}

/// Rules that conclude numbers, which rise with both inputs.
pub(in crate::steps) fn numbers() -> Supervisor<f64> {
    let grid = |by_error: f64, by_second: f64| {
        core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                let [e, c] = [row, column].map(|step: usize| step as f64 - 3.0);
                by_error * e + by_second * c + 0.1 * (e * c + 2.0)
            })
        })
    };
    let table = NumberTable::new([grid(0.7, 0.4), grid(-0.5, 0.8), grid(0.3, -0.6)]);
    let table = table.expect("numbers");
    Supervisor::of_numbers(&table, RANGE, OutOfRange::Clamp).expect("allowed")
}

fn fspid(settings: TunerSettings<f64>) -> Fspid<f64> {
    of(numbers(), settings)
}

fn of(supervisor: Supervisor<f64>, settings: TunerSettings<f64>) -> Fspid<f64> {
    let nominal = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
    let tuner = SelfTuner::new(nominal, supervisor, settings).expect("allowed");
    Fspid::new(tuner, PidConfig::sampled_every(DT_S)).expect("allowed")
}

/// kp is cut from above, ki from below.
fn limits() -> GainLimits<f64> {
    let between =
        |lower, upper| Limits::new(ControllerSetting::GainLimits, lower, upper).expect("in order");
    GainLimits { kp: between(0.5, 2.1), ki: between(0.45, 9.0), kd: between(-9.0, 9.0) }
}

/// What a supervisor sees beside the error: a change per second or per sample, or a model.
fn kinds() -> [TunerSettings<f64>; 4] {
    let delta = TunerSettings { change: Change::Delta, ..settings() };
    let second_input = SecondInput::ModelError(MODEL);
    let error_sign = ErrorSign::MeasurementMinusSetpoint;
    [
        settings(),
        delta,
        TunerSettings { second_input, ..settings() },
        TunerSettings { gain_limits: Some(limits()), error_sign, ..settings() },
    ]
}

#[test]
fn gains_that_leak_and_see_a_change_or_a_model_are_followed_and_no_others() {
    let is_followed = |settings: TunerSettings<f64>| Tuner::of(&fspid(settings)).is_some();
    for settings in kinds() {
        assert!(is_followed(settings), "{settings:?}");
    }
    let still = Law::Accumulating { leakage_per_s: 0.0 };
    let zone = Some(DeadZone { error_rad: 0.0, change_rad: 0.0 });
    for settings in [
        TunerSettings { law: Law::Memoryless, ..settings() },
        TunerSettings { law: still, gain_limits: Some(limits()), ..settings() },
        TunerSettings { second_input: SecondInput::Rate, ..settings() },
        TunerSettings { dead_zone: zone, ..settings() },
    ] {
        assert!(!is_followed(settings), "{settings:?}");
    }
    let labels = fspid_core::paper::rules();
    let rule = fspid_core::fuzzy::Defuzzifier::Exact;
    let labels = Supervisor::new(&labels, RANGE, rule, OutOfRange::Clamp).expect("allowed");
    assert!(Tuner::of(&of(labels, settings())).is_none());
}

#[test]
fn after_a_rest_hardly_anything_is_left_of_the_way_that_gains_had_to_go() {
    for leakage_per_s in [0.01, 0.6, 20.0, 40.0, 50.0] {
        let law = Law::Accumulating { leakage_per_s };
        let fspid = fspid(TunerSettings { law, ..settings() });
        let tuner = Tuner::of(&fspid).expect("followed");
        let samples = (tuner.rests_s() / DT_S).round();
        assert!((samples * DT_S - tuner.rests_s()).abs() < 1e-9 * tuner.rests_s());
        let left = |samples: f64| libm::pow(1.0 - leakage_per_s * DT_S, samples);
        // One sample more than that is for rounding.
        assert!(left(samples - 0.999) <= LEFT, "{leakage_per_s}: {samples}");
        if leakage_per_s * DT_S <= 0.5 {
            assert!(left(samples - 2.001) > LEFT, "{leakage_per_s}: {samples} are too many");
        }
    }
}

/// Error and what is seen beside it, at the ends of their sizes and between.
fn shown(dice: &mut Dice, [error, second]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut all = vec![[error, second], [-error, -second], [error, -second], [-error, second]];
    all.extend([0; 60].map(|_| [dice.between(-error, error), dice.between(-second, second)]));
    all
}

/// Where gains tend to while the tuner is shown the same.
fn settled(fspid: &Fspid<f64>, [error_rad, second_rad]: [f64; 2]) -> [f64; 3] {
    let [error, second] = fspid.tuner_equations().seen(error_rad, second_rad);
    let Gains { kp, ki, kd } = producible(fspid.tuner(), error, second);
    [kp, ki, kd]
}

#[test]
fn gains_tend_to_where_it_is_said_while_inputs_keep_to_their_sizes() {
    let dice = &mut Dice::new(1);
    for settings in kinds() {
        let fspid = fspid(settings);
        let tuner = Tuner::of(&fspid).expect("followed");
        for sizes in [[0.002, 0.01], [0.05, 0.02], [0.01, 0.3], [0.3, 2.0], [0.0, 0.0]] {
            let targets = tuner.targets(sizes);
            let mut met: [Option<Interval>; 3] = [None; 3];
            for inputs in shown(dice, sizes) {
                for (gain, to) in settled(&fspid, inputs).into_iter().enumerate() {
                    assert!(targets[gain].contains(to), "{sizes:?} {inputs:?}: {to} {targets:?}");
                    let to = Interval::point(to);
                    met[gain] = Some(met[gain].map_or(to, |before| before.hull(to)));
                }
            }
            for (met, target) in met.into_iter().zip(targets) {
                let met = met.expect("some").width();
                assert!(target.width() <= 1.1 * met + 1e-9, "{sizes:?}: {target:?} of {met}");
            }
        }
    }
}

#[test]
fn gains_are_kept_in_a_box_that_holds_where_they_tend_to_and_lies_within_their_limits() {
    let seen = [0.02, 0.1];
    for settings in kinds() {
        let fspid = fspid(settings);
        let tuner = Tuner::of(&fspid).expect("followed");
        let targets = tuner.targets(seen);
        assert!(tuner.keeps(targets, seen));
        assert!(!tuner.keeps(targets, seen.map(|size| 1.1 * size)), "of larger inputs");
        for gain in 0..3 {
            let side = targets[gain];
            let cut = 0.01 * side.width();
            for (least, most) in [(cut, 0.0), (0.0, cut)] {
                let mut gains = targets;
                gains[gain] = Interval::between(side.lower() + least, side.upper() - most);
                assert!(!tuner.keeps(gains, seen), "gain {gain}");
            }
        }
    }
    let fspid = fspid(TunerSettings { gain_limits: Some(limits()), ..settings() });
    let tuner = Tuner::of(&fspid).expect("followed");
    let targets = tuner.targets(seen);
    let limits = [(0.5, 2.1), (0.45, 9.0), (-9.0, 9.0)];
    let whole = limits.map(|(least, most)| Interval::between(least, most));
    assert!(tuner.keeps(whole, seen));
    for gain in 0..3 {
        let (least, most) = limits[gain];
        for (lower, upper) in [(least - 0.01, most), (least, most + 0.01)] {
            let mut gains = targets;
            gains[gain] = Interval::between(lower, upper);
            assert!(!tuner.keeps(gains, seen), "gain {gain} beyond its limits");
        }
    }
}

/// The gains after a sample at which everything is known.
fn after(tuner: &Tuner<'_>, gains: [f64; 3], [error, change, pitch]: [f64; 3]) -> Tuned {
    let constant = |value: f64| Affine::constant(Interval::point(value));
    let now = Tuned { gains: gains.map(constant), model: [constant(0.05), constant(0.0)] };
    let [error, change, pitch, setpoint] = [error, change, pitch, error + pitch].map(constant);
    let shown = Shown { error: &error, change: &change, pitch: &pitch, setpoint: &setpoint };
    let mut symbols = 0;
    tuner.after(&now, &shown, &mut || {
        symbols += 1;
        symbols - 1
    })
}

#[test]
fn gains_after_a_sample_that_is_known_are_those_of_the_law_and_hardly_more() {
    let dice = &mut Dice::new(2);
    for settings in kinds() {
        let fspid = fspid(settings);
        let tuner = Tuner::of(&fspid).expect("followed");
        let equations = fspid.tuner_equations();
        for _ in 0..200 {
            let gains = [dice.between(1.0, 2.1), dice.between(0.45, 0.8), dice.between(0.5, 1.5)];
            let [error, change] = [dice.between(-0.2, 0.2), dice.between(-0.01, 0.01)];
            let pitch = dice.between(-0.2, 0.2);
            let second = match equations.structure.second_input {
                SecondInputKind::ModelError => 0.05 - pitch,
                _ => change / equations.numbers.change_divisor,
            };
            let [error_seen, second_seen] = equations.seen(error, second);
            let added = fspid.tuner().increments_where_seen(error_seen, second_seen);
            let added = added.expect("clamped");
            let found = after(&tuner, gains, [error, change, pitch]);
            for (gain, scaled) in [added.kp, added.ki, added.kd].into_iter().enumerate() {
                let own = &equations.gains[gain];
                let next = own.limited(equations.free_gain(own, gains[gain], scaled));
                let range = found.gains[gain].range();
                let slack = Interval::between(-1e-15, 1e-15);
                assert!((range + slack).contains(next), "gain {gain}: {next} {range:?}");
                assert!(range.width() < 1e-9, "gain {gain}: {range:?}");
            }
        }
    }
}

#[test]
fn a_reference_model_goes_no_further_from_its_set_point_than_is_said_of_it() {
    let second_input = SecondInput::ModelError(MODEL);
    let fspid = fspid(TunerSettings { second_input, ..settings() });
    let tuner = Tuner::of(&fspid).expect("followed");
    let constant = |value: f64| Affine::constant(Interval::point(value));
    for setpoint in [0.0, 0.1] {
        for [pitch, rate] in [[0.1, 0.0], [0.02, 0.3], [0.02, -0.3], [-0.2, 0.01], [0.0, 0.0]] {
            let gains = [1.0, 1.0, 1.0].map(constant);
            let now = Tuned { gains, model: [constant(pitch), constant(rate)] };
            let told = tuner.model_later(&now, &constant(setpoint));
            let mut model = ModelState { pitch_rad: pitch, rate_rad_s: rate };
            let mut most = 0.0_f64;
            for _ in 0..2000 {
                most = most.max((model.pitch_rad - setpoint).abs());
                model = MODEL.next(model, setpoint, DT_S);
            }
            // Where place and rate work together the two are a third apart at most.
            let least = (pitch - setpoint).abs().max(rate.abs() / MODEL.bandwidth_rad_s);
            assert!(told >= most && told < 1.6 * least + 1e-9, "{pitch} {rate}: {told} {most}");
        }
    }
    let changes = self::fspid(settings());
    let without = Tuner { later: 1.0, ..Tuner::of(&changes).expect("followed") };
    let now = Tuned { gains: [1.0; 3].map(constant), model: [constant(0.1), constant(0.1)] };
    assert!(without.model_later(&now, &constant(0.0)).abs() <= 0.0);
}

#[test]
fn what_is_seen_beside_the_error_is_a_change_per_second_or_per_sample_or_that_of_a_model() {
    let divisors = kinds().map(|settings| {
        let fspid = fspid(settings);
        Tuner::of(&fspid).expect("followed").change_divisor().map(f64::to_bits)
    });
    let bits = |value: f64| Some(value.to_bits());
    assert_eq!(divisors, [bits(DT_S), bits(1.0), None, bits(DT_S)]);
}
