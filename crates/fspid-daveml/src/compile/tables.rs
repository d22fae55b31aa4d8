//! Tables: as many axes as breakpoints, as many values as their product.

use crate::MAX_AXES;
use crate::compile::names::Names;
use crate::compile::units;
use crate::document::{
    Breakpoints, Document, Extrapolate, FunctionInput, GridTable, TableFunction,
};
use crate::finding::Findings;
use crate::model::{Axis, Grid};

/// The axes and the grid of a function; the indices of the axes are filled in later.
pub(super) fn resolve(
    function: &TableFunction,
    document: &Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Option<(Vec<Axis>, Grid)> {
    let table = document.tables.get(names.table(&function.table, findings)?)?;
    let breakpoints = breakpoints(table, document, names, findings)?;
    if breakpoints.len() != function.inputs.len() {
        let (inputs, axes) = (function.inputs.len(), breakpoints.len());
        let message =
            format!("<independentVarRef> stands {inputs} times, axes of the table: {axes}");
        let expected = "one <independentVarRef> for each <bpRef>, in the same order";
        findings.problem(function.origin, &function.name, message, expected);
        return None;
    }
    right_size(table, &breakpoints, findings);
    units_of_parts(function, (table, &breakpoints), (document, names), findings);
    let pairs = function.inputs.iter().zip(&breakpoints);
    let axes: Vec<_> = pairs.map(|(input, points)| axis(input, points, names, findings)).collect();
    let axes = axes.into_iter().collect::<Option<Vec<_>>>()?;
    let grid =
        Grid { axes: Vec::new(), strides: strides(&breakpoints), values: table.values.clone() };
    Some((axes, grid))
}

fn breakpoints<'a>(
    table: &GridTable,
    document: &'a Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Option<Vec<&'a Breakpoints>> {
    let count = table.breakpoints.len();
    if count == 0 || count > MAX_AXES {
        let expected = format!("1 to {MAX_AXES} <bpRef> in <breakpointRefs>");
        findings.problem(
            table.origin,
            &table.id,
            format!("the number of axes is {count}"),
            expected,
        );
        return None;
    }
    let indices: Vec<_> =
        table.breakpoints.iter().map(|mention| names.breakpoints(mention, findings)).collect();
    let found: Option<Vec<_>> =
        indices.into_iter().map(|index| document.breakpoints.get(index?)).collect();
    found.filter(|sets| sets.iter().all(|set| rising(set, findings)))
}

fn rising(breakpoints: &Breakpoints, findings: &mut Findings) -> bool {
    let values = &breakpoints.values;
    let ordered = values.is_sorted_by(|low, high| low < high);
    if values.len() >= 2 && ordered {
        return true;
    }
    let message = if ordered {
        format!("the number of breakpoints is {}", values.len())
    } else {
        "breakpoints that do not rise".to_owned()
    };
    let expected = "at least two numbers, each above the one before";
    findings.problem(breakpoints.origin, &breakpoints.id, message, expected);
    false
}

fn right_size(table: &GridTable, breakpoints: &[&Breakpoints], findings: &mut Findings) {
    let counts: Vec<_> = breakpoints.iter().map(|set| set.values.len()).collect();
    let product = counts.iter().try_fold(1_usize, |product, &count| product.checked_mul(count));
    if product != Some(table.values.len()) {
        let sizes: Vec<_> = counts.iter().map(ToString::to_string).collect();
        let expected = match product {
            Some(product) if counts.len() > 1 => format!("{} = {product}", sizes.join(" × ")),
            _ => sizes.join(" × "),
        };
        let message = format!("the number of values is {}", table.values.len());
        findings.problem(table.origin, &table.id, message, expected);
    }
}

/// Breakpoints and values are in the units of the variables that they stand for: nothing is converted.
fn units_of_parts(
    function: &TableFunction,
    (table, breakpoints): (&GridTable, &[&Breakpoints]),
    (document, names): (&Document, &Names<'_>),
    findings: &mut Findings,
) {
    let axes = function.inputs.iter().map(|input| &input.variable).zip(breakpoints);
    let axes = axes.map(|(mention, set)| (mention, "breakpoints are", &set.id, &set.units));
    let values = [(&function.output, "table is", &table.id, &table.units)];
    for (mention, what, id, found) in axes.chain(values) {
        // An identifier that is unknown is told elsewhere.
        let slot = names.variables.get(mention.id.as_str());
        let Some(variable) = slot.and_then(|&slot| document.variables.get(slot)) else { continue };
        if !units::agree(found, &variable.units) {
            let message = format!("its {what} in {found} (`{id}`)");
            let expected = units::of_variable(variable);
            findings.problem(mention.origin, &mention.id, message, expected);
        }
    }
}

/// Distance of neighbours along each axis; along the last they follow each other.
fn strides(breakpoints: &[&Breakpoints]) -> Vec<usize> {
    let mut strides: Vec<_> = breakpoints
        .iter()
        .rev()
        .scan(1_usize, |product, set| {
            let stride = *product;
            *product = product.saturating_mul(set.values.len());
            Some(stride)
        })
        .collect();
    strides.reverse();
    strides
}

fn axis(
    input: &FunctionInput,
    breakpoints: &Breakpoints,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Option<Axis> {
    let mention = &input.variable;
    let slot = names.variable(&mention.id, mention.origin, findings)?;
    let (&first, &last) = (breakpoints.values.first()?, breakpoints.values.last()?);
    let (down, up) = match input.extrapolate {
        Extrapolate::Neither => (false, false),
        Extrapolate::Min => (true, false),
        Extrapolate::Max => (false, true),
        Extrapolate::Both => (true, true),
    };
    let min = lower(input.min, first, down);
    let max = -lower(input.max.map(|max| -max), -last, up);
    if !(min <= max) {
        let message = "min and max leave nothing of the breakpoints";
        findings.problem(
            mention.origin,
            &mention.id,
            message,
            format!("limits within {first} to {last}"),
        );
    }
    futile(input, (down, first < min), (up, max < last), findings);
    Some(Axis { slot, points: breakpoints.values.clone(), min, max })
}

/// Where a variable is held from below: at its limit, and at the first breakpoint unless the table goes on.
fn lower(limit: Option<f64>, first: f64, goes_on: bool) -> f64 {
    let limit = limit.unwrap_or(f64::NEG_INFINITY);
    if goes_on { limit } else { limit.max(first) }
}

/// Notes where a limit inside of the breakpoints leaves nothing of the extrapolation that is asked for.
fn futile(
    input: &FunctionInput,
    (down, held_below): (bool, bool),
    (up, held_above): (bool, bool),
    findings: &mut Findings,
) {
    let mention = &input.variable;
    for (asked, held, end) in [(down, held_below, "min"), (up, held_above, "max")] {
        if asked && held {
            let message = format!(
                "`{}` may be extrapolated, but {end} holds it inside of the breakpoints",
                mention.id
            );
            findings.note(mention.origin, message);
        }
    }
}
