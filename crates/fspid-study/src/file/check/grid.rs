//! The check of a rule grid, whose problems are told at their own cell.

use fspid_fuzzy::{Grid, GridError};

use super::value::wrong_type;
use crate::file::document::{Item, Value};
use crate::file::report::{Place, Report};
use crate::file::spec::Kind;

pub(super) fn check(report: &mut Report, item: &Item, path: &str) -> Option<Grid> {
    let Value::Text(text) = &item.value else {
        return wrong_type(report, item, path, &Kind::Grid);
    };
    match Grid::parse(text) {
        Ok(grid) => Some(grid),
        Err(error) => {
            let place = place_of(report, item.place, error);
            let text = error.to_string();
            // The sentence says what is allowed after a semicolon.
            let (message, allowed) = text.split_once("; allowed are ").unwrap_or((&text, ""));
            report.value(place, path, message, allowed);
            None
        }
    }
}

/// The place of the row or cell that is wrong; of the whole text where it cannot be told.
fn place_of(report: &Report, whole: Place, error: GridError) -> Place {
    let (row, column) = match error {
        GridError::UnknownLabel { row, column } => (row, Some(column)),
        GridError::RowLength { row, .. } => (row, None),
        _ => return whole,
    };
    let text = report.text(whole);
    let inner = text.trim_matches(['"', '\'']);
    let quotes = text.len() - text.trim_start_matches(['"', '\'']).len();
    let Some((line_start, line)) = filled_line(inner, row - 1) else {
        return whole;
    };
    let (start, length) = match column {
        Some(column) => match word(line, column - 1) {
            Some((start, word)) => (start, word.len()),
            None => return whole,
        },
        None => (line.len() - line.trim_start().len(), line.trim().len()),
    };
    let start = whole.start + quotes + line_start + start;
    Place {
        start,
        end: start + length,
        ..whole
    }
}

/// The line of that number among those that are not empty, and where it begins.
fn filled_line(text: &str, number: usize) -> Option<(usize, &str)> {
    let mut next = 0;
    let lines = text.split_inclusive('\n').map(|line| {
        let start = next;
        next += line.len();
        (start, line)
    });
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .nth(number)
}

/// The word of that number in a line, and where it begins.
fn word(line: &str, number: usize) -> Option<(usize, &str)> {
    let word = line.split_whitespace().nth(number)?;
    let mut starts = line.char_indices().filter(|&(at, c)| {
        let before = line.get(..at).and_then(|text| text.chars().next_back());
        !c.is_whitespace() && before.is_none_or(char::is_whitespace)
    });
    starts.nth(number).map(|(at, _)| (at, word))
}
