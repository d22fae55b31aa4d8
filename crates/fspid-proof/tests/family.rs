//! Plants and actuators between bounds, proved at once.

use fspid_core::{Derivative, Gains, Pid, PidConfig};
use fspid_lti::{Matrix, spectral_radius};
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{ContinuousPlant, LagOf, NotProved, PlantSet, Sloped};
use fspid_proof::{
    Asked, Certificate, Effort, Family, FamilyVerdict, LoopDescription, Parameter, ScaledSensor,
    Verdict, certify, numbers, prove_family,
};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::{LoopModel, SampledPlant, Sensing};
use fspid_sim::{Controller, ElevatorSign};

const NUMERATOR: [f64; 3] = [-1.69144, -0.84341, -0.0099096];
const DENOMINATOR: [f64; 5] = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771];
/// Effectiveness, damping and stiffness as factors, the servo's time constant, s.
const NAMES: [&str; 4] = ["effect", "damping", "stiffness", "lag"];

fn parameters(ends: [[f64; 2]; 4]) -> Vec<Parameter> {
    let parameter = |(name, ends): (&str, [f64; 2])| Parameter {
        name: name.to_owned(),
        paths: vec![name.to_owned()],
        relative: name != "lag",
        inverse: name == "lag",
        sensors: Vec::new(),
        ends,
    };
    NAMES.into_iter().zip(ends).map(parameter).collect()
}

/// The paper's 747 behind its servo.
fn plant(at: &[Sloped]) -> Result<ContinuousPlant<Sloped>, NotProved> {
    let [effect, damping, stiffness, bandwidth] = *at else { panic!("four parameters") };
    let point = |value| Sloped::fixed(Interval::point(value));
    let numerator = NUMERATOR.map(|it| point(it) * effect);
    let mut denominator = DENOMINATOR.map(point);
    denominator[1] = denominator[1] * damping;
    denominator[2] = denominator[2] * stiffness;
    let sign = ElevatorSign::NoseDownPositive;
    let may_vanish = |it: &Sloped| it.value.contains(0.0);
    let parts = (sign, LagOf::First(bandwidth));
    let plant = ContinuousPlant::in_normal_form(&numerator, &denominator, parts, may_vanish);
    Ok(plant.expect("an elevator with an effect"))
}

/// The same, as a loop is described.
fn member([effect, damping, stiffness, lag_s]: [f64; 4], gains: Gains<f64>) -> LoopDescription {
    let config =
        PidConfig { derivative: Derivative { filter_s: 0.05 }, ..PidConfig::sampled_every(0.01) };
    let mut denominator = DENOMINATOR.to_vec();
    denominator[1] *= damping;
    denominator[2] *= stiffness;
    LoopDescription {
        numerator: NUMERATOR.map(|it| it * effect).to_vec(),
        denominator,
        elevator_sign: ElevatorSign::NoseDownPositive,
        actuator: Actuator::new(Lag::first_order(lag_s).expect("allowed")),
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
        controller: Controller::Fixed(Pid::new(gains, config).expect("allowed")),
    }
}

const GAINS: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
const NOMINAL: [f64; 4] = [1.0, 1.0, 1.0, 0.1];
const BOX: [[f64; 2]; 4] = [[0.85, 1.15], [0.9, 1.1], [0.85, 1.15], [0.09, 0.11]];

fn found(ends: [[f64; 2]; 4], gains: Gains<f64>) -> FamilyVerdict {
    let loop_ = member(NOMINAL, gains);
    prove_family(&loop_, &parameters(ends), &Effort::default(), &plant).expect("provable")
}

fn proved(ends: [[f64; 2]; 4]) -> Family {
    match found(ends, GAINS) {
        FamilyVerdict::Proved(family) => family,
        other => panic!("{other:?}"),
    }
}

fn radius(description: &LoopDescription) -> f64 {
    let model = description.enclosed().expect("a model").midpoint();
    spectral_radius(&model.closed_matrix(description.controller.nominal()).expect("finite"))
        .expect("a radius")
}

/// Numbers in 0..1 that fill it evenly.
fn share(number: u32) -> f64 {
    let golden = 0.618_033_988_749_895 * f64::from(number);
    golden - libm::floor(golden)
}

fn somewhere(ends: [[f64; 2]; 4], number: u32) -> [f64; 4] {
    core::array::from_fn(|side| {
        let [from, to] = ends[side];
        let which = u32::try_from(side).expect("few");
        from + (to - from) * share(number * 5 + which * which * 3 + which)
    })
}

#[test]
fn every_member_of_a_proved_family_is_stable_and_the_certificate_says_so_alone() {
    let family = proved(BOX);
    assert!((2..60).contains(&family.parts.len()), "{} parts", family.parts.len());
    for number in 0..300 {
        let at = somewhere(BOX, number);
        assert!(radius(&member(at, GAINS)) < 1.0, "{at:?}");
    }
    let loop_ = member(NOMINAL, GAINS);
    let outcome = certify(&loop_, &Asked::rest(), &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    let whole = |family: Family| Certificate { family: Some(family), ..certificate.clone() };
    let checked = whole(family.clone()).check().expect("it holds").family.expect("a family");
    assert_eq!(checked.parts, family.parts.len());
    let refused = |change: &dyn Fn(&mut Family), word: &str| {
        let mut other = family.clone();
        change(&mut other);
        let refused = whole(other).check().expect_err(word).to_string();
        assert!(refused.contains(word), "{refused}");
    };
    refused(&|it| drop(it.parts.pop()), "leave a part");
    refused(&|it| it.parameters[0].ends[1] = 1.2, "leave a part");
    refused(&|it| it.parts[0].plants.slopes.truncate(2), "different states");
    // A wider reach than the forms hold for, and plants that are others.
    refused(&|it| it.parts[0].plants.reach[2] *= 30.0, "part 0 of the family");
    refused(&|it| it.parts[0].plants.reach[1] *= 0.5, "do not reach its ends");
    let other = |it: &mut Family| it.parts[0].plants.middle[1][4] = Interval::between(-90.0, 90.0);
    refused(&other, "part 0 of the family");
}

#[test]
fn a_family_with_a_member_that_grows_is_refuted_at_one_that_does() {
    let gains = Gains { kp: 4.0, ki: 2.0, kd: 1.0 };
    let ends = [[0.5, 4.0], [0.5, 1.5], [0.7, 1.3], [0.05, 0.4]];
    let FamilyVerdict::Refuted { at, claim } = found(ends, gains) else { panic!("not refuted") };
    assert!(!claim.is_of_stability());
    let at: [f64; 4] = at.try_into().expect("four");
    assert!(radius(&member(at, gains)) > 1.0, "{at:?}");
}

/// The sampled plants of members lie between the corners that the proof asks, and their loops between the loops.
#[test]
fn the_sampled_plant_of_every_member_lies_between_the_corners_of_its_set() {
    let ends = [[0.97, 1.03], [0.97, 1.03], [0.98, 1.02], [0.098, 0.102]];
    let parameters = parameters(ends);
    let set = PlantSet::of(&numbers(&parameters, &ends), &plant).expect("plants");
    let corners = set.sampled(0.01).expect("sampled");
    assert_eq!(corners.len(), 16);
    for number in 0..50 {
        let at = somewhere(ends, number);
        let point: Vec<[f64; 2]> = at.iter().map(|&it| [it; 2]).collect();
        let one = PlantSet::of(&numbers(&parameters, &point), &plant).expect("a plant");
        let one = one.sampled(0.01).expect("sampled").remove(0);
        // The share of each corner: the plants are nearly linear in the numbers that they are made of.
        let shares: Vec<f64> = at
            .iter()
            .zip(ends)
            .enumerate()
            .map(|(side, (&it, [from, to]))| match side {
                3 => (1.0 / it - 1.0 / to) / (1.0 / from - 1.0 / to),
                _ => (it - from) / (to - from),
            })
            .collect();
        for (entry, value) in one.rows.iter().enumerate() {
            let mut between = Interval::ZERO;
            for (corner, plant) in corners.iter().enumerate() {
                let weight = shares.iter().enumerate().fold(1.0, |weight, (side, share)| {
                    weight * if corner >> side & 1 == 0 { 1.0 - share } else { *share }
                });
                between = between + Interval::point(weight) * plant.rows[entry];
            }
            let off = (between.lower() - value.lower()).max(value.upper() - between.upper());
            assert!(off < 1e-13, "entry {entry} of {at:?}: {value:?} is not in {between:?}");
        }
    }
}

#[test]
fn a_loops_matrix_is_affine_in_what_its_plant_makes_of_a_sample_whatever_its_sensors() {
    let delayed = |samples, part| Sensing { samples, part, scale: 1.02, ..Sensing::DIRECT };
    for (pitch, rate) in [
        (Sensing::DIRECT, Sensing::DIRECT),
        (Sensing::DIRECT, delayed(0, 0.25)),
        (delayed(0, 0.5), delayed(1, 0.0)),
        (delayed(2, 0.75), delayed(3, 0.5)),
    ] {
        let mut description = member(NOMINAL, GAINS);
        let Controller::Fixed(pid) = &description.controller else { panic!("fixed gains") };
        let config = PidConfig { rate_gain_s: 0.3, ..*pid.config() };
        description.controller = Controller::Fixed(Pid::new(GAINS, config).expect("allowed"));
        (description.pitch, description.rate) = (pitch, rate);
        let model = description.enclosed().expect("a model").midpoint();
        let closed = |rows: Vec<f64>| -> Matrix {
            let SampledPlant { states, rate, .. } = model.plant().clone();
            let plant = SampledPlant { states, rows, rate };
            LoopModel::new(plant, description.settings()).closed_matrix(GAINS).expect("finite")
        };
        let rows =
            |at| member(at, GAINS).enclosed().expect("a model").midpoint().plant().rows.clone();
        let (one, other) = (rows([1.0; 4]), rows([0.5, 1.5, 0.7, 0.05]));
        let middle = one.iter().zip(&other).map(|(one, other)| 0.5 * (one + other)).collect();
        let [one, other, middle] = [closed(one), closed(other), closed(middle)];
        for ((one, other), middle) in one.data().iter().zip(other.data()).zip(middle.data()) {
            assert!((0.5 * (one + other) - middle).abs() < 1e-13, "{pitch:?} {rate:?}");
        }
    }
}

/// The scale of a sensor, %, between two ends.
fn scale(name: &str, sensors: &[ScaledSensor], ends: [f64; 2]) -> Parameter {
    Parameter {
        name: name.to_owned(),
        paths: vec![format!("sensor.{name}.scale_error_pct")],
        relative: false,
        inverse: false,
        sensors: sensors.to_vec(),
        ends,
    }
}

/// A loop that sees the pitch rate as well, both through sensors that are late.
fn seeing(scales: [f64; 2], at: [f64; 4]) -> LoopDescription {
    let mut loop_ = member(at, GAINS);
    let Controller::Fixed(pid) = &loop_.controller else { panic!("fixed gains") };
    let config = PidConfig { rate_gain_s: 0.4, ..*pid.config() };
    loop_.controller = Controller::Fixed(Pid::new(GAINS, config).expect("allowed"));
    let [pitch, rate] = scales;
    loop_.pitch = Sensing { samples: 1, part: 0.25, scale: pitch, ..Sensing::DIRECT };
    loop_.rate = Sensing { samples: 0, part: 0.5, scale: rate, ..Sensing::DIRECT };
    loop_
}

#[test]
fn sensors_whose_scale_differs_are_proved_with_plants_and_every_member_is_stable() {
    let scales = [[-20.0, 25.0], [-30.0, 10.0]];
    let narrow = [[0.9, 1.1], [0.95, 1.05], [0.95, 1.05], [0.095, 0.105]];
    let mut parameters = parameters(narrow);
    // Among the others, so that a place among all is not one among those of the plant.
    parameters.insert(0, scale("pitch", &[ScaledSensor::Pitch], scales[0]));
    parameters.push(scale("rate", &[ScaledSensor::Rate], scales[1]));
    let loop_ = seeing([1.0, 1.0], NOMINAL);
    let found = prove_family(&loop_, &parameters, &Effort::default(), &plant).expect("provable");
    let FamilyVerdict::Proved(family) = found else { panic!("{found:?}") };
    for number in 0..300 {
        let at = somewhere(narrow, number);
        let shares = [share(7 * number + 1), share(11 * number + 4)];
        let seen = core::array::from_fn(|sensor| {
            let [from, to] = scales[sensor];
            1.0 + (from + (to - from) * shares[sensor]) / 100.0
        });
        assert!(radius(&seeing(seen, at)) < 1.0, "{seen:?} {at:?}");
    }
    let outcome = certify(&loop_, &Asked::rest(), &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    let whole = |family: Family| Certificate { family: Some(family), ..certificate.clone() };
    whole(family.clone()).check().expect("it holds");
    let refused = |change: &dyn Fn(&mut Family), word: &str| {
        let mut other = family.clone();
        change(&mut other);
        let refused = whole(other).check().expect_err(word).to_string();
        assert!(refused.contains(word), "{refused}");
    };
    refused(&|it| it.parameters[0].ends[1] = 30.0, "leave a part");
    refused(&|it| it.parameters[5].sensors = vec![ScaledSensor::Pitch], "scale of one sensor");
    refused(&|it| it.parameters[5].sensors.push(ScaledSensor::Rate), "scale of one sensor");
    // A sensor of three times the scale, and one that shows the other way.
    for ends in [[-20.0, 900.0], [-300.0, 25.0]] {
        let wide = |it: &mut Family| {
            it.parameters[0].ends = ends;
            it.parts.iter_mut().for_each(|part| part.ends[0] = ends);
        };
        refused(&wide, "of the family: at kp");
    }
}

#[test]
fn a_scale_at_which_a_loop_grows_refutes_the_family_at_it() {
    let parameters = [scale("pitch", &[ScaledSensor::Pitch], [-10.0, 2000.0])];
    let loop_ = seeing([1.0, 1.0], NOMINAL);
    let still =
        |_: &[Sloped]| plant(&[1.0, 1.0, 1.0, 10.0].map(|it| Sloped::fixed(Interval::point(it))));
    let found = prove_family(&loop_, &parameters, &Effort::default(), &still).expect("provable");
    let FamilyVerdict::Refuted { at, .. } = found else { panic!("{found:?}") };
    assert!(radius(&seeing([1.0 + at[0] / 100.0, 1.0], NOMINAL)) > 1.0, "{at:?}");
}

#[test]
fn scales_of_one_draw_are_proved_together_where_apart_they_would_grow() {
    let both = [ScaledSensor::Pitch, ScaledSensor::Rate];
    let loop_ = seeing([1.0, 1.0], NOMINAL);
    let still =
        |_: &[Sloped]| plant(&[1.0, 1.0, 1.0, 10.0].map(|it| Sloped::fixed(Interval::point(it))));
    let found = |parameters: &[Parameter]| {
        prove_family(&loop_, parameters, &Effort::default(), &still).expect("provable")
    };
    let ends = [-10.0, 780.0];
    let together = found(&[scale("both", &both, ends)]);
    assert!(matches!(together, FamilyVerdict::Proved(_)), "{together:?}");
    let apart = found(&[scale("pitch", &both[..1], ends), scale("rate", &both[1..], ends)]);
    assert!(matches!(apart, FamilyVerdict::Refuted { .. }), "{apart:?}");
}

#[test]
fn the_ends_of_a_scale_hold_what_the_arithmetic_of_a_simulator_makes_of_every_draw() {
    let mut relative = scale("pitch", &[ScaledSensor::Pitch], [0.3, 1.7]);
    relative.relative = true;
    for number in 0..2000 {
        let nominal_pct = 40.0 * share(number) - 20.0;
        let absolute = scale("pitch", &[ScaledSensor::Pitch], [nominal_pct, nominal_pct]);
        let [least, most] = absolute.scales(absolute.ends, 1.0);
        let nominal = 1.0 + nominal_pct / 100.0;
        assert!(least < nominal && nominal < most && most - least < 1e-14);
        let [least, most] = relative.scales(relative.ends, nominal);
        for factor in [0.3, 0.3 + 1.4 * share(number + 1), 1.7] {
            let drawn = 1.0 + nominal_pct * factor / 100.0;
            assert!((least..=most).contains(&drawn), "{nominal_pct} times {factor}");
        }
    }
}

#[test]
fn a_family_of_loops_whose_sensor_resolves_in_steps_is_refused_by_name() {
    let mut loop_ = member(NOMINAL, GAINS);
    loop_.pitch = Sensing { resolution: 1e-4, ..Sensing::DIRECT };
    let found = prove_family(&loop_, &parameters(BOX), &Effort::default(), &plant);
    let FamilyVerdict::Open { because, .. } = found.expect("provable") else { panic!("an answer") };
    assert!(because.to_string().contains("resolves in steps"), "{because}");
    // Nor is a certificate believed that says it all the same.
    let outcome = certify(&loop_, &Asked::rest(), &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    let whole = Certificate { family: Some(proved(BOX)), ..certificate };
    let refused = whole.check().expect_err("refused").to_string();
    assert!(refused.contains("resolves in steps"), "{refused}");
}
