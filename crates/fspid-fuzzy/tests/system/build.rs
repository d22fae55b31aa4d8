//! Short ways to write systems down.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Activation, Answer, Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, Input,
    Membership, Output, OutputTerm, Parts, Rule, RuleBlock, SNorm, Statement, System, TNorm, Term,
    Universe, Variable,
};

pub(crate) fn shape(kind: ShapeKind, params: &[f64]) -> Membership {
    Membership::Shape { kind, params: params.to_vec(), height: 1.0 }
}

pub(crate) fn triangle(left: f64, peak: f64, right: f64) -> Membership {
    shape(ShapeKind::Triangle, &[left, peak, right])
}

/// An input over `[lower, upper]` with sets numbered from 0.
pub(crate) fn input(lower: f64, upper: f64, sets: Vec<Membership>) -> Input {
    let term = |(index, membership)| Term { name: format!("t{index}"), membership, lower: None };
    Input {
        name: String::new(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower, upper }),
        out_of_range: OutOfRange::Evaluate,
        terms: sets.into_iter().enumerate().map(term).collect(),
    }
}

/// Inputs whose value is the grade of their only set.
pub(crate) fn grades(count: usize) -> Vec<Input> {
    (0..count).map(|_| input(0.0, 1.0, vec![triangle(0.0, 1.0, 2.0)])).collect()
}

/// An output over `[lower, upper]` with the exact centroid by maximum.
pub(crate) fn output(lower: f64, upper: f64, conclusions: Vec<Conclusion>) -> Output {
    let term = |(index, conclusion)| OutputTerm { name: format!("t{index}"), conclusion };
    Output {
        name: String::new(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower, upper }),
        clamp: false,
        terms: conclusions.into_iter().enumerate().map(term).collect(),
        aggregation: SNorm::default(),
        defuzzifier: Defuzzifier::default(),
        fallback: Fallback::default(),
    }
}

pub(crate) fn sets(sets: Vec<Membership>) -> Vec<Conclusion> {
    sets.into_iter().map(|membership| Conclusion::Set { membership, lower: None }).collect()
}

pub(crate) fn is(input: usize, term: usize) -> Antecedent {
    let variable = Variable::Input(input);
    Antecedent::Is(Statement { variable, term: Some(term), hedges: Vec::new() })
}

pub(crate) fn then(output: usize, term: usize) -> Consequent {
    Consequent { output, term, hedges: Vec::new() }
}

pub(crate) fn rule(antecedent: Antecedent, consequent: Consequent) -> Rule {
    let consequents = vec![consequent];
    Rule { name: String::new(), enabled: true, antecedent, consequents, weight: 1.0 }
}

pub(crate) fn block(rules: Vec<Rule>) -> RuleBlock {
    RuleBlock {
        name: String::new(),
        description: String::new(),
        enabled: true,
        and: TNorm::default(),
        or: SNorm::default(),
        implication: TNorm::default(),
        activation: Activation::General,
        rules,
    }
}

/// Names the variables and puts them together.
pub(crate) fn parts(inputs: Vec<Input>, outputs: Vec<Output>, blocks: Vec<RuleBlock>) -> Parts {
    let mut parts = Parts { inputs, outputs, blocks, ..Parts::default() };
    for (index, input) in parts.inputs.iter_mut().enumerate() {
        input.name = format!("in{index}");
    }
    for (index, output) in parts.outputs.iter_mut().enumerate() {
        output.name = format!("out{index}");
    }
    parts
}

/// One output; rule i concludes term i as strongly as input i says.
pub(crate) fn graded(output: Output) -> Parts {
    let count = output.terms.len();
    let rules = (0..count).map(|term| rule(is(term, 0), then(0, term))).collect();
    parts(grades(count), vec![output], vec![block(rules)])
}

pub(crate) fn system(parts: Parts) -> System {
    System::new(parts).unwrap_or_else(|errors| {
        panic!("{}", errors.iter().map(|e| format!("{e}\n")).collect::<String>())
    })
}

pub(crate) fn answers(system: &System, inputs: &[f64]) -> Vec<Answer> {
    system.evaluate(inputs, &mut system.workspace()).expect("allowed inputs").to_vec()
}

/// The value of the first output.
pub(crate) fn value(parts: Parts, inputs: &[f64]) -> f64 {
    answers(&system(parts), inputs)[0].value.expect("an answer")
}
