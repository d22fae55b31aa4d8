//! Numbers of a document that was not read from XML: finite, and of a size that can be computed with.

use crate::MAX_MAGNITUDE;
use crate::document::{Document, Shot, Signal, Variable};
use crate::expression::Expression;
use crate::finding::{Findings, Origin};

pub(super) fn check(document: &Document, findings: &mut Findings) {
    let mut report = |good: bool, origin: Origin, id: &str| {
        if !good {
            let expected = format!("finite numbers of at most {MAX_MAGNITUDE:e} in magnitude");
            findings.problem(origin, id, "a number that cannot be used", expected);
        }
    };
    for variable in &document.variables {
        report(good_variable(variable), variable.origin, &variable.id);
    }
    for set in &document.breakpoints {
        report(set.values.iter().all(good), set.origin, &set.id);
    }
    for table in &document.tables {
        report(table.values.iter().all(good), table.origin, &table.id);
    }
    for function in &document.functions {
        let limits = function.inputs.iter().flat_map(|input| input.min.iter().chain(&input.max));
        report(limits.into_iter().all(good), function.origin, &function.name);
    }
    for shot in &document.shots {
        report(good_shot(shot), shot.origin, &shot.name);
    }
}

fn good(value: &f64) -> bool {
    value.abs() <= MAX_MAGNITUDE
}

fn good_variable(variable: &Variable) -> bool {
    let Variable { initial, min, max, formula, .. } = variable;
    let numbers = initial.iter().chain(min).chain(max);
    numbers.into_iter().all(good) && formula.as_ref().is_none_or(good_formula)
}

fn good_formula(formula: &Expression) -> bool {
    match formula {
        Expression::Number(value) => good(value),
        Expression::Variable { .. } => true,
        Expression::Apply(_, operands) => operands.iter().all(good_formula),
    }
}

fn good_shot(shot: &Shot) -> bool {
    let signals = shot.inputs.iter().chain(&shot.internals).chain(&shot.outputs);
    let good_signal =
        |signal: &Signal| good(&signal.value) && signal.tolerance.as_ref().is_none_or(good);
    signals.into_iter().all(good_signal)
}
