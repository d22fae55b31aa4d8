//! Columns under headings: words to the left, numbers to the right.

use fspid_diagnostics::lines::line;

/// A table for a terminal; the first column is text, and so is any with a word in it.
pub(super) fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let cell = |row: &[String], column: usize| row.get(column).cloned().unwrap_or_default();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| cell(row, column).chars().count());
        cells.chain([headings.get(column).map_or(0, |h| h.chars().count())]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..headings.len()).map(width).collect();
    let is_text = |column: usize| {
        let begins = |row: &Vec<String>| row.get(column)?.chars().next();
        column == 0 || rows.iter().filter_map(begins).any(char::is_alphabetic)
    };
    let headings: Vec<String> = headings.iter().map(|&heading| heading.to_owned()).collect();
    let mut out = String::new();
    for row in std::iter::once(&headings).chain(rows) {
        let cells = widths.iter().enumerate().map(|(column, &width)| match is_text(column) {
            true => format!("{:width$}", cell(row, column)),
            false => format!("{:>width$}", cell(row, column)),
        });
        line(&mut out, format_args!("  {}", cells.collect::<Vec<_>>().join("  ").trim_end()));
    }
    out
}

/// Width of a paragraph in characters.
const WIDTH: usize = 96;

/// A text in lines that are not too long, broken at spaces.
pub(super) fn paragraph(text: &str) -> String {
    let mut out = String::new();
    let mut width = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        let (gap, start) = match (width, width + 1 + length > WIDTH) {
            (0, _) => ("", 0),
            (_, true) => ("\n", 0),
            (_, false) => (" ", width + 1),
        };
        out.push_str(gap);
        out.push_str(word);
        width = start + length;
    }
    out.push('\n');
    out
}
