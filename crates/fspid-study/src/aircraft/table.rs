//! Columns under headings, numbers to the right.

use std::fmt::Write as _;

/// A table for a terminal: the first column is text, the others are numbers.
pub(super) fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let cell = |row: &[String], column: usize| row.get(column).cloned().unwrap_or_default();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| cell(row, column).chars().count());
        cells.chain([headings.get(column).map_or(0, |h| h.chars().count())]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..headings.len()).map(width).collect();
    let headings: Vec<String> = headings.iter().map(|&heading| heading.to_owned()).collect();
    let mut out = String::new();
    for row in std::iter::once(&headings).chain(rows) {
        let cells = widths.iter().enumerate().map(|(column, &width)| match column {
            0 => format!("{:width$}", cell(row, column)),
            _ => format!("{:>width$}", cell(row, column)),
        });
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    out
}
