//! Symmetries that follow from the parts of a system, without any arithmetic on its surface.
//!
//! If mirroring every input set gives a set of the same input, and mirroring every rule a rule of
//! the same base, then the surface is its own mirror image. Sets are compared exactly: the sum of
//! two mirrored places must be twice the middle to the last bit.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::objective::Image;
use crate::audit::rule_base::canonical;
use crate::membership::{ShapeKind, Vertex};
use crate::norm::SNormKind;
use crate::system::{
    Activation, Antecedent, Conclusion, Consequent, Defuzzifier, FallbackValue, Input, Membership,
    Output, Parts, Rule, RuleBlock, SNorm, Sampling, Statement, TNorm, Universe, Variable,
};
use fspid_numeric::scalar::Interval;

/// A mirroring of inputs and, if it has a middle, of the output.
pub(super) struct Mirror<'m> {
    pub(super) image: Image,
    pub(super) domain: &'m [Interval],
    pub(super) about: Option<f64>,
}

impl Mirror<'_> {
    /// True if the surface of an output is proved to be its own mirror image.
    pub(super) fn keeps(&self, parts: &Parts, output: usize) -> bool {
        self.check(parts, output).is_some()
    }

    fn check(&self, parts: &Parts, index: usize) -> Option<()> {
        let output = parts.outputs.get(index)?;
        let sets = parts.inputs.iter().flat_map(|input| &input.terms);
        if sets.into_iter().any(|term| depends_on_others(&term.membership, parts)) {
            return None;
        }
        let terms = self.output_terms(parts, output)?;
        let inputs: Option<Vec<_>> =
            (0..parts.inputs.len()).map(|input| self.input_terms(parts, input)).collect();
        let inputs = inputs?;
        let maps = Maps { inputs: &inputs, terms: &terms, output: index };
        let keeps = |block: &RuleBlock| joins_by_norms(block) && maps.keep(block).unwrap_or(false);
        let kept = parts.blocks.iter().all(|block| !block.enabled || keeps(block));
        (kept && output.enabled).then_some(())
    }

    /// For each term of an input the input and term that are its image.
    fn input_terms(&self, parts: &Parts, index: usize) -> Option<Vec<(usize, usize)>> {
        let input = parts.inputs.get(index)?;
        let target = self.image.input(index);
        let other = parts.inputs.get(target)?;
        let side = self.domain.get(index)?;
        if !self.same_frame(input, other, *side, self.domain.get(target)?) {
            return None;
        }
        let centre = Interval::point(side.lower()) + Interval::point(side.upper());
        let is_image = |one: &Membership, found: &Membership| match self.image {
            Image::Opposite => mirrors(one, found, centre),
            Image::Exchanged(_) => one == found,
        };
        let image = |membership: &Membership| {
            other
                .terms
                .iter()
                .position(|term| term.lower.is_none() && is_image(membership, &term.membership))
        };
        let plain = input.terms.iter().all(|term| term.lower.is_none());
        let images: Option<Vec<usize>> =
            input.terms.iter().map(|term| image(&term.membership)).collect();
        plain.then_some(images?.into_iter().map(|term| (target, term)).collect())
    }

    /// What happens outside of the universe must be mirrored too.
    fn same_frame(&self, input: &Input, other: &Input, side: Interval, twin: &Interval) -> bool {
        let ends = |u: Universe| Interval::point(u.lower) + Interval::point(u.upper);
        let centre = Interval::point(side.lower()) + Interval::point(side.upper());
        match self.image {
            Image::Opposite => {
                centre.is_point() && input.universe.is_none_or(|u| ends(u) == centre)
            }
            Image::Exchanged(_) => {
                input.enabled == other.enabled
                    && input.universe == other.universe
                    && input.out_of_range == other.out_of_range
                    && side == *twin
            }
        }
    }

    /// For each term of the output the one that is its image.
    fn output_terms(&self, parts: &Parts, output: &Output) -> Option<Vec<usize>> {
        // These depend on the order of the rules.
        let is_formula = matches!(output.aggregation, SNorm::Formula(_));
        if is_formula || output.aggregation.is(SNormKind::NormalizedSum) {
            return None;
        }
        let all = output.terms.iter();
        let plain = output.terms.iter().all(|term| match &term.conclusion {
            Conclusion::Constant(_) => true,
            Conclusion::Set { membership, lower: None } => !depends_on_others(membership, parts),
            _ => false,
        });
        let Some(about) = self.about else {
            return plain.then_some((0..output.terms.len()).collect());
        };
        if !plain || !mirrored_method(output, about) {
            return None;
        }
        let centre = Interval::point(2.0 * about);
        let images = all.map(|term| {
            output.terms.iter().position(|other| match (&term.conclusion, &other.conclusion) {
                (Conclusion::Constant(one), Conclusion::Constant(found)) => {
                    Interval::point(*one) + Interval::point(*found) == centre
                }
                (
                    Conclusion::Set { membership: one, .. },
                    Conclusion::Set { membership: found, .. },
                ) => mirrors(one, found, centre),
                _ => false,
            })
        });
        images.collect()
    }
}

/// True if a set is a formula in more than its own variable: it is another set at the mirrored point.
fn depends_on_others(set: &Membership, parts: &Parts) -> bool {
    let others = parts.inputs.len() + parts.outputs.len();
    match set {
        Membership::Formula { formula, .. } => (1..=others).any(|other| formula.uses(other)),
        Membership::Shape { .. } => false,
    }
}

/// True if a block joins by norms, which do not ask for an order.
fn joins_by_norms(block: &RuleBlock) -> bool {
    let joins = matches!(block.and, TNorm::Kind(_)) && matches!(block.or, SNorm::Kind(_));
    joins && matches!(block.implication, TNorm::Kind(_))
}

/// Whether an output's method treats both directions alike.
fn mirrored_method(output: &Output, about: f64) -> bool {
    let even =
        |sampling: Sampling| !matches!(sampling, Sampling::LeftEnd(_) | Sampling::Vertices(_));
    let method = match output.defuzzifier {
        Defuzzifier::Centroid(sampling) => even(sampling),
        Defuzzifier::WeightedAverage(_) => {
            output.terms.iter().all(|term| matches!(term.conclusion, Conclusion::Constant(_)))
        }
        _ => false,
    };
    let middle = |u: Universe| Interval::point(u.lower) + Interval::point(u.upper);
    let universe = output.universe.map(middle).is_none_or(|m| m == Interval::point(2.0 * about));
    let fallback = !output.fallback.previous
        && match output.fallback.value {
            FallbackValue::Middle | FallbackValue::Nothing => true,
            FallbackValue::Number(number) => number.total_cmp(&about).is_eq(),
        };
    method && universe && fallback
}

/// True if two sets are mirror images about half of `centre`, without jumps, to the last bit.
fn mirrors(one: &Membership, other: &Membership, centre: Interval) -> bool {
    let (
        Membership::Shape { kind, params, height },
        Membership::Shape { kind: other_kind, params: other_params, height: other_height },
    ) = (one, other)
    else {
        return false;
    };
    if height.total_cmp(other_height).is_ne() {
        return false;
    }
    let meet = |x: f64, y: f64| Interval::point(x) + Interval::point(y) == centre;
    if let (ShapeKind::Gaussian, ShapeKind::Gaussian) = (kind, other_kind) {
        let (&[c, sigma], &[d, tau]) = (params.as_slice(), other_params.as_slice()) else {
            return false;
        };
        return meet(c, d) && sigma.total_cmp(&tau).is_eq();
    }
    let (left, right) = (corners(*kind, params), corners(*other_kind, other_params));
    let jumps = left.windows(2).any(|pair| match pair {
        [one, two] => one.x >= two.x,
        _ => false,
    });
    let alike = left
        .iter()
        .zip(right.iter().rev())
        .all(|(one, two)| meet(one.x, two.x) && one.grade.total_cmp(&two.grade).is_eq());
    !left.is_empty() && left.len() == right.len() && alike && !jumps
}

fn corners(kind: ShapeKind, params: &[f64]) -> Vec<Vertex> {
    let mut corners = Vec::new();
    if kind.is_piecewise_linear() {
        kind.vertices(params, &mut |vertex| corners.push(vertex));
    }
    corners
}

/// Where terms go.
struct Maps<'m> {
    inputs: &'m [Vec<(usize, usize)>],
    terms: &'m [usize],
    output: usize,
}

impl Maps<'_> {
    /// Whether the rules of a block about the output are the same after mirroring; `None` for rules
    /// that cannot be mirrored.
    fn keep(&self, block: &RuleBlock) -> Option<bool> {
        let fair = matches!(
            block.activation,
            Activation::General | Activation::Proportional | Activation::Threshold { .. }
        );
        let rules = || block.rules.iter().filter(|rule| rule.enabled);
        let images: Option<Vec<String>> =
            rules().map(|rule| self.image(rule, block, true)).collect();
        let originals: Option<Vec<String>> =
            rules().map(|rule| self.image(rule, block, false)).collect();
        let [mut images, mut originals] = [images?, originals?];
        images.sort();
        originals.sort();
        Some(fair && images == originals)
    }

    /// A rule in words that can be compared.
    fn image(&self, rule: &Rule, block: &RuleBlock, mirrored: bool) -> Option<String> {
        let antecedent =
            if mirrored { self.antecedent(&rule.antecedent)? } else { rule.antecedent.clone() };
        let consequents = rule.consequents.iter().filter(|c| c.output == self.output);
        let consequents: Option<Vec<Consequent>> = consequents
            .map(|consequent| {
                let term =
                    if mirrored { *self.terms.get(consequent.term)? } else { consequent.term };
                Some(Consequent { term, ..consequent.clone() })
            })
            .collect();
        let antecedent = canonical(&antecedent, block);
        Some(format!("{antecedent:?} {:?} {:?}", consequents?, rule.weight))
    }

    fn antecedent(&self, antecedent: &Antecedent) -> Option<Antecedent> {
        let each = |parts: &[Antecedent]| {
            parts.iter().map(|part| self.antecedent(part)).collect::<Option<Vec<_>>>()
        };
        Some(match antecedent {
            Antecedent::Always => Antecedent::Always,
            Antecedent::Is(statement) => Antecedent::Is(self.statement(statement)?),
            Antecedent::All(parts) => Antecedent::All(each(parts)?),
            Antecedent::Any(parts) => Antecedent::Any(each(parts)?),
            Antecedent::Not(part) => Antecedent::Not(self.antecedent(part)?.into()),
        })
    }

    fn statement(&self, statement: &Statement) -> Option<Statement> {
        let Variable::Input(input) = statement.variable else { return None };
        let &(input, term) = self.inputs.get(input)?.get(statement.term?)?;
        let variable = Variable::Input(input);
        Some(Statement { variable, term: Some(term), hedges: statement.hedges.clone() })
    }
}
