//! Random small systems against answers of 30 digits, made by `oracles/make_systems.py`.

use fspid_fuzzy::membership::ShapeKind::Trapezoid;
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{Antecedent, Defuzzifier, Membership, Parts, Sampling};

use crate::system::build::{
    answers, block, input, is, output, parts, rule, sets, shape, system, then,
};

/// A system and what is known of its answers.
#[derive(Default)]
struct Case {
    norms: Vec<String>,
    values: Vec<f64>,
    inputs: Vec<Vec<Membership>>,
    universe: [f64; 2],
    terms: Vec<Membership>,
    rules: Vec<String>,
    known: Vec<(String, f64)>,
}

fn number(word: &str) -> f64 {
    word.parse().expect("a number")
}

fn place(word: &str) -> usize {
    word.parse().expect("a position")
}

impl Case {
    fn parse(text: &str) -> Self {
        let mut case = Self::default();
        let mut about_output = false;
        for line in text.lines() {
            let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
            let numbers = || rest.split(' ').map(number).collect::<Vec<_>>();
            match word {
                "norms" => case.norms = rest.split(' ').map(String::from).collect(),
                "input" => {
                    case.values.push(number(rest));
                    case.inputs.push(Vec::new());
                }
                "output" => {
                    case.universe = numbers().try_into().expect("two ends");
                    about_output = true;
                }
                "set" if about_output => case.terms.push(shape(Trapezoid, &numbers())),
                "set" => {
                    case.inputs.last_mut().expect("an input").push(shape(Trapezoid, &numbers()))
                }
                "rule" => case.rules.push(rest.to_string()),
                "nothing" => {}
                method => case.known.push((method.to_string(), number(rest))),
            }
        }
        case
    }

    fn parts(&self) -> Parts {
        let inputs = self.inputs.iter().map(|sets| input(0.0, 1.0, sets.clone())).collect();
        let [lower, upper] = self.universe;
        let mut out = output(lower, upper, sets(self.terms.clone()));
        let mut rules = block(self.rules.iter().map(|text| parse_rule(text)).collect());
        let t_norm = |n: usize| TNormKind::from_name(&self.norms[n]).expect("a t-norm").into();
        let s_norm = |n: usize| SNormKind::from_name(&self.norms[n]).expect("an s-norm").into();
        (rules.and, rules.or, rules.implication) = (t_norm(0), s_norm(1), t_norm(2));
        out.aggregation = s_norm(3);
        parts(inputs, vec![out], vec![rules])
    }
}

/// Weight, word, term, then `is` or `not`, input and term of each statement.
fn parse_rule(text: &str) -> fspid_fuzzy::system::Rule {
    let words: Vec<&str> = text.split(' ').collect();
    let statements = words[3..].chunks(3).map(|said| {
        let plain = is(place(said[1]), place(said[2]));
        if said[0] == "not" { Antecedent::Not(Box::new(plain)) } else { plain }
    });
    let statements: Vec<Antecedent> = statements.collect();
    let antecedent = match words[1] {
        "and" => Antecedent::All(statements),
        "or" => Antecedent::Any(statements),
        _ => statements[0].clone(),
    };
    let mut rule = rule(antecedent, then(0, place(words[2])));
    rule.weight = number(words[0]);
    rule
}

#[test]
fn random_systems_have_the_answers_of_thirty_digits() {
    let (mut compared, mut worst) = (0, 0.0_f64);
    for (n, text) in include_str!("../data/systems.txt").trim().split("\n\n").enumerate() {
        let case = Case::parse(text);
        let span = case.universe[1] - case.universe[0];
        for (name, expected) in &case.known {
            let method = Defuzzifier::from_name(name).expect("a method");
            let mut parts = case.parts();
            parts.outputs[0].defuzzifier = method.with_sampling(Sampling::Exact);
            let answer = answers(&system(parts), &case.values)[0];
            let found = answer.value.unwrap_or_else(|| panic!("{n} {name}: {text}"));
            let error = (found - expected).abs();
            assert!(
                error <= answer.error_bound + 1e-13 * span && error < 1e-6 * span,
                "{n} {name}: {found:e} {expected:e} {answer:?}\n{text}"
            );
            let integral = matches!(method, Defuzzifier::Centroid(_) | Defuzzifier::Bisector(_));
            assert!(!integral || answer.error_bound < 1e-11 * span, "{n} {name}: {answer:?}");
            worst = worst.max(if answer.error_bound > 0.0 { 0.0 } else { error / span });
            compared += 1;
        }
        if case.known.is_empty() {
            assert_eq!(answers(&system(case.parts()), &case.values)[0].value, None, "{n}: {text}");
        }
    }
    println!("{compared} answers; worst error of a polygon, in universes: {worst:.2e}");
}
