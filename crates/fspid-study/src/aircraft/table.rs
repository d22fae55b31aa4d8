//! Columns under headings: words to the left, numbers to the right.

use fspid_diagnostics::lines::wrapped;
use fspid_page::columns::{Align, Columns};

/// A table for a terminal; the first column is text, and so is any with a word in it.
pub(super) fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let align = |column: usize| {
        let begins = |row: &Vec<String>| row.get(column)?.chars().next();
        match column == 0 || rows.iter().filter_map(begins).any(char::is_alphabetic) {
            true => Align::Left,
            false => Align::Right,
        }
    };
    let headings = headings.iter().enumerate().map(|(column, text)| (*text, align(column)));
    let mut columns = Columns::new(&headings.collect::<Vec<_>>());
    rows.iter().for_each(|row| columns.row(row.clone()));
    columns.to_string()
}

/// Width of a paragraph in characters.
const WIDTH: usize = 96;

/// A text in lines that are not too long, broken at spaces.
pub(super) fn paragraph(text: &str) -> String {
    wrapped(text, "", WIDTH).join("\n") + "\n"
}
