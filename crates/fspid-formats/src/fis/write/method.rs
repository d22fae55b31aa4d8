//! The methods that hold for the whole file, from what each output and each block says for itself.

use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Defuzzifier, Output, Parts, RuleBlock, SNorm, TNorm,
};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::losses::Losses;
use crate::fis::word::{DEFUZZIFIERS, MATLAB, S_NORMS, T_NORMS, find, matlab_word};

/// Words of `[System]`.
#[derive(Debug)]
pub(super) struct Methods {
    pub(super) sugeno: bool,
    pub(super) and: &'static str,
    pub(super) or: &'static str,
    pub(super) implication: &'static str,
    pub(super) aggregation: &'static str,
    pub(super) defuzzifier: &'static str,
}

/// What each key may say in MATLAB, the default first.
const AND: &[&str] = &["min", "prod"];
const OR: &[&str] = &["max", "probor"];
const AGGREGATION: &[&str] = &["max", "sum", "probor"];

impl Methods {
    /// One set of methods for all outputs and blocks.
    pub(super) fn of(parts: &Parts, losses: &mut Losses) -> Self {
        let sugeno = is_sugeno(&parts.outputs, losses);
        let blocks: Vec<_> = parts.blocks.iter().filter(|block| acts(block)).collect();
        blocks.iter().for_each(|block| every_rule_acts(block, losses));
        let joined = |joins: fn(&Antecedent) -> bool| {
            move |block: &&&RuleBlock| block.rules.iter().any(|rule| joins(&rule.antecedent))
        };
        let and = blocks.iter().filter(joined(joins_by_and)).map(|block| &block.and);
        let or = blocks.iter().filter(joined(joins_by_or)).map(|block| &block.or);
        let implication = blocks.iter().filter(|_| !sugeno).map(|block| &block.implication);
        let aggregation =
            parts.outputs.iter().filter(|_| !sugeno).map(|output| &output.aggregation);
        let (weighs, sums) = ("prod", "sum");
        Self {
            sugeno,
            and: match one("and", and, losses) {
                None => idle(parts.blocks.first().map(|block| &block.and)),
                used => t_norm("and", used, losses),
            },
            or: match one("or", or, losses) {
                None => idle_or(parts.blocks.first().map(|block| &block.or)),
                used => s_norm("or", used, OR, losses),
            },
            implication: match one("implication", implication, losses) {
                None if sugeno => weighs,
                None => idle(parts.blocks.first().map(|block| &block.implication)),
                found => t_norm("implication", found, losses),
            },
            aggregation: match one("aggregation", aggregation, losses) {
                None if sugeno => sums,
                found => s_norm("aggregation", found, AGGREGATION, losses),
            },
            defuzzifier: defuzzifier(&parts.outputs, losses),
        }
    }

    /// True if rules that conclude the same may be split and joined: their strengths are joined by
    /// the maximum, whatever is written.
    pub(super) fn splits_or(&self) -> bool {
        !self.sugeno && self.or == "max" && self.aggregation == "max"
    }

    /// True if one minus an *and* is the *or* of what is left of 1.
    pub(super) fn mirrors(&self) -> bool {
        matches!((self.and, self.or), ("min", "max") | ("prod", "probor"))
    }
}

/// True for a block with an effect.
pub(super) fn acts(block: &RuleBlock) -> bool {
    block.enabled && !block.rules.is_empty()
}

fn joins_by_and(antecedent: &Antecedent) -> bool {
    match antecedent {
        Antecedent::All(parts) => parts.len() > 1 || parts.iter().any(joins_by_and),
        Antecedent::Any(parts) => parts.iter().any(joins_by_and),
        Antecedent::Not(part) => joins_by_and(part),
        _ => false,
    }
}

fn joins_by_or(antecedent: &Antecedent) -> bool {
    match antecedent {
        Antecedent::Any(parts) => parts.len() > 1 || parts.iter().any(joins_by_or),
        Antecedent::All(parts) => parts.iter().any(joins_by_or),
        Antecedent::Not(part) => joins_by_or(part),
        _ => false,
    }
}

fn every_rule_acts(block: &RuleBlock, losses: &mut Losses) {
    if block.activation != Activation::General {
        losses.lost("in the file every rule acts as strongly as it fires");
    }
}

/// The only one there is, or the first with a loss.
fn one<'a, T: PartialEq>(
    what: &str,
    mut found: impl Iterator<Item = &'a T>,
    losses: &mut Losses,
) -> Option<&'a T> {
    let first = found.next()?;
    if found.any(|other| other != first) {
        losses.lost(format!("the file has one `{what}` for all; that of the first is taken"));
    }
    Some(first)
}

/// The word for a norm that no rule uses, if there is one.
fn idle(norm: Option<&TNorm>) -> &'static str {
    let word =
        norm.and_then(
            |norm| if let TNorm::Kind(kind) = norm { matlab_word(T_NORMS, kind) } else { None },
        );
    word.unwrap_or("min")
}

fn idle_or(norm: Option<&SNorm>) -> &'static str {
    let word =
        norm.and_then(
            |norm| if let SNorm::Kind(kind) = norm { matlab_word(S_NORMS, kind) } else { None },
        );
    word.filter(|word| OR.contains(word)).unwrap_or("max")
}

fn t_norm(what: &str, norm: Option<&TNorm>, losses: &mut Losses) -> &'static str {
    let Some(norm) = norm else { return "min" };
    let known = AND.iter().copied();
    let kinds = known.filter_map(|name| find(T_NORMS, name)).map(|word| word.means);
    match norm {
        TNorm::Kind(kind) if kinds.clone().any(|known| known == *kind) => {
            matlab_word(T_NORMS, kind).unwrap_or("min")
        }
        _ => nearest(
            what,
            kinds.map(|kind: TNormKind| {
                let name = matlab_word(T_NORMS, &kind).unwrap_or("min");
                (name, largest(|a, b| norm.apply(a, b) - kind.apply(a, b)))
            }),
            losses,
        ),
    }
}

fn s_norm(
    what: &str,
    norm: Option<&SNorm>,
    known: &[&'static str],
    losses: &mut Losses,
) -> &'static str {
    let Some(norm) = norm else { return "max" };
    let kinds = known.iter().filter_map(|name| find(S_NORMS, name)).map(|word| word.means);
    match norm {
        SNorm::Kind(kind) if kinds.clone().any(|known| known == *kind) => {
            matlab_word(S_NORMS, kind).unwrap_or("max")
        }
        _ => nearest(
            what,
            kinds.map(|kind: SNormKind| {
                let name = matlab_word(S_NORMS, &kind).unwrap_or("max");
                (name, largest(|a, b| norm.apply(a, b) - kind.apply(a, b)))
            }),
            losses,
        ),
    }
}

/// The candidate with the smallest error.
fn nearest(
    what: &str,
    candidates: impl Iterator<Item = (&'static str, f64)>,
    losses: &mut Losses,
) -> &'static str {
    let best = candidates.min_by(|(_, a), (_, b)| a.total_cmp(b));
    let (name, error) = best.unwrap_or(("min", 1.0));
    losses.lost(format!("the file has no such `{what}`; `{name}` differs by up to {error:.3}"));
    name
}

/// Largest absolute value over a lattice of pairs of grades.
fn largest(difference: impl Fn(f64, f64) -> f64) -> f64 {
    let grade = |step: u8| f64::from(step) / 100.0;
    let pairs = (0..=100).flat_map(|a| (0..=100).map(move |b| (grade(a), grade(b))));
    pairs.map(|(a, b)| difference(a, b).abs()).fold(0.0, f64::max)
}

fn is_sugeno(outputs: &[Output], losses: &mut Losses) -> bool {
    let weighs = |output: &&Output| output.defuzzifier.sampling().is_none();
    let number = outputs.iter().filter(weighs).count();
    if number > 0 && number < outputs.len() {
        losses
            .never("a file is either Mamdani or Sugeno; some outputs are joined, others weighted");
    }
    let is_set = |conclusion: &Conclusion| matches!(conclusion, Conclusion::Set { .. });
    let terms = outputs.iter().filter(weighs).flat_map(|output| &output.terms);
    if terms.into_iter().any(|term| is_set(&term.conclusion)) {
        losses
            .never("MATLAB weights numbers and linear functions only, not fuzzy sets (Tsukamoto)");
    }
    number > 0
}

fn defuzzifier(outputs: &[Output], losses: &mut Losses) -> &'static str {
    let methods = outputs.iter().map(|output| &output.defuzzifier);
    let method = one("defuzzifier", methods, losses).copied().unwrap_or_default();
    if let Some(sampling) = method.sampling().filter(|sampling| *sampling != MATLAB) {
        losses.lost(format!("integrals are `{sampling}`; the file stands for `{MATLAB}`"));
    }
    let written = DEFUZZIFIERS.iter().find(|word| word.matlab && same(word.means, method));
    written.map_or("centroid", |word| word.name)
}

/// True for the same method, however integrals are computed.
fn same(one: Defuzzifier, other: Defuzzifier) -> bool {
    one.name() == other.name()
}
