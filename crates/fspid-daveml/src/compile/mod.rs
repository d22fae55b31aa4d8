//! From a document to a model: names are resolved, sizes checked, and the order of computing is found.

mod code;
mod names;
mod numbers;
mod order;
mod shots;
mod tables;
mod units;
mod variables;

use crate::MAX_VARIABLES;
use crate::document::Document;
use crate::finding::{Findings, Origin};
use crate::model::{Axis, Grid, Model, Step};
use fspid_diagnostics::Problems;
use names::Names;
use variables::Definition;

impl Model {
    /// The model of a document that was put together without a file.
    ///
    /// # Errors
    /// Every problem of names, sizes and order.
    pub fn new(document: &Document) -> Result<Self, Problems> {
        let mut findings = Findings::default();
        let model = compile(document, &mut findings);
        findings.finish("")?;
        model.ok_or_else(|| Problems::of_text(Vec::new()))
    }
}

/// The model, or problems.
pub(crate) fn compile(document: &Document, findings: &mut Findings) -> Option<Model> {
    numbers::check(document, findings);
    let names = Names::of(document, findings);
    limited(document.variables.len(), "variables", findings);
    let definitions = variables::definitions(document, &names, findings);
    let mut model = Model::empty(document);
    for definition in &definitions {
        add_definition(definition, document, &names, &mut model, findings);
    }
    limited(model.axes.len(), "axes of tables", findings);
    let order = order::order(document, &names, &definitions, findings);
    model.shots = shots::resolve(document, &names, &definitions, findings);
    if !findings.good() {
        return None;
    }
    arrange(&order, &definitions, &mut model);
    Some(model)
}

fn limited(count: usize, what: &str, findings: &mut Findings) {
    if count > MAX_VARIABLES {
        let message = format!("{count} {what}");
        findings.problem(Origin(None), "", message, format!("at most {MAX_VARIABLES}"));
    }
}

/// Puts code, axes and grids of one variable into the model.
fn add_definition(
    definition: &Definition<'_>,
    document: &Document,
    names: &Names<'_>,
    model: &mut Model,
    findings: &mut Findings,
) {
    let slot = definition.slot;
    match definition.kind {
        variables::Kind::Given => model.inputs.push(slot),
        variables::Kind::Constant(value) => model.set_start(slot, value),
        variables::Kind::Formula(formula) => {
            let range = code::append(formula, names, &mut model.code, findings);
            model.steps.push(Step::Formula { slot, range });
        }
        variables::Kind::Table(function) => {
            if let Some((axes, grid)) = tables::resolve(function, document, names, findings) {
                let axes = axes.into_iter().map(|axis| shared(&mut model.axes, axis)).collect();
                model.grids.push(Grid { axes, ..grid });
                model.steps.push(Step::Interpolate { slot, grid: model.grids.len() - 1 });
            }
        }
    }
    if definition.answer {
        model.outputs.push(slot);
    }
}

/// Index of an axis, which is put at the end of the list unless it is there already.
fn shared(axes: &mut Vec<Axis>, axis: Axis) -> usize {
    axes.iter().position(|known| *known == axis).unwrap_or_else(|| {
        axes.push(axis);
        axes.len() - 1
    })
}

/// Puts the steps into the order in which they can be computed, with limits after their variable and the search of an
/// axis before its first table.
fn arrange(order: &[usize], definitions: &[Definition<'_>], model: &mut Model) {
    let unordered = core::mem::take(&mut model.steps);
    let mut located = vec![false; model.axes.len()];
    for &slot in order {
        for step in unordered.iter().filter(|step| step.slot() == Some(slot)) {
            for axis in model.axes_of(step) {
                if let Some(known) = located.get_mut(axis)
                    && !core::mem::replace(known, true)
                {
                    model.steps.push(Step::Locate { axis });
                }
            }
            model.steps.push(step.clone());
        }
        if let Some((min, max)) = definitions.get(slot).and_then(|found| found.limits) {
            model.steps.push(Step::Limit { slot, min, max });
        }
    }
}
