//! Where tables end, and with them the box of a flight.
//!
//! JSBSim holds the values at the ends of every table. Of most that says nothing of the aircraft beyond them, so that they
//! bound the flight here. A table of two lines is another thing: a straight line with stops, often over a small part of what
//! the others cover. It is continued at its ends over the box of the others.

use crate::document::{Breakpoints, Document, GridTable};
use crate::finding::{Findings, Origin};

/// Continues tables of two lines over the box of the others that the same variable enters.
pub(super) fn widen(document: &mut Document, variables: &[String], findings: &mut Findings) {
    for variable in variables {
        let Some((min, max)) = box_of_others(document, variable) else { continue };
        let mut continued = 0;
        for (table, axis) in entered(document, variable) {
            continued += u32::from(continue_to((min, max), document, table, axis));
        }
        if continued > 0 {
            let message = format!(
                "{continued} table(s) of two lines by {variable} are continued at their ends, from {min:.4} to {max:.4}, \
                 where the others are"
            );
            findings.note(Origin(None), message);
        }
    }
}

/// Tables and the axes of them that a variable enters; tables and functions stand in the same order.
fn entered(document: &Document, variable: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (table, function) in document.functions.iter().enumerate() {
        let axes = function.inputs.iter().enumerate();
        let axes = axes.filter(|(_, input)| input.variable.id == variable);
        found.extend(axes.map(|(axis, _)| (table, axis)));
    }
    found
}

/// Where every table of more than two lines has values; `None` without such a table.
fn box_of_others(document: &Document, variable: &str) -> Option<(f64, f64)> {
    let entered = entered(document, variable);
    let all = entered.into_iter().filter_map(|(table, axis)| points(document, table, axis));
    let ends = all.filter(|points| points.len() > 2);
    let ends = ends.filter_map(|points| Some((*points.first()?, *points.last()?)));
    ends.reduce(|box_so_far, ends| (box_so_far.0.max(ends.0), box_so_far.1.min(ends.1)))
        .filter(|(min, max)| min < max)
}

fn points(document: &Document, table: usize, axis: usize) -> Option<&Vec<f64>> {
    let mention = document.tables.get(table)?.breakpoints.get(axis)?;
    document.breakpoints.iter().find(|set| set.id == mention.id).map(|set| &set.values)
}

/// One end of an axis.
#[derive(Clone, Copy, PartialEq)]
enum End {
    First,
    Last,
}

/// Continues a table of two lines along an axis; false where there was nothing to do.
fn continue_to((min, max): (f64, f64), document: &mut Document, table: usize, axis: usize) -> bool {
    let sizes = |document: &Document| -> Vec<usize> {
        let axes = document.tables.get(table).map_or(0, |table| table.breakpoints.len());
        (0..axes).map(|axis| points(document, table, axis).map_or(0, Vec::len)).collect()
    };
    let Document { tables, .. } = &*document;
    let Some(id) =
        tables.get(table).and_then(|it| it.breakpoints.get(axis)).map(|it| it.id.clone())
    else {
        return false;
    };
    let mut changed = false;
    for (end, to) in [(End::First, min), (End::Last, max)] {
        let sizes = sizes(document);
        let (Some(set), Some(grid)) = (
            document.breakpoints.iter_mut().find(|set| set.id == id),
            document.tables.get_mut(table),
        ) else {
            return false;
        };
        let two_lines = set.values.len() == 2 || changed;
        let beyond = match end {
            End::First => set.values.first().is_some_and(|first| *first > to),
            End::Last => set.values.last().is_some_and(|last| *last < to),
        };
        if two_lines && beyond {
            continued(grid, set, (axis, &sizes), (end, to));
            changed = true;
        }
    }
    changed
}

/// Adds a place before the first or behind the last, with the values of its neighbour.
fn continued(
    grid: &mut GridTable,
    set: &mut Breakpoints,
    (axis, sizes): (usize, &[usize]),
    (end, place): (End, f64),
) {
    let inner: usize = sizes.get(axis + 1..).unwrap_or_default().iter().product();
    let block = inner * sizes.get(axis).copied().unwrap_or_default();
    let mut values = Vec::with_capacity(grid.values.len() * 2);
    for chunk in grid.values.chunks(block.max(1)) {
        match end {
            End::First => {
                values.extend(chunk.get(..inner).unwrap_or_default());
                values.extend(chunk);
            }
            End::Last => {
                values.extend(chunk);
                let last = chunk.len().saturating_sub(inner);
                values.extend(chunk.get(last..).unwrap_or_default());
            }
        }
    }
    grid.values = values;
    match end {
        End::First => set.values.insert(0, place),
        End::Last => set.values.push(place),
    }
}
