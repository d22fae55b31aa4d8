//! The paper's supervisor written out as a general system.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use super::defuzzifier::Defuzzifier;
use super::norms::{SNorm, TNorm};
use super::parts::{
    Activation, Antecedent, Conclusion, Consequent, Fallback, FallbackValue, Input, Membership,
    Output, OutputTerm, Parts, Rule, RuleBlock, Statement, Term, Universe, Variable,
};
use crate::label::Label;
use crate::membership::ShapeKind;
use crate::rule_table;
use crate::supervisor::Supervisor;

impl From<&Supervisor<f64>> for Parts {
    /// Inputs `error` and `change`, outputs `delta_kp`, `delta_ki`, `delta_kd`; answers the same bits.
    fn from(supervisor: &Supervisor<f64>) -> Self {
        let range = supervisor.range();
        let universe = Some(Universe { lower: -range, upper: range });
        let input = |name: &str| Input {
            name: name.to_string(),
            description: String::new(),
            enabled: true,
            universe,
            out_of_range: supervisor.out_of_range(),
            terms: input_terms(supervisor),
        };
        let defuzzifier = Defuzzifier::Centroid(supervisor.defuzzifier());
        let output = |name: &str| Output {
            name: name.to_string(),
            description: String::new(),
            enabled: true,
            universe,
            clamp: false,
            terms: output_terms(range),
            aggregation: SNorm::default(),
            defuzzifier,
            fallback: Fallback { previous: false, value: FallbackValue::Middle },
        };
        Self {
            name: "supervisor".to_string(),
            description: "Fuzzy supervisor of a self-tuning PID controller".to_string(),
            inputs: ["error", "change"].map(input).into(),
            outputs: ["delta_kp", "delta_ki", "delta_kd"].map(output).into(),
            blocks: vec![RuleBlock {
                name: String::new(),
                description: String::new(),
                enabled: true,
                and: TNorm::default(),
                or: SNorm::default(),
                implication: TNorm::default(),
                activation: Activation::General,
                rules: rules(supervisor),
            }],
        }
    }
}

fn input_terms(supervisor: &Supervisor<f64>) -> Vec<Term> {
    let term = |(label, params): (Label, &[f64; 2])| Term {
        name: label.name().to_string(),
        membership: shape(ShapeKind::Gaussian, params.to_vec()),
        lower: None,
    };
    Label::ALL.into_iter().zip(supervisor.sets()).map(term).collect()
}

fn output_terms(range: f64) -> Vec<OutputTerm> {
    let spacing = range / 3.0;
    let term = |(label, steps): (Label, i8)| {
        let centre = spacing * f64::from(steps);
        let corners = vec![centre - spacing, centre, centre + spacing];
        let membership = shape(ShapeKind::Triangle, corners);
        let conclusion = Conclusion::Set { membership, lower: None };
        OutputTerm { name: label.name().to_string(), conclusion }
    };
    Label::ALL.into_iter().zip(-3_i8..).map(term).collect()
}

fn shape(kind: ShapeKind, params: Vec<f64>) -> Membership {
    Membership::Shape { kind, params, height: 1.0 }
}

fn rules(supervisor: &Supervisor<f64>) -> Vec<Rule> {
    let table = supervisor.table();
    let is = |input, label: Label| {
        let variable = Variable::Input(input);
        Antecedent::Is(Statement { variable, term: Some(label.index()), hedges: Vec::new() })
    };
    let rule = |error: Label, change: Label| Rule {
        name: String::new(),
        enabled: true,
        antecedent: Antecedent::All(vec![is(0, error), is(1, change)]),
        consequents: rule_table::Output::ALL
            .into_iter()
            .enumerate()
            .map(|(output, gain)| Consequent {
                output,
                term: table.grid(gain).at(error, change).index(),
                hedges: Vec::new(),
            })
            .collect(),
        weight: 1.0,
    };
    Label::ALL
        .into_iter()
        .flat_map(|error| Label::ALL.into_iter().map(move |change| (error, change)))
        .map(|(error, change)| rule(error, change))
        .collect()
}
