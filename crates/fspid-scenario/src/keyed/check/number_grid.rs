//! The check of a grid of numbers, whose problems are told at their own cell.

use fspid_fuzzy::LABEL_COUNT;

use super::value::{number, wrong_type};
use crate::keyed::document::{Item, Value};
use crate::keyed::{Kind, Range};
use fspid_diagnostics::{Report, Span};

pub(crate) const ALLOWED: &str =
    "seven lists of seven numbers, one list for each error from NB to PB";
const ROW: &str = "seven numbers, one for each change from NB to PB";

/// The cells row by row, each with its place; every problem in them is reported.
pub(crate) fn check(report: &mut Report, item: &Item, path: &str) -> Option<Vec<(f64, Span)>> {
    let Value::Array(rows) = &item.value else {
        return wrong_type(report, item, path, &Kind::NumberGrid);
    };
    let before = report.count();
    if rows.len() != LABEL_COUNT {
        report.value(item.place, path, format!("{} lists", rows.len()), ALLOWED);
    }
    let mut cells = Vec::with_capacity(LABEL_COUNT * LABEL_COUNT);
    for (index, row) in rows.iter().enumerate().take(LABEL_COUNT) {
        let path = format!("{path}[{index}]");
        let Value::Array(numbers) = &row.value else {
            report.value(row.place, &path, format!("wrong type: {}", row.value.type_name()), ROW);
            continue;
        };
        if numbers.len() != LABEL_COUNT {
            report.value(row.place, &path, format!("{} numbers", numbers.len()), ROW);
        }
        for (index, item) in numbers.iter().enumerate().take(LABEL_COUNT) {
            let value = number(report, item, &format!("{path}[{index}]"), Range::Finite, "");
            cells.extend(value.map(|value| (value, item.place)));
        }
    }
    (report.count() == before).then_some(cells)
}
