//! What is answered where the rules say nothing, and what is switched off.

use fspid_fuzzy::membership::ShapeKind::Singleton;
use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Fallback, FallbackValue, InputError, Parts, Rule, Sampling, Source,
    System,
};
use fspid_fuzzy::{Formula, Hedge, OutOfRange};

use crate::system::build::{
    answers, block, graded, grades, is, output, parts, rule, sets, shape, system, then, triangle,
};

/// One set, as strongly as the input says.
fn one() -> Parts {
    graded(output(2.0, 8.0, sets(vec![triangle(3.0, 4.0, 5.0)])))
}

fn with_fallback(previous: bool, value: FallbackValue) -> System {
    let mut parts = one();
    parts.outputs[0].fallback = Fallback { previous, value };
    system(parts)
}

#[test]
fn the_result_is_defined_where_nothing_fires() {
    let known = [
        (FallbackValue::Middle, Some(5.0), Source::Middle),
        (FallbackValue::Number(-7.0), Some(-7.0), Source::Default),
        (FallbackValue::Nothing, None, Source::Nothing),
    ];
    for (value, expected, source) in known {
        for previous in [false, true] {
            let answer = answers(&with_fallback(previous, value), &[0.0])[0];
            assert_eq!((answer.value, answer.source), (expected, source));
        }
    }
}

#[test]
fn every_way_to_an_answer_falls_back_where_nothing_fires() {
    let samplings = [
        Sampling::Exact,
        Sampling::Endpoints(11),
        Sampling::Midpoint(10),
        Sampling::Trapezoid(11),
        Sampling::LeftEnd(10),
        Sampling::Vertices(11),
    ];
    let methods = [
        Defuzzifier::Centroid,
        Defuzzifier::Bisector,
        Defuzzifier::SmallestOfMaximum,
        Defuzzifier::MeanOfMaximum,
        Defuzzifier::LargestOfMaximum,
    ];
    for method in methods.iter().flat_map(|m| samplings.map(m)) {
        let mut parts = one();
        parts.outputs[0].defuzzifier = method;
        parts.outputs[0].fallback.value = FallbackValue::Middle;
        // Nothing at all, and too little for a quotient with digits.
        for strength in [0.0, 1e-320] {
            let answer = answers(&system(parts.clone()), &[strength])[0];
            assert_eq!((answer.value, answer.source), (Some(5.0), Source::Middle), "{method:?}");
        }
        assert_eq!(answers(&system(parts), &[1e-300])[0].source, Source::Rules, "{method:?}");
    }
}

#[test]
fn a_set_without_area_in_the_universe_falls_back_though_its_rule_fires() {
    for set in [triangle(10.0, 11.0, 12.0), shape(Singleton, &[4.0])] {
        let mut parts = graded(output(2.0, 8.0, sets(vec![set])));
        parts.outputs[0].fallback.value = FallbackValue::Number(3.0);
        assert_eq!(answers(&system(parts), &[1.0])[0].source, Source::Default);
    }
}

#[test]
fn the_previous_answer_stands_only_if_asked_for_and_given() {
    let mut workspace = one_workspace();
    let keeps = with_fallback(true, FallbackValue::Middle);
    let mut ask = |system: &System, previous: &[Option<f64>]| {
        let answers = system.evaluate_after(&[0.0], previous, &mut workspace).expect("allowed");
        (answers[0].value, answers[0].source)
    };
    assert_eq!(ask(&keeps, &[Some(7.25)]), (Some(7.25), Source::Previous));
    assert_eq!(ask(&keeps, &[None]), (Some(5.0), Source::Middle));
    assert_eq!(ask(&keeps, &[]), (Some(5.0), Source::Middle));
    assert_eq!(ask(&keeps, &[Some(f64::NAN)]), (Some(5.0), Source::Middle));
    let forgets = with_fallback(false, FallbackValue::Middle);
    assert_eq!(ask(&forgets, &[Some(7.25)]), (Some(5.0), Source::Middle));
}

fn one_workspace() -> fspid_fuzzy::system::Workspace {
    system(one()).workspace()
}

#[test]
fn state_does_not_leak_between_calls() {
    let general = system(crate::system::tipper::matlab(Sampling::Exact));
    let mut used = general.workspace();
    for n in 0..100 {
        let inputs = [f64::from(n * 37 % 101) * 0.1, f64::from(n * 53 % 101) * 0.1];
        let fresh = answers(&general, &inputs);
        assert_eq!(general.evaluate(&inputs, &mut used).expect("allowed"), fresh);
    }
}

#[test]
fn a_clamped_answer_lies_in_the_universe_wherever_it_comes_from() {
    let mut parts = one();
    parts.outputs[0].terms[0].conclusion = Conclusion::Constant(100.0);
    parts.outputs[0].defuzzifier = Defuzzifier::WeightedAverage(Default::default());
    parts.outputs[0].fallback.value = FallbackValue::Number(-100.0);
    for (clamp, expected) in [(false, [100.0, -100.0]), (true, [8.0, 2.0])] {
        parts.outputs[0].clamp = clamp;
        let general = system(parts.clone());
        let found = [1.0, 0.0].map(|input| answers(&general, &[input])[0].value);
        assert_eq!(found, expected.map(Some));
    }
}

#[test]
fn what_is_switched_off_has_no_effect() {
    // Two sets; the second one through the second input.
    let both =
        || graded(output(0.0, 10.0, sets(vec![triangle(1.0, 2.0, 3.0), triangle(7.0, 8.0, 9.0)])));
    let ask = |parts: Parts| answers(&system(parts), &[1.0, 1.0])[0].value;
    assert_eq!(ask(both()), Some(5.0));
    let mut without_rule = both();
    without_rule.blocks[0].rules[1].enabled = false;
    assert_eq!(ask(without_rule), Some(2.0));
    let mut without_input = both();
    without_input.inputs[1].enabled = false;
    assert_eq!(ask(without_input), Some(2.0));
    let mut without_block = both();
    let second = without_block.blocks[0].rules.remove(1);
    without_block.blocks.push(block(vec![second]));
    assert_eq!(ask(without_block.clone()), Some(5.0));
    without_block.blocks[1].enabled = false;
    assert_eq!(ask(without_block), Some(2.0));
    let mut without_output = both();
    without_output.outputs[0].enabled = false;
    without_output.outputs[0].fallback.value = FallbackValue::Number(4.5);
    assert_eq!(ask(without_output), Some(4.5));
}

#[test]
fn a_rule_that_does_not_fire_concludes_nothing_even_with_not() {
    let negated = |hedges: Vec<Hedge>| {
        let mut consequent = then(0, 0);
        consequent.hedges = hedges;
        let rules: Vec<Rule> = vec![rule(is(0, 0), consequent)];
        let out = output(2.0, 8.0, sets(vec![triangle(3.0, 4.0, 5.0)]));
        system(parts(grades(1), vec![out], vec![block(rules)]))
    };
    assert_eq!(answers(&negated(vec![Hedge::Not]), &[0.0])[0].source, Source::Nothing);
    let top = |hedges: Vec<Hedge>, strength: f64| {
        let general = negated(hedges);
        let mut workspace = general.workspace();
        general.evaluate(&[strength], &mut workspace).expect("allowed");
        general.outline(0, &mut workspace).expect("triangles").top()
    };
    assert_eq!(top(vec![Hedge::Not], 0.25), 0.75);
    assert_eq!(top(vec![Hedge::Very], 0.5), 0.25);
    // The last one acts first.
    assert_eq!(top(vec![Hedge::Not, Hedge::Very], 0.5), 0.75);
    assert_eq!(top(vec![Hedge::Very, Hedge::Not], 0.25), 0.5625);
}

#[test]
fn a_formula_without_a_finite_value_falls_back() {
    let mut parts = one();
    let formula = Formula::parse("1 / (a - 1)", &["a"]).expect("a formula");
    parts.outputs[0].terms[0].conclusion = Conclusion::Formula(formula);
    parts.outputs[0].defuzzifier = Defuzzifier::WeightedAverage(Default::default());
    parts.outputs[0].fallback.value = FallbackValue::Number(3.0);
    let general = system(parts);
    assert_eq!(answers(&general, &[0.5])[0].value, Some(-2.0));
    let answer = answers(&general, &[1.0])[0];
    assert_eq!((answer.value, answer.source), (Some(3.0), Source::Default));
}

#[test]
fn inputs_are_taken_moved_or_refused_as_they_say() {
    let mut parts = one();
    let ask = |parts: &Parts, inputs: &[f64]| {
        let general = system(parts.clone());
        let mut workspace = general.workspace();
        let answers = general.evaluate(inputs, &mut workspace).map(|answers| answers[0].source);
        (answers, workspace.inputs().to_vec(), workspace.outside().to_vec())
    };
    parts.inputs[0].out_of_range = OutOfRange::Evaluate;
    assert_eq!(ask(&parts, &[1.5]), (Ok(Source::Rules), vec![1.5], vec![true]));
    parts.inputs[0].out_of_range = OutOfRange::Clamp;
    assert_eq!(ask(&parts, &[-1.5]), (Ok(Source::Nothing), vec![0.0], vec![true]));
    parts.inputs[0].out_of_range = OutOfRange::Error;
    let refused = InputError::Value { input: 0, found: 1.5, universe: Some([0.0, 1.0]) };
    assert_eq!(ask(&parts, &[1.5]).0, Err(refused));
    assert_eq!(ask(&parts, &[]).0, Err(InputError::Count { found: 0, expected: 1 }));
    let general = system(parts);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(general.evaluate(&[bad], &mut general.workspace()).is_err());
    }
}
