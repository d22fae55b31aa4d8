//! In which order variables can be computed, or the circle that stands in the way.

use std::collections::BTreeSet;

use crate::compile::names::Names;
use crate::compile::variables::{Definition, Kind};
use crate::document::Document;
use crate::expression::Expression;
use crate::finding::{Findings, Origin};

/// Variables so that each comes after those it depends on; among those that could be next, the first of the file.
///
/// # Source
/// A. B. Kahn, *Topological sorting of large networks*, Communications of the ACM 5, 1962.
pub(super) fn order(
    document: &Document,
    names: &Names<'_>,
    definitions: &[Definition<'_>],
    findings: &mut Findings,
) -> Vec<usize> {
    let needs: Vec<_> =
        definitions.iter().map(|definition| needs(definition.kind, names)).collect();
    let mut waiting: Vec<usize> = needs.iter().map(BTreeSet::len).collect();
    let gain_coupling = gain_coupling(&needs);
    let mut ready: BTreeSet<usize> = indices_of_zero(&waiting).collect();
    let mut order = Vec::with_capacity(needs.len());
    while let Some(next) = ready.pop_first() {
        order.push(next);
        for &follower in gain_coupling.get(next).into_iter().flatten() {
            if let Some(count) = waiting.get_mut(follower) {
                *count -= 1;
                if *count == 0 {
                    ready.insert(follower);
                }
            }
        }
    }
    if order.len() < needs.len() {
        report_circle(document, &needs, &waiting, findings);
    }
    order
}

fn indices_of_zero(counts: &[usize]) -> impl Iterator<Item = usize> {
    counts.iter().enumerate().filter(|&(_, &count)| count == 0).map(|(index, _)| index)
}

fn gain_coupling(needs: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let mut gain_coupling = vec![Vec::new(); needs.len()];
    for (index, needed) in needs.iter().enumerate() {
        for &need in needed {
            if let Some(list) = gain_coupling.get_mut(need) {
                list.push(index);
            }
        }
    }
    gain_coupling
}

/// Variables that a value is made of; unknown ones are told elsewhere.
fn needs(kind: Kind<'_>, names: &Names<'_>) -> BTreeSet<usize> {
    let mut needed = BTreeSet::new();
    match kind {
        Kind::Given | Kind::Constant(_) => {}
        Kind::Formula(formula) => collect(formula, names, &mut needed),
        Kind::Table(function) => {
            let ids = function.inputs.iter().map(|input| input.variable.id.as_str());
            needed.extend(ids.filter_map(|id| names.variables.get(id)));
        }
    }
    needed
}

fn collect(formula: &Expression, names: &Names<'_>, needed: &mut BTreeSet<usize>) {
    match formula {
        Expression::Number(_) => {}
        Expression::Variable { id, .. } => needed.extend(names.variables.get(id.as_str())),
        Expression::Apply(_, operands) => {
            for operand in operands {
                collect(operand, names, needed);
            }
        }
    }
}

/// Names one circle among the variables that are still waiting.
fn report_circle(
    document: &Document,
    needs: &[BTreeSet<usize>],
    waiting: &[usize],
    findings: &mut Findings,
) {
    let is_waiting = |index: &usize| waiting.get(*index).is_some_and(|&count| count > 0);
    let next = |index: usize| needs.get(index).and_then(|set| set.iter().copied().find(is_waiting));
    let mut path = Vec::new();
    let mut at = (0..needs.len()).find(is_waiting);
    while let Some(index) = at.filter(|index| !path.contains(index)) {
        path.push(index);
        at = next(index);
    }
    let start = path.iter().position(|&index| Some(index) == at).unwrap_or(0);
    let circle = path.get(start..).unwrap_or_default().iter().chain(at.as_ref());
    let ids: Vec<_> = circle.map(|&index| id(document, index)).collect();
    let origin = at.and_then(|index| document.variables.get(index));
    findings.problem(
        origin.map_or(Origin(None), |variable| variable.origin),
        ids.first().unwrap_or(&""),
        format!("variables that need each other: {}", ids.join(" ← ")),
        "a calculation that does not need its own result",
    );
}

fn id(document: &Document, index: usize) -> &str {
    document.variables.get(index).map_or("", |variable| variable.id.as_str())
}
