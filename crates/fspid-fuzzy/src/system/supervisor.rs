//! The supervisor of rules written out as a general system.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use super::defuzzifier::{Defuzzifier, SetReading};
use super::norms::{SNorm, TNorm};
use super::parts::{
    Activation, Antecedent, Conclusion, Consequent, Fallback, FallbackValue, Input, Membership,
    Output, OutputTerm, Parts, Rule, RuleBlock, Statement, Term, Universe, Variable,
};
use crate::label::{LABEL_COUNT, Label};
use crate::membership::ShapeKind;
use crate::norm::TNormKind;
use crate::number_table::NumberGrid;
use crate::rule_table;
use crate::supervisor::Supervisor;

/// Why a supervisor is no general system: it is a network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoRules;

impl fmt::Display for NoRules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the supervisor is a network: it has no sets and no rules")
    }
}

impl core::error::Error for NoRules {}

impl TryFrom<&Supervisor<f64>> for Parts {
    type Error = NoRules;

    /// Inputs `error` and `change`, outputs `delta_kp`, `delta_ki`, `delta_kd`; answers the same bits, and
    /// where rules conclude numbers the same but for rounding.
    fn try_from(supervisor: &Supervisor<f64>) -> Result<Self, NoRules> {
        if supervisor.network().is_some() {
            return Err(NoRules);
        }
        let range = supervisor.range();
        let universe = Some(Universe { lower: -range, upper: range });
        let numbers = supervisor.numbers();
        let input = |name: &str| Input {
            name: name.to_string(),
            description: String::new(),
            enabled: true,
            universe,
            out_of_range: supervisor.out_of_range(),
            terms: input_terms(supervisor),
        };
        let output = |gain: rule_table::Output| Output {
            name: gain.name().to_string(),
            description: String::new(),
            enabled: true,
            universe,
            clamp: false,
            terms: match numbers {
                None => output_terms(range),
                Some(table) => number_terms(table.grid(gain)),
            },
            aggregation: SNorm::default(),
            defuzzifier: match numbers {
                None => Defuzzifier::Centroid(supervisor.defuzzifier()),
                Some(_) => Defuzzifier::WeightedAverage(SetReading::default()),
            },
            fallback: Fallback { previous: false, value: FallbackValue::Middle },
        };
        let product = || match numbers {
            None => TNorm::default(),
            Some(_) => TNormKind::AlgebraicProduct.into(),
        };
        Ok(Self {
            name: "supervisor".to_string(),
            description: "Fuzzy supervisor of a self-tuning PID controller".to_string(),
            inputs: ["error", "change"].map(input).into(),
            outputs: rule_table::Output::ALL.map(output).into(),
            blocks: vec![RuleBlock {
                name: String::new(),
                description: String::new(),
                enabled: true,
                and: product(),
                or: SNorm::default(),
                implication: product(),
                activation: Activation::General,
                rules: rules(supervisor),
            }],
        })
    }
}

fn input_terms(supervisor: &Supervisor<f64>) -> Vec<Term> {
    let has_numbers = supervisor.numbers().is_some();
    let term = |(label, &[centre, width]): (Label, &[f64; 2])| Term {
        name: label.name().to_string(),
        membership: match label {
            _ if !has_numbers => shape(ShapeKind::Gaussian, vec![centre, width]),
            // Level outwards, as the supervisor is beyond its range.
            Label::NB => shape(ShapeKind::LinearZ, vec![centre, centre + width]),
            Label::PB => shape(ShapeKind::LinearS, vec![centre - width, centre]),
            _ => shape(ShapeKind::Triangle, vec![centre - width, centre, centre + width]),
        },
        lower: None,
    };
    Label::ALL.into_iter().zip(supervisor.sets()).map(term).collect()
}

/// A conclusion for each cell, row by row.
fn number_terms(grid: &NumberGrid<f64>) -> Vec<OutputTerm> {
    let cells = Label::ALL.into_iter().zip(grid).flat_map(|(error, row)| {
        Label::ALL.into_iter().zip(row).map(move |(change, number)| (error, change, *number))
    });
    let term = |(error, change, number): (Label, Label, f64)| OutputTerm {
        name: [error.name(), change.name()].join("_"),
        conclusion: Conclusion::Constant(number),
    };
    cells.map(term).collect()
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
                term: match &table {
                    Some(table) => table.grid(gain).at(error, change).index(),
                    None => error.index() * LABEL_COUNT + change.index(),
                },
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
