//! Systems to begin with.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, Input, Membership,
    Output, OutputTerm, Parts, Rule, RuleBlock, SNorm, SetReading, Statement, TNorm, Term,
    Universe, Variable,
};

/// What rules conclude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// A number.
    Zero,
    /// A linear function of the inputs.
    One,
}

/// The curve of evenly spaced sets; neighbours cross at a grade of 0.5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// Gaussian, of width spacing / (2 √(2 ln 2)).
    Gaussian,
    /// Generalised bell, of width spacing / 2 and slope 2: where Jang (1993) begins.
    Bell,
    /// Triangle from neighbour to neighbour.
    Triangle,
}

/// 1 / (2 √(2 ln 2)), as in the paper's input sets.
const SIGMA_PER_SPACING: f64 = 0.424_660_900_144_009_53;

/// An input for [`grid`]: its name, where it lives, and how many sets it has.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name.
    pub name: String,
    /// From the middle of the first set to that of the last.
    pub universe: Universe,
    /// How many sets; at least 2.
    pub terms: usize,
}

/// A rule for each combination of evenly spaced sets, each with conclusions of its own that are 0 so far.
///
/// Firing strengths are products, answers weighted averages, and inputs outside of their universe are evaluated as they
/// are.
#[must_use]
pub fn grid(axes: &[Axis], outputs: &[&str], curve: Curve, order: Order) -> Parts {
    let counts: Vec<usize> = axes.iter().map(|axis| axis.terms.max(1)).collect();
    let total: usize = counts.iter().product();
    let parts = Parts {
        name: "grid".to_owned(),
        inputs: axes.iter().map(|axis| input(axis, curve)).collect(),
        outputs: outputs.iter().map(|name| empty_output(name)).collect(),
        blocks: vec![RuleBlock {
            name: String::new(),
            description: String::new(),
            enabled: true,
            and: TNorm::Kind(TNormKind::AlgebraicProduct),
            or: SNorm::default(),
            implication: TNorm::Kind(TNormKind::AlgebraicProduct),
            activation: Activation::General,
            rules: (0..total).map(|index| rule(&counts, index, outputs.len())).collect(),
        }],
        ..Parts::default()
    };
    sugeno(&parts, order)
}

/// The same inputs and premises, with a conclusion of its own for each rule and output; all are 0 so far. Norms stay, and
/// hedges of conclusions go.
#[must_use]
pub fn sugeno(parts: &Parts, order: Order) -> Parts {
    let mut sugeno = parts.clone();
    for output in &mut sugeno.outputs {
        output.terms.clear();
        output.defuzzifier = Defuzzifier::WeightedAverage(SetReading::default());
        output.clamp = false;
    }
    let (inputs, mut number) = (parts.inputs.len(), 0);
    for rule in sugeno.blocks.iter_mut().flat_map(|block| &mut block.rules) {
        number += 1;
        let mut seen = Vec::new();
        rule.consequents.retain(|consequent| {
            let is_first = !seen.contains(&consequent.output);
            seen.push(consequent.output);
            is_first
        });
        for consequent in &mut rule.consequents {
            let Some(output) = sugeno.outputs.get_mut(consequent.output) else { continue };
            let conclusion = match order {
                Order::Zero => Conclusion::Constant(0.0),
                Order::One => Conclusion::Linear { coefficients: vec![0.0; inputs], constant: 0.0 },
            };
            consequent.term = output.terms.len();
            consequent.hedges.clear();
            output.terms.push(OutputTerm { name: format!("rule {number}"), conclusion });
        }
    }
    sugeno
}

fn input(axis: &Axis, curve: Curve) -> Input {
    let Universe { lower, upper } = axis.universe;
    let steps = axis.terms.saturating_sub(1).max(1) as f64;
    let spacing = (upper - lower) / steps;
    let term = |index: usize| {
        let share = index as f64 / steps;
        let centre = lower * (1.0 - share) + upper * share;
        let (kind, params) = match curve {
            Curve::Gaussian => (ShapeKind::Gaussian, vec![centre, spacing * SIGMA_PER_SPACING]),
            Curve::Bell => (ShapeKind::Bell, vec![centre, 0.5 * spacing, 2.0]),
            Curve::Triangle => {
                (ShapeKind::Triangle, vec![centre - spacing, centre, centre + spacing])
            }
        };
        let membership = Membership::Shape { kind, params, height: 1.0 };
        Term { name: format!("set {}", index + 1), membership, lower: None }
    };
    Input {
        name: axis.name.clone(),
        description: String::new(),
        enabled: true,
        universe: Some(axis.universe),
        out_of_range: OutOfRange::Evaluate,
        terms: (0..axis.terms).map(term).collect(),
    }
}

fn empty_output(name: &str) -> Output {
    Output {
        name: name.to_owned(),
        description: String::new(),
        enabled: true,
        universe: None,
        clamp: false,
        terms: Vec::new(),
        aggregation: SNorm::default(),
        defuzzifier: Defuzzifier::WeightedAverage(SetReading::default()),
        fallback: Fallback::default(),
    }
}

/// The rule of a combination; the last input runs fastest.
fn rule(counts: &[usize], index: usize, outputs: usize) -> Rule {
    let mut rest = index;
    let mut statements: Vec<Antecedent> = counts
        .iter()
        .enumerate()
        .rev()
        .map(|(input, &count)| {
            let term = Some(rest % count);
            rest /= count;
            Antecedent::Is(Statement { variable: Variable::Input(input), term, hedges: Vec::new() })
        })
        .collect();
    statements.reverse();
    let consequent = |output| Consequent { output, term: 0, hedges: Vec::new() };
    Rule {
        name: String::new(),
        enabled: true,
        antecedent: Antecedent::All(statements),
        consequents: (0..outputs).map(consequent).collect(),
        weight: 1.0,
    }
}
