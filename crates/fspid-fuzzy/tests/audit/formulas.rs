//! Surfaces of systems with formulas.

use fspid_fuzzy::Formula;
use fspid_fuzzy::audit::{Statement, SurfaceAudit, SurfaceOptions, surface};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, Membership, Output, Sampling, SetReading, System,
};

use crate::system::build::{
    answers, block, input, is, output, parts, rule, sets, shape, system, then,
};

fn audited(system: &System) -> SurfaceAudit {
    let options = SurfaceOptions { boxes: 300, ..SurfaceOptions::default() };
    surface(system, &options).expect("universes are known")
}

fn value(system: &System, inputs: &[f64]) -> f64 {
    answers(system, inputs)[0].value.expect("rules fire")
}

fn formula(text: &str, names: &[&str]) -> Formula {
    Formula::parse(text, names).expect("a formula")
}

fn set(text: &str, names: &[&str]) -> Membership {
    Membership::Formula { formula: formula(text, names), height: 1.0 }
}

fn averaged(conclusions: Vec<Conclusion>) -> Output {
    let defuzzifier = Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
    Output { defuzzifier, ..output(-20.0, 20.0, conclusions) }
}

/// One rule that always fires, with a formula of one input.
fn of_formula(text: &str, name: &str) -> System {
    let everywhere = shape(ShapeKind::Rectangle, &[-2.0, 12.0]);
    let conclusion = Conclusion::Formula(formula(text, &[name]));
    let rules = vec![rule(is(0, 0), then(0, 0))];
    let input = input(0.0, 10.0, vec![everywhere]);
    system(parts(vec![input], vec![averaged(vec![conclusion])], vec![block(rules)]))
}

/// Such a surface used to be proved to rise throughout, because the name was looked for in small
/// letters alone.
#[test]
fn a_surface_that_jumps_down_is_not_proved_to_rise_whatever_the_case_of_its_function() {
    for text in ["x - 2 * floor(x)", "x - 2 * FLOOR(x)", "x - 2 * Floor(x)", "x - 2 * cEiL(x)"] {
        let system = of_formula(text, "x");
        assert!(value(&system, &[1.1]) < value(&system, &[0.9]), "{text}");
        let monotone = &audited(&system).outputs[0].along[0].monotone;
        assert!(monotone.statement != Statement::Proved || !monotone.rises, "{text} {monotone:?}");
    }
}

/// `le` and `lt` used to be found in names of variables, so that nothing was proved.
#[test]
fn a_name_that_holds_that_of_a_function_does_not_make_a_formula_jump() {
    let monotone =
        &audited(&of_formula("2 * angle_delta", "angle_delta")).outputs[0].along[0].monotone;
    assert_eq!((&monotone.statement, monotone.rises), (&Statement::Proved, true));
}

/// The output's set moves with the input; it used to be taken for one that stays.
#[test]
fn a_surface_is_not_proved_even_whose_output_sets_depend_on_the_input() {
    let moves = sets(vec![set("1 - abs(x - 5 - 3 * a)", &["x", "a"])]);
    let mut output = output(0.0, 10.0, moves);
    output.defuzzifier = Defuzzifier::Centroid(Sampling::Midpoint(100));
    let input = input(-1.0, 1.0, vec![shape(ShapeKind::Trapezoid, &[-3.0, -2.0, 2.0, 3.0])]);
    let rules = vec![rule(is(0, 0), then(0, 0))];
    let system = system(parts(vec![input], vec![output], vec![block(rules)]));
    assert!((value(&system, &[1.0]) - value(&system, &[-1.0])).abs() > 5.0);
    assert!(audited(&system).outputs[0].even.statement != Statement::Proved);
}

/// Both sets are written alike, but each names the first input: exchanged, they are others.
#[test]
fn inputs_are_not_proved_exchangeable_whose_sets_name_one_of_them() {
    let input = || input(0.0, 1.0, vec![set("x * a", &["x", "a", "b"])]);
    let output = averaged(vec![Conclusion::Constant(0.0), Conclusion::Constant(1.0)]);
    let rules = vec![
        rule(is(0, 0), then(0, 0)),
        rule(is(1, 0), then(0, 0)),
        rule(Antecedent::Always, then(0, 1)),
    ];
    let system = system(parts(vec![input(), input()], vec![output], vec![block(rules)]));
    assert!((value(&system, &[1.0, 0.0]) - value(&system, &[0.0, 1.0])).abs() > 0.4);
    let exchange = &audited(&system).outputs[0].exchange;
    let [(inputs, symmetry)] = &exchange[..] else { panic!("one pair") };
    assert_eq!(inputs, &[0, 1]);
    assert!(symmetry.statement != Statement::Proved);
}
