//! Check cases with their variables found.

use crate::compile::names::Names;
use crate::compile::units;
use crate::compile::variables::{Definition, Kind};
use crate::document::{Document, Shot, Signal, Variable};
use crate::finding::Findings;
use crate::model::{ResolvedShot, ResolvedSignal};

pub(super) fn resolve(
    document: &Document,
    names: &Names<'_>,
    definitions: &[Definition<'_>],
    findings: &mut Findings,
) -> Vec<ResolvedShot> {
    let shots = document.shots.iter();
    shots
        .map(|shot| ResolvedShot {
            name: shot.name.clone(),
            inputs: inputs(shot, document, names, definitions, findings),
            internals: signals(&shot.internals, document, names, findings),
            outputs: outputs(shot, document, names, findings),
        })
        .collect()
}

/// A value for each input of the model, in its order.
fn inputs(
    shot: &Shot,
    document: &Document,
    names: &Names<'_>,
    definitions: &[Definition<'_>],
    findings: &mut Findings,
) -> Vec<f64> {
    let given = signals(&shot.inputs, document, names, findings);
    let slots = definitions.iter().filter(|definition| matches!(definition.kind, Kind::Given));
    for signal in &given {
        let known = definitions.get(signal.slot);
        if !known.is_some_and(|definition| matches!(definition.kind, Kind::Given)) {
            let id = document.variables.get(signal.slot).map_or("", |variable| &variable.id);
            let message = format!("check case `{}` gives a value for it", shot.name);
            findings.problem(shot.origin, id, message, "values of inputs only");
        }
    }
    slots
        .filter_map(|definition| {
            let signal = given.iter().find(|signal| signal.slot == definition.slot);
            let variable = document.variables.get(definition.slot)?;
            signal.map(|signal| signal.value).or_else(|| assumed(shot, variable, findings))
        })
        .collect()
}

/// The initial value of an input that a check case leaves out.
fn assumed(shot: &Shot, variable: &Variable, findings: &mut Findings) -> Option<f64> {
    match variable.initial {
        Some(value) => {
            let message =
                format!("check case `{}`: `{}` is taken as {value}", shot.name, variable.id);
            findings.note(shot.origin, message);
        }
        None => {
            let message = format!("check case `{}` gives no value for it", shot.name);
            findings.problem(shot.origin, &variable.id, message, "a <signal> in <checkInputs>");
        }
    }
    variable.initial
}

fn outputs(
    shot: &Shot,
    document: &Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Vec<ResolvedSignal> {
    for signal in shot.outputs.iter().filter(|signal| signal.tolerance.is_none()) {
        let message = "an output of a check case without a tolerance";
        findings.problem(signal.origin, &signal.variable, message, "<tol>");
    }
    signals(&shot.outputs, document, names, findings)
}

fn signals(
    signals: &[Signal],
    document: &Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Vec<ResolvedSignal> {
    signals.iter().filter_map(|signal| resolved(signal, document, names, findings)).collect()
}

fn resolved(
    signal: &Signal,
    document: &Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Option<ResolvedSignal> {
    let map = if signal.by_name { &names.variables_by_name } else { &names.variables };
    let Some(&slot) = map.get(signal.variable.as_str()) else {
        let what = if signal.by_name { "name" } else { "identifier" };
        let message = format!("there is no variable with this {what}");
        findings.problem(signal.origin, &signal.variable, message, "a variable of the model");
        return None;
    };
    if signal.tolerance.is_some_and(|tolerance| !(tolerance >= 0.0)) {
        findings.problem(signal.origin, &signal.variable, "a tolerance below 0", "0 or more");
    }
    same_units(signal, document.variables.get(slot)?, findings);
    Some(ResolvedSignal { slot, value: signal.value, tolerance: signal.tolerance })
}

fn same_units(signal: &Signal, variable: &Variable, findings: &mut Findings) {
    if !units::agree(&signal.units, &variable.units) {
        let message = format!("a check case in {}", signal.units);
        findings.problem(signal.origin, &signal.variable, message, units::of_variable(variable));
    }
}
