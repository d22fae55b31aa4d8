//! Antecedents, activation, chains, and the bugs that other libraries had.

use fspid_fuzzy::membership::ShapeKind::{Ramp, Triangle};
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Antecedent, Comparison, Conclusion, Consequent, Defuzzifier, Input, Membership,
    Parts, Rule, SetReading, Statement, Variable,
};
use fspid_fuzzy::{Formula, Hedge};

use crate::system::build::{
    answers, block, grades, is, output, parts, rule, sets, shape, system, then, triangle, value,
};

/// Constants 1, 10, 100, … by weighted sum: rule i concludes its own, so that every strength can be
/// read off the answer.
fn strengths_of(
    inputs: Vec<Input>,
    rules: Vec<Antecedent>,
    edit: impl Fn(&mut Parts),
) -> impl Fn(&[f64]) -> Vec<f64> {
    let count = rules.len();
    let outputs = (0..count).map(|_| {
        let mut out = output(0.0, 1.0, vec![Conclusion::Constant(1.0)]);
        out.defuzzifier = Defuzzifier::WeightedSum(SetReading::default());
        out.fallback.value = fspid_fuzzy::system::FallbackValue::Number(0.0);
        out
    });
    let rules = rules.into_iter().enumerate().map(|(n, antecedent)| rule(antecedent, then(n, 0)));
    let mut parts = parts(inputs, outputs.collect(), vec![block(rules.collect())]);
    edit(&mut parts);
    let general = system(parts);
    move |inputs| answers(&general, inputs).iter().map(|a| a.value.expect("a number")).collect()
}

#[test]
fn several_rules_with_one_consequent_all_count() {
    // In three libraries the last rule about a set overwrote the others.
    let out = output(0.0, 10.0, sets(vec![triangle(0.0, 2.0, 4.0), triangle(6.0, 8.0, 10.0)]));
    let rules =
        || vec![rule(is(0, 0), then(0, 0)), rule(is(1, 0), then(0, 0)), rule(is(2, 0), then(0, 1))];
    let ask = |inputs: [f64; 3]| {
        value(parts(grades(3), vec![out.clone()], vec![block(rules())]), &inputs)
    };
    let alike = [ask([0.9, 0.1, 0.5]), ask([0.1, 0.9, 0.5]), ask([0.9, 0.9, 0.5])];
    assert!(alike.iter().all(|&found| found == alike[0]) && alike[0] < 5.0, "{alike:?}");
    // By sum both weigh.
    let mut summed = parts(grades(3), vec![out.clone()], vec![block(rules())]);
    summed.outputs[0].aggregation = SNormKind::UnboundedSum.into();
    summed.blocks[0].implication = TNormKind::AlgebraicProduct.into();
    let found = value(summed, &[0.25, 0.5, 0.75]);
    assert!((found - 5.0).abs() < 1e-14, "{found}");
    // By weights, too.
    let mut weighted = parts(grades(3), vec![out], vec![block(rules())]);
    weighted.outputs[0].terms[0].conclusion = Conclusion::Constant(2.0);
    weighted.outputs[0].terms[1].conclusion = Conclusion::Constant(8.0);
    weighted.outputs[0].defuzzifier = Defuzzifier::WeightedAverage(SetReading::default());
    assert_eq!(value(weighted, &[0.25, 0.5, 0.75]), 5.0);
}

#[test]
fn the_negation_of_term_0_can_be_written() {
    // Where terms are numbered and negated by sign, minus nought is nought.
    let negated = Antecedent::Is(Statement {
        variable: Variable::Input(0),
        term: Some(0),
        hedges: vec![Hedge::Not],
    });
    let ask = strengths_of(
        grades(1),
        vec![is(0, 0), negated, Antecedent::Not(Box::new(is(0, 0)))],
        |_| {},
    );
    assert_eq!(ask(&[0.25]), [0.25, 0.75, 0.75]);
}

#[test]
fn a_triangle_with_its_peak_on_an_end_grades_1_there() {
    let shoulders = || {
        crate::system::build::input(
            0.0,
            10.0,
            vec![shape(Triangle, &[0.0, 0.0, 5.0]), shape(Triangle, &[5.0, 10.0, 10.0])],
        )
    };
    let ask = strengths_of(vec![shoulders()], vec![is(0, 0), is(0, 1)], |_| {});
    assert_eq!(ask(&[0.0]), [1.0, 0.0]);
    assert_eq!(ask(&[10.0]), [0.0, 1.0]);
    assert_eq!(ask(&[-1e-9]), [0.0, 0.0]);
}

#[test]
fn and_or_and_not_nest() {
    use Antecedent::{All, Always, Any, Not};
    let rules = vec![
        All(vec![is(0, 0), is(1, 0), is(2, 0)]),
        Any(vec![is(0, 0), is(1, 0), is(2, 0)]),
        All(vec![is(0, 0), Any(vec![is(1, 0), is(2, 0)])]),
        Any(vec![All(vec![is(0, 0), is(1, 0)]), Not(Box::new(is(2, 0)))]),
        Not(Box::new(All(vec![is(0, 0), Not(Box::new(is(1, 0)))]))),
        All(vec![Any(vec![is(0, 0), is(1, 0)]), Any(vec![is(1, 0), is(2, 0)])]),
        Always,
    ];
    let ask = strengths_of(grades(3), rules.clone(), |_| {});
    assert_eq!(ask(&[0.5, 0.25, 0.875]), [0.25, 0.875, 0.5, 0.25, 0.5, 0.5, 1.0]);
    let products = strengths_of(grades(3), rules, |parts| {
        parts.blocks[0].and = TNormKind::AlgebraicProduct.into();
        parts.blocks[0].or = SNormKind::AlgebraicSum.into();
    });
    let found = products(&[0.5, 0.5, 0.5]);
    assert_eq!(found, [0.125, 0.875, 0.375, 0.625, 0.75, 0.5625, 1.0]);
}

#[test]
fn hedges_act_from_the_last_to_the_first() {
    let hedged = |hedges: Vec<Hedge>, term| {
        Antecedent::Is(Statement { variable: Variable::Input(0), term, hedges })
    };
    let rules = vec![
        hedged(vec![Hedge::Very], Some(0)),
        hedged(vec![Hedge::Not, Hedge::Very], Some(0)),
        hedged(vec![Hedge::Very, Hedge::Not], Some(0)),
        hedged(vec![Hedge::Any], None),
        hedged(vec![Hedge::Power(3.0)], Some(0)),
    ];
    let ask = strengths_of(grades(1), rules, |_| {});
    assert_eq!(ask(&[0.5]), [0.25, 0.75, 0.25, 1.0, 0.125]);
}

#[test]
fn weights_multiply_strengths_and_nought_removes_a_rule() {
    let ask = strengths_of(grades(2), vec![is(0, 0), is(1, 0)], |parts| {
        parts.blocks[0].rules[0].weight = 0.25;
        parts.blocks[0].rules[1].weight = 0.0;
    });
    assert_eq!(ask(&[0.5, 1.0]), [0.125, 0.0]);
}

fn activated(activation: Activation, inputs: [f64; 5]) -> Vec<f64> {
    let rules = (0..5).map(|n| is(n, 0)).collect();
    strengths_of(grades(5), rules, |parts| parts.blocks[0].activation = activation)(&inputs)
}

#[test]
fn activation_chooses_which_rules_act() {
    let inputs = [0.25, 0.0, 0.75, 0.5, 0.75];
    let known = [
        (Activation::General, [0.25, 0.0, 0.75, 0.5, 0.75]),
        (Activation::First { count: 2, threshold: 0.0 }, [0.25, 0.0, 0.75, 0.0, 0.0]),
        (Activation::First { count: 2, threshold: 0.5 }, [0.0, 0.0, 0.75, 0.5, 0.0]),
        (Activation::First { count: 9, threshold: 0.8 }, [0.0; 5]),
        (Activation::Last { count: 2, threshold: 0.0 }, [0.0, 0.0, 0.0, 0.5, 0.75]),
        (Activation::Last { count: 3, threshold: 0.6 }, [0.0, 0.0, 0.75, 0.0, 0.75]),
        (Activation::Highest { count: 1 }, [0.0, 0.0, 0.75, 0.0, 0.0]),
        (Activation::Highest { count: 3 }, [0.0, 0.0, 0.75, 0.5, 0.75]),
        (Activation::Lowest { count: 1 }, [0.25, 0.0, 0.0, 0.0, 0.0]),
        (Activation::Lowest { count: 3 }, [0.25, 0.0, 0.75, 0.5, 0.0]),
        (Activation::Lowest { count: 99 }, [0.25, 0.0, 0.75, 0.5, 0.75]),
        (Activation::Proportional, [0.25 / 2.25, 0.0, 0.75 / 2.25, 0.5 / 2.25, 0.75 / 2.25]),
    ];
    for (activation, expected) in known {
        assert_eq!(activated(activation, inputs), expected, "{activation:?}");
    }
    assert_eq!(activated(Activation::Proportional, [0.0; 5]), [0.0; 5]);
}

#[test]
fn a_threshold_compares_as_it_says() {
    let known = [
        (Comparison::Less, [0.25, 0.0, 0.0, 0.0, 0.0]),
        (Comparison::AtMost, [0.25, 0.5, 0.0, 0.0, 0.5]),
        (Comparison::Equal, [0.0, 0.5, 0.0, 0.0, 0.5]),
        (Comparison::Unequal, [0.25, 0.0, 0.75, 1.0, 0.0]),
        (Comparison::AtLeast, [0.0, 0.5, 0.75, 1.0, 0.5]),
        (Comparison::Greater, [0.0, 0.0, 0.75, 1.0, 0.0]),
    ];
    for (comparison, expected) in known {
        let activation = Activation::Threshold { comparison, threshold: 0.5 };
        assert_eq!(activated(activation, [0.25, 0.5, 0.75, 1.0, 0.5]), expected, "{comparison:?}");
    }
}

#[test]
fn a_statement_about_an_output_asks_how_strongly_it_has_been_concluded_so_far() {
    let about = |output, term, hedges: Vec<Hedge>| {
        Antecedent::Is(Statement { variable: Variable::Output(output), term, hedges })
    };
    let mut first =
        output(0.0, 10.0, sets(vec![triangle(0.0, 2.0, 4.0), triangle(6.0, 8.0, 10.0)]));
    first.aggregation = SNormKind::Maximum.into();
    let mut second = output(0.0, 1.0, vec![Conclusion::Constant(1.0)]);
    second.defuzzifier = Defuzzifier::WeightedSum(SetReading::default());
    second.fallback.value = fspid_fuzzy::system::FallbackValue::Number(0.0);
    let chained = |antecedent: Antecedent, separate: bool, edit: &dyn Fn(&mut Parts)| {
        let firsts = vec![rule(is(0, 0), then(0, 0)), rule(is(1, 0), then(0, 0))];
        let last = rule(antecedent, then(1, 0));
        let blocks = if separate {
            vec![block(firsts), block(vec![last])]
        } else {
            vec![block([firsts, vec![last]].concat())]
        };
        let mut parts = parts(grades(2), vec![first.clone(), second.clone()], blocks);
        edit(&mut parts);
        move |inputs: [f64; 2]| answers(&system(parts.clone()), &inputs)[1].value.expect("a number")
    };
    let as_is = |_: &mut Parts| {};
    for separate in [false, true] {
        assert_eq!(chained(about(0, Some(0), vec![]), separate, &as_is)([0.25, 0.5]), 0.5);
        assert_eq!(
            chained(about(0, Some(0), vec![Hedge::Not]), separate, &as_is)([0.25, 0.5]),
            0.5
        );
        assert_eq!(chained(about(0, Some(1), vec![]), separate, &as_is)([0.25, 0.5]), 0.0);
        assert_eq!(chained(about(0, None, vec![Hedge::Any]), separate, &as_is)([0.25, 0.5]), 1.0);
        let summed =
            |parts: &mut Parts| parts.outputs[0].aggregation = SNormKind::BoundedSum.into();
        assert_eq!(chained(about(0, Some(0), vec![]), separate, &summed)([0.25, 0.5]), 0.75);
        let off = |parts: &mut Parts| parts.outputs[0].enabled = false;
        assert_eq!(chained(about(0, Some(0), vec![]), separate, &off)([0.25, 0.5]), 0.0);
    }
    // What a block's activation holds back has not been concluded for the blocks after it.
    let lowest = |parts: &mut Parts| parts.blocks[0].activation = Activation::Lowest { count: 1 };
    assert_eq!(chained(about(0, Some(0), vec![]), true, &lowest)([0.25, 0.5]), 0.25);
}

fn weighted(conclusions: Vec<Conclusion>, method: Defuzzifier) -> Parts {
    let count = conclusions.len();
    let mut out = output(0.0, 10.0, conclusions);
    out.defuzzifier = method;
    let rules = (0..count).map(|n| rule(is(n, 0), then(0, n))).collect();
    parts(grades(count), vec![out], vec![block(rules)])
}

const AVERAGE: Defuzzifier = Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
const SUM: Defuzzifier = Defuzzifier::WeightedSum(SetReading::Tsukamoto);

#[test]
fn singletons_answer_their_weighted_average() {
    let numbers = || vec![Conclusion::Constant(2.0), Conclusion::Constant(6.0)];
    assert_eq!(value(weighted(numbers(), AVERAGE), &[0.25, 0.75]), 5.0);
    assert_eq!(value(weighted(numbers(), SUM), &[0.25, 0.75]), 5.0);
    assert_eq!(value(weighted(numbers(), SUM), &[0.25, 0.25]), 2.0);
    // Strengths of any size.
    let tiny = value(weighted(numbers(), AVERAGE), &[3e-308, 9e-308]);
    assert!((tiny - 5.0).abs() < 1e-14, "{tiny}");
}

#[test]
fn takagi_and_sugeno_s_conclusions_are_functions_of_the_inputs() {
    let formula = Formula::parse("a * b", &["a", "b", "c"]).expect("a formula");
    let conclusions = vec![
        Conclusion::Linear { coefficients: vec![2.0, 0.0, -4.0], constant: 1.0 },
        Conclusion::Formula(formula),
        Conclusion::Constant(0.5),
    ];
    // (0.5 · (1 + 1 - 1) + 0.5 · 0.25 + 0.25 · 0.5) / 1.25
    assert_eq!(value(weighted(conclusions, AVERAGE), &[0.5, 0.5, 0.25]), 0.75 / 1.25);
}

#[test]
fn tsukamoto_asks_sets_for_the_place_of_a_strength_and_the_inverse_for_the_grade() {
    let ramps = || sets(vec![shape(Ramp, &[0.0, 10.0]), shape(Ramp, &[10.0, 0.0])]);
    // 2.5 and 2.5, 0.25 : 0.75.
    assert_eq!(value(weighted(ramps(), AVERAGE), &[0.25, 0.75]), 2.5);
    let inverse = Defuzzifier::WeightedAverage(SetReading::InverseTsukamoto);
    let slopes = sets(vec![shape(Ramp, &[0.0, 1.0]), shape(Ramp, &[2.0, 0.0])]);
    assert_eq!(value(weighted(slopes, inverse), &[0.25, 0.75]), 0.25 * 0.25 + 0.75 * 0.625);
    // A set is asked no higher than it reaches.
    let half = Membership::Shape { kind: Ramp, params: vec![0.0, 10.0], height: 0.5 };
    assert_eq!(value(weighted(sets(vec![half]), AVERAGE), &[0.25]), 5.0);
}

#[test]
fn sets_and_constants_mix_under_a_weighted_average() {
    let ramp = Conclusion::Set { membership: shape(Ramp, &[0.0, 10.0]), lower: None };
    let mixed = vec![ramp, Conclusion::Constant(1.0)];
    assert_eq!(value(weighted(mixed, AVERAGE), &[0.5, 0.5]), 3.0);
}

#[test]
fn larsen_s_product_keeps_the_centre_of_a_set_and_mamdani_s_minimum_does_not() {
    let lopsided = output(0.0, 4.0, sets(vec![triangle(0.0, 1.0, 4.0)]));
    let mut larsen =
        parts(grades(1), vec![lopsided], vec![block(vec![rule(is(0, 0), then(0, 0))])]);
    let mamdani = value(larsen.clone(), &[0.5]);
    larsen.blocks[0].implication = TNormKind::AlgebraicProduct.into();
    assert!((value(larsen, &[0.5]) - 5.0 / 3.0).abs() < 1e-15);
    // Cut at one half: 0.5 to 2.5 flat. Area 1.5, moment 0.125·(1/3) + 1.0·1.5 + 0.375·3.
    let expected = (0.125 / 3.0 + 1.5 + 1.125) / 1.5;
    assert!((mamdani - expected).abs() < 1e-15, "{mamdani}");
}

#[test]
fn a_rule_may_conclude_about_several_outputs() {
    let out = |at| {
        let mut out = output(0.0, 10.0, vec![Conclusion::Constant(at)]);
        out.defuzzifier = AVERAGE;
        out
    };
    let consequents: Vec<Consequent> = vec![then(0, 0), then(1, 0)];
    let both = Rule { consequents, ..rule(is(0, 0), then(0, 0)) };
    let general = system(parts(grades(1), vec![out(3.0), out(4.0)], vec![block(vec![both])]));
    let found: Vec<_> = answers(&general, &[0.5]).iter().map(|answer| answer.value).collect();
    assert_eq!(found, [Some(3.0), Some(4.0)]);
    assert_eq!(general.origin(1), Some([0, 0, 1]));
}
