//! The check of a rule grid, whose problems are told at their own cell.

use fspid_fuzzy::{Grid, GridError, LABEL_COUNT, Label};

use super::value::wrong_type;
use crate::keyed::Kind;
use crate::keyed::document::{Item, Value};
use fspid_diagnostics::{Report, Span, in_two};

pub(super) fn check(report: &mut Report, item: &Item, path: &str) -> Option<Grid> {
    let Value::Text(text) = &item.value else {
        return wrong_type(report, item, path, &Kind::Grid);
    };
    match Grid::parse(text) {
        Ok(grid) => Some(grid),
        Err(error) => {
            let hole = hole(text, error);
            let place = place_of(report, item.place, error, hole);
            // The sentence says what is allowed after a semicolon.
            let text = hole.map_or_else(|| error.to_string(), Hole::in_words);
            let (message, allowed) = in_two(&text);
            report.value(place, path, message, allowed);
            None
        }
    }
}

/// A grid as seven lines of seven labels.
pub(crate) fn grid_text(grid: &Grid) -> String {
    let row = |error| Label::ALL.map(|change| grid.at(error, change).name()).join(" ");
    Label::ALL.map(row).join("\n")
}

/// An empty cell. Row and column count from 0.
#[derive(Clone, Copy)]
struct Hole {
    row: usize,
    column: usize,
    /// Where in the line the cell would begin.
    start: usize,
}

impl Hole {
    fn in_words(self) -> String {
        let label = |index: usize| Label::ALL.get(index).map_or("", |label| label.name());
        let Self { row, column, .. } = self;
        format!(
            "row {} (error {}), column {} (change {}) is empty; allowed are NB NM NS ZO PS PM PB",
            row + 1,
            label(row),
            column + 1,
            label(column),
        )
    }
}

/// The first empty cell of a row that is too short, if the grid is written in columns.
fn hole(text: &str, error: GridError) -> Option<Hole> {
    let GridError::RowLength { row, found } = error else {
        return None;
    };
    let row = row - 1;
    let starts = |(_, line)| word_starts(line).collect::<Vec<usize>>();
    let full = (0..LABEL_COUNT)
        .filter_map(|row| filled_line(text, row).map(starts))
        .find(|starts| starts.len() == LABEL_COUNT)?;
    let short = filled_line(text, row).map(starts)?;
    let in_columns = found > 0 && short.iter().all(|start| full.contains(start));
    let column = full.iter().position(|start| !short.contains(start))?;
    let start = *full.get(column)?;
    in_columns.then_some(Hole { row, column, start })
}

/// The place of the row or cell that is wrong; of the whole text where it cannot be told.
fn place_of(report: &Report, whole: Span, error: GridError, hole: Option<Hole>) -> Span {
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
        None => match hole {
            Some(hole) => (hole.start, 0),
            None => (line.len() - line.trim_start().len(), line.trim().len()),
        },
    };
    let start = whole.start + quotes + line_start + start;
    Span { start, end: start + length, ..whole }
}

/// The line of that number among those that are not empty, and where it begins.
fn filled_line(text: &str, number: usize) -> Option<(usize, &str)> {
    let mut next = 0;
    let lines = text.split_inclusive('\n').map(|line| {
        let start = next;
        next += line.len();
        (start, line)
    });
    lines.filter(|(_, line)| !line.trim().is_empty()).nth(number)
}

/// The word of that number in a line, and where it begins.
fn word(line: &str, number: usize) -> Option<(usize, &str)> {
    let word = line.split_whitespace().nth(number)?;
    word_starts(line).nth(number).map(|at| (at, word))
}

/// Where the words of a line begin.
fn word_starts(line: &str) -> impl Iterator<Item = usize> + '_ {
    let starts = line.char_indices().filter(|&(at, c)| {
        let before = line.get(..at).and_then(|text| text.chars().next_back());
        !c.is_whitespace() && before.is_none_or(char::is_whitespace)
    });
    starts.map(|(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: &str = "NB NM NS ZO PS PM PB\n";

    fn hole_in(row: &str) -> Option<(usize, usize)> {
        let text = [ROW, row, ROW, ROW, ROW, ROW, ROW].concat();
        let error = Grid::parse(&text).err()?;
        hole(&text, error).map(|hole| (hole.row, hole.column))
    }

    #[test]
    fn an_empty_cell_is_found_where_the_grid_is_written_in_columns() {
        assert_eq!(hole_in("   NM NS ZO PS PM PB\n"), Some((1, 0)));
        assert_eq!(hole_in("NB NM NS ZO PS PM\n"), Some((1, 6)));
        assert_eq!(hole_in("NB NM    ZO    PM PB\n"), Some((1, 2)));
    }

    #[test]
    fn a_row_out_of_column_or_too_long_has_no_empty_cell() {
        assert_eq!(hole_in("NB  NM NS ZO PS PB\n"), None);
        assert_eq!(hole_in("NB NM NS ZO PS PM PB PB\n"), None);
        assert_eq!(hole_in("NB NM NS XX PS PM PB\n"), None);
    }
}
