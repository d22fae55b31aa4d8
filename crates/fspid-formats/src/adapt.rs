//! Steps towards the nearest system that a format can say.

use fspid_fuzzy::Formula;
use fspid_fuzzy::system::{
    FallbackValue, Input, Membership, Output, Parts, Sampling, Universe, Variable,
};

use crate::loss::Loss;

/// Advice for interval type-2 systems.
pub(crate) const TYPE_1: &str = "a type-1 system";

/// Rules that are switched off never fire: leaving them out changes no answer.
pub(crate) fn without_disabled_rules(parts: &mut Parts, loss: &mut Loss) {
    for block in &mut parts.blocks {
        let before = block.rules.len();
        block.rules.retain(|rule| rule.enabled);
        let gone = before - block.rules.len();
        if gone > 0 {
            loss.note(format!("{gone} rules that are switched off are left out"));
        }
    }
}

/// True if some rule asks how strongly an output has been concluded: its aggregation counts even where a
/// weighted method makes nothing of it.
pub(crate) fn is_asked(parts: &Parts, output: usize) -> bool {
    let mut rules = parts.blocks.iter().flat_map(|block| &block.rules);
    rules.any(|rule| rule.antecedent.asks(&|variable| variable == Variable::Output(output)))
}

/// For formats whose rules have no names.
pub(crate) fn without_rule_names(parts: &mut Parts, loss: &mut Loss) {
    let mut gone = 0;
    for rule in parts.blocks.iter_mut().flat_map(|block| &mut block.rules) {
        gone += usize::from(!rule.name.is_empty());
        rule.name.clear();
    }
    if gone > 0 {
        loss.note(format!("the names of {gone} rules are left out"));
    }
}

/// For formats that know no default but a number: the middle of the universe as a number.
/// Nothing is lost by that.
pub(crate) fn numbered_fallback(output: &mut Output) {
    if output.fallback.value == FallbackValue::Middle {
        let middle = output.universe.map(|universe| universe.middle());
        output.fallback.value = middle.map_or(FallbackValue::Nothing, FallbackValue::Number);
    }
}

/// From the first to the last corner or parameter of an input's sets: for formats that ask for a range.
pub(crate) fn reach(input: &Input) -> Universe {
    let (mut lower, mut upper) = (f64::INFINITY, f64::NEG_INFINITY);
    for term in &input.terms {
        if let Membership::Shape { kind, params, .. } = &term.membership {
            kind.corners(params, &mut |x| (lower, upper) = (lower.min(x), upper.max(x)));
        }
    }
    let usable = lower < upper && (upper - lower).is_finite();
    if usable { Universe { lower, upper } } else { Universe { lower: -1.0, upper: 1.0 } }
}

/// For formats that know only some ways to compute integrals.
pub(crate) fn sampled(
    output: &mut Output,
    loss: &mut Loss,
    instead: Sampling,
    known: impl Fn(Sampling) -> bool,
) {
    let Some(sampling) = output.defuzzifier.sampling().filter(|&sampling| !known(sampling)) else {
        return;
    };
    let message = format!("integrals are computed by `{sampling}`, which has no words here");
    loss.lose(&output.name, &message, &format!("`{instead}`"));
    output.defuzzifier = output.defuzzifier.with_sampling(instead);
}

/// Names of the inputs, then of the outputs, for formulas.
pub(crate) fn formula_names(parts: &Parts) -> Vec<&str> {
    let inputs = parts.inputs.iter().map(|input| input.name.as_str());
    inputs.chain(parts.outputs.iter().map(|output| output.name.as_str())).collect()
}

/// A formula is written as it was given: its names must still mean the same variables.
pub(crate) fn check_formula(name: &str, formula: &Formula, names: &[&str], loss: &mut Loss) {
    let one_line = !formula.text().contains(['\n', '\r', '#', ';']);
    if !one_line || formula.text().trim() != formula.text() {
        loss.cannot(name, "the formula has no words here", "one line without `#` and `;`");
    } else if Formula::parse(formula.text(), names).as_ref() != Ok(formula) {
        let expected = format!("one in {}", names.join(", "));
        loss.cannot(name, "the formula does not name the variables as they are written", expected);
    }
}
