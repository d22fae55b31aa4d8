//! Systems are found again from their own answers.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{Conclusion, Defuzzifier, Parameter, Parts, SetReading};
use fspid_tune::anfis::{Curve, Data, Judges, Order, Plan, Stop, grid, learn_beside, sugeno};

use crate::anfis::{answer, axis, learned, root_mean_square, samples, teacher};

fn numbers(parts: &Parts) -> Vec<f64> {
    parts.parameters().into_iter().filter_map(|parameter| parts.parameter(parameter)).collect()
}

fn furthest(one: &Parts, other: &Parts) -> f64 {
    let pairs = numbers(one).into_iter().zip(numbers(other));
    pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// Conclusions alone, in one pass.
fn fit() -> Plan {
    Plan { premises: false, ..Plan::default() }
}

#[test]
fn conclusions_are_found_again_from_their_own_answers() {
    for curve in [Curve::Gaussian, Curve::Bell, Curve::Triangle] {
        let teacher = teacher(curve);
        let data = Data::taught(&teacher, &[11, 9]).expect("a teacher");
        let found = learned(&sugeno(&teacher, Order::One), &data, &fit());
        assert_eq!((found.stop, found.history.len()), (Stop::Fitted, 1));
        // The weight that draws to 0 is a millionth of the answers' size, and acts squared.
        assert!(found.best().training < 1e-9, "{curve:?}: {:e}", found.best().training);
        // Straight sets with linear conclusions make the same parabola in more than one way.
        if curve != Curve::Triangle {
            let off = furthest(&found.parts, &teacher);
            assert!(off < 1e-7, "{curve:?}: {off:e}");
        }
    }
}

#[test]
fn sets_that_were_moved_away_find_back_to_the_answers_of_the_data() {
    let teacher = teacher(Curve::Gaussian);
    let data = Data::taught(&teacher, &[11, 9]).expect("a teacher");
    let mut start = teacher.clone();
    for (term, shift) in [(0, 0.08), (1, 0.05), (2, -0.06)] {
        let centre = Parameter::InputShape { input: 0, term, index: 0 };
        let value = start.parameter(centre).expect("a centre");
        start.set_parameter(centre, value + shift);
    }
    let found = learned(&start, &data, &Plan { epochs: 200, ..Plan::default() });
    let first = found.history[0].training;
    assert!(found.best().training < 0.02 * first, "{first:e} to {:e}", found.best().training);
    assert_eq!((found.stop, found.history.len()), (Stop::Epochs, 200));
}

#[test]
fn the_error_that_is_told_is_that_of_the_system_that_is_handed_back() {
    let data = samples(0.0, 3.0, 31, |x| libm::exp(-x) * libm::sin(4.0 * x));
    let start = grid(&[axis("x", 0.0, 3.0, 4)], &["y"], Curve::Gaussian, Order::One);
    let found = learned(&start, &data, &Plan { epochs: 30, ..Plan::default() });
    let own = root_mean_square(&found.parts, &data);
    assert!((own / found.best().training - 1.0).abs() < 1e-12, "{own:e} {:?}", found.best());
    let least = found.history.iter().map(|epoch| epoch.training).fold(f64::INFINITY, f64::min);
    assert_eq!(found.best().training, least);
    let beside = samples(0.05, 2.95, 30, |x| libm::exp(-x) * libm::sin(4.0 * x));
    let plan = Plan { epochs: 30, ..Plan::default() };
    let judged = learn_beside(&start, &data, Some(&beside), &plan).expect("it is learned");
    let own = root_mean_square(&judged.parts, &beside);
    assert!((own / judged.best().validation.expect("it is judged") - 1.0).abs() < 1e-12);
}

#[test]
fn a_term_that_several_rules_conclude_is_learned_once() {
    let data = samples(-1.0, 1.0, 21, |x| 2.0 * x * x - 0.5);
    let mut start = grid(&[axis("x", -1.0, 1.0, 3)], &["y"], Curve::Gaussian, Order::Zero);
    // Both outer rules conclude the first term; the third is concluded by none and keeps its number.
    start.blocks[0].rules[2].consequents[0].term = 0;
    start.outputs[0].terms[2].conclusion = Conclusion::Constant(7.0);
    let found = learned(&start, &data, &fit()).parts;
    let constant = |term: usize| match found.outputs[0].terms[term].conclusion {
        Conclusion::Constant(number) => number,
        _ => panic!("a number"),
    };
    assert_eq!(constant(2), 7.0);
    assert!(constant(0) > 1.0 && constant(1) < -0.4, "{} {}", constant(0), constant(1));
    assert!((answer(&found, &[0.7]) - answer(&found, &[-0.7])).abs() < 1e-15);
}

#[test]
fn a_weighted_sum_is_learned_as_a_sum() {
    let mut start = grid(&[axis("x", 0.0, 1.0, 3)], &["y"], Curve::Triangle, Order::Zero);
    start.outputs[0].defuzzifier = Defuzzifier::WeightedSum(SetReading::default());
    // Weights of rules count in a sum, where an average would divide by them again.
    start.blocks[0].rules[1].weight = 0.25;
    let data = samples(0.0, 1.0, 11, |x| if x < 0.5 { 1.0 + 2.0 * x } else { 4.0 - 4.0 * x });
    let found = learned(&start, &data, &fit());
    assert!(found.best().training < 1e-9, "{:e}", found.best().training);
    // 2 at the middle, where the rule fires with a quarter.
    let Conclusion::Constant(middle) = found.parts.outputs[0].terms[1].conclusion else { panic!() };
    assert!((middle - 8.0).abs() < 1e-6, "{middle}");
}

#[test]
fn inputs_that_are_moved_into_their_universe_are_learned_where_they_were_moved_to() {
    let mut start = grid(&[axis("x", 0.0, 1.0, 2)], &["y"], Curve::Triangle, Order::One);
    start.inputs[0].out_of_range = OutOfRange::Clamp;
    let data = samples(-1.0, 2.0, 31, |x| 3.0 * x.clamp(0.0, 1.0) + 1.0);
    let found = learned(&start, &data, &fit());
    assert!(found.best().training < 1e-9, "{:e}", found.best().training);
    assert!((answer(&found.parts, &[5.0]) - 4.0).abs() < 1e-8);
}

#[test]
fn an_output_that_is_clamped_is_learned_before_its_ends_act_and_stays_clamped() {
    let mut start = grid(&[axis("x", 0.0, 1.0, 3)], &["y"], Curve::Gaussian, Order::One);
    start.outputs[0].universe = Some(fspid_fuzzy::system::Universe { lower: 0.0, upper: 0.5 });
    start.outputs[0].clamp = true;
    let data = samples(0.0, 1.0, 21, |x| x);
    let found = learned(&start, &data, &fit());
    assert!(found.parts.outputs[0].clamp);
    assert_eq!(answer(&found.parts, &[0.8]), 0.5);
    let mut before = found.parts.clone();
    before.outputs[0].clamp = false;
    assert!(root_mean_square(&before, &data) < 1e-9);
}

/// The error of the answers before they were moved was told: 53.0 of a file whose answers are 59.1 from the data.
#[test]
fn the_errors_that_are_told_of_a_clamped_output_are_those_of_the_answers_it_gives() {
    let mut start = grid(&[axis("x", 0.0, 1.0, 3)], &["y"], Curve::Gaussian, Order::One);
    start.outputs[0].universe = Some(fspid_fuzzy::system::Universe { lower: 0.0, upper: 0.5 });
    start.outputs[0].clamp = true;
    let data = samples(0.0, 1.0, 21, |x| x);
    let beside = samples(0.03, 0.97, 12, |x| x);
    for plan in [fit(), Plan { epochs: 6, ..Plan::default() }] {
        let found = learn_beside(&start, &data, Some(&beside), &plan).expect("it is learned");
        let (training, validation) = (found.best().training, found.best().validation);
        let own = [root_mean_square(&found.parts, &data), root_mean_square(&found.parts, &beside)];
        assert!(own[0] > 0.1 && (own[0] / training - 1.0).abs() < 1e-12, "{own:?} {training}");
        let validation = validation.expect("it is judged");
        assert!((own[1] / validation - 1.0).abs() < 1e-12, "{own:?} {validation}");
    }
}

#[test]
fn rows_that_judge_and_are_learned_from_as_well_are_counted() {
    let once = samples(0.0, 3.0, 20, |x| libm::sin(2.0 * x));
    let start = grid(&[axis("x", 0.0, 3.0, 3)], &["y"], Curve::Bell, Order::One);
    let plan = Plan { epochs: 2, validation_share: 0.25, ..Plan::default() };
    let found = learned(&start, &once, &plan);
    assert_eq!(found.judges, Some(Judges { rows: 5, also_learned: 0 }));
    assert!(!found.text().contains("learned from as well"), "{}", found.text());
    let mut twice = once.clone();
    once.rows().for_each(|row| twice.push(row.inputs, row.outputs).expect("finite"));
    let found = learned(&start, &twice, &plan);
    let judges = found.judges.expect("a quarter of the rows");
    // Of ten that are drawn of pairs, few pairs are drawn whole.
    assert!(judges.rows == 10 && judges.also_learned >= 6, "{judges:?}");
    let told = format!("{} of the 10 rows for validation", judges.also_learned);
    assert!(found.text().contains(&told), "{}", found.text());
    assert_eq!(found.json()["validation_rows_also_learned"], judges.also_learned);
    assert_eq!(learned(&start, &once, &fit()).judges, None);
}

#[test]
fn the_same_data_and_plan_give_the_same_bits_and_another_seed_other_judges() {
    let data = samples(0.0, 3.0, 40, |x| libm::sin(2.0 * x));
    let start = grid(&[axis("x", 0.0, 3.0, 3)], &["y"], Curve::Bell, Order::One);
    let plan = Plan { epochs: 15, validation_share: 0.25, ..Plan::default() };
    let one = learned(&start, &data, &plan);
    assert_eq!(one, learned(&start, &data, &plan));
    assert_ne!(one, learned(&start, &data, &Plan { seed: 2, ..plan }));
    let (training, judges) = data.split(0.25, 1);
    let judges = judges.expect("a quarter of the rows");
    assert_eq!((training.len(), judges.len()), (30, 10));
    let mut rows: Vec<usize> = training.rows().chain(judges.rows()).map(|row| row.number).collect();
    rows.sort_unstable();
    assert_eq!(rows, (1..=40).collect::<Vec<_>>());
    assert_eq!(data.split(0.01, 1), (data.clone(), None));
}
