//! A rule table as a grid coloured by label.

use super::page::{self, EDGE, LABEL_PX};
use super::style::{Role, diverging, wants_dark_text};
use super::svg::{Anchor, Canvas, Font, Paint, Svg};

/// Labels of the seven sets, from negative big to positive big.
pub const SEVEN: [&str; 7] = ["NB", "NM", "NS", "ZO", "PS", "PM", "PB"];

/// A rule table: what the output is for each pair of labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RuleTable {
    /// Printed above the table and read out by screen readers.
    pub title: String,
    /// Name of the variable whose labels head the rows.
    pub row_header: String,
    /// Name of the variable whose labels head the columns.
    pub column_header: String,
    /// Labels of rows, columns and cells in their order, such as [`SEVEN`]; they decide the colours.
    pub labels: Vec<String>,
    /// Rows of cells; a missing cell is left empty.
    pub cells: Vec<Vec<String>>,
    /// Where cells are numbers, their parts of the range, from -1 to 1: these decide the colours then.
    pub shades: Vec<Vec<f64>>,
    /// Cells that are odd, and why.
    pub marked: Vec<Mark>,
}

/// A cell to be marked; equal reasons share one footnote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// Row, from 0.
    pub row: usize,
    /// Column, from 0.
    pub column: usize,
    /// The footnote.
    pub reason: String,
}

const CELL_WIDTH: f64 = 48.0;
const CELL_HEIGHT: f64 = 30.0;
const HEAD: f64 = 40.0;
const NOTE_ROW: f64 = 16.0;

impl RuleTable {
    /// Draws the table.
    #[must_use]
    pub fn render(&self) -> Svg {
        let count = self.labels.len().min(99);
        let side = EDGE + 22.0 + HEAD;
        let width = (side + count as f64 * CELL_WIDTH + EDGE).max(280.0);
        let top = page::title_height(&self.title, width) + 40.0;
        let notes = self.notes(width - 2.0 * EDGE - 14.0);
        let note_lines: usize = notes.iter().map(|note| note.1.len()).sum();
        let bottom = top + count as f64 * CELL_HEIGHT;
        let mut canvas = Canvas::new(
            width,
            bottom + EDGE + if note_lines > 0 { note_lines as f64 * NOTE_ROW + 6.0 } else { 0.0 },
        );
        page::title(&mut canvas, &self.title);
        self.heads(&mut canvas, side, top, count);
        for row in 0..count {
            for column in 0..count {
                let corner = (side + column as f64 * CELL_WIDTH, top + row as f64 * CELL_HEIGHT);
                self.cell(&mut canvas, corner, (row, column), &notes);
            }
        }
        let mut y = bottom + 22.0;
        for (letter, lines) in &notes {
            canvas.text(
                EDGE,
                y,
                &format!("^{{{letter}}}"),
                Font::new(LABEL_PX, Anchor::Start).bold(),
            );
            for line in lines {
                canvas.text(EDGE + 14.0, y, line, Font::new(11.0, Anchor::Start));
                y += NOTE_ROW;
            }
        }
        canvas.finish(&self.title, &self.describe())
    }

    fn heads(&self, canvas: &mut Canvas, side: f64, top: f64, count: usize) {
        let font = Font::new(LABEL_PX, Anchor::Middle).bold();
        let middle =
            (side + count as f64 * CELL_WIDTH / 2.0, top + count as f64 * CELL_HEIGHT / 2.0);
        page::level_label(canvas, middle.0, top - 26.0, &self.column_header);
        page::upright_label(canvas, EDGE + 12.0, middle.1, std::slice::from_ref(&self.row_header));
        for (n, label) in self.labels.iter().take(count).enumerate() {
            canvas.text(side + (n as f64 + 0.5) * CELL_WIDTH, top - 8.0, label, font);
            canvas.text(side - HEAD / 2.0, top + (n as f64 + 0.5) * CELL_HEIGHT + 4.3, label, font);
        }
    }

    fn cell(
        &self,
        canvas: &mut Canvas,
        (x, y): (f64, f64),
        (row, column): (usize, usize),
        notes: &[(char, Vec<String>)],
    ) {
        let label =
            self.cells.get(row).and_then(|cells| cells.get(column)).map_or("", String::as_str);
        let middle = (self.labels.len().saturating_sub(1)) as f64 / 2.0;
        let place = self.labels.iter().position(|known| known == label).map(|n| n as f64 - middle);
        let shade = self.shades.get(row).and_then(|row| row.get(column));
        let place = place.or(shade.map(|part| part * middle));
        let fill = place.map(|place| diverging(place * 0.8, middle));
        let face = Paint::face(fill.map_or(Role::None, Role::Fixed));
        canvas.rect(x + 0.75, y + 0.75, CELL_WIDTH - 1.5, CELL_HEIGHT - 1.5, &face);
        let ink = match fill {
            Some(colour) if wants_dark_text(colour) => Role::Fixed([20, 20, 20]),
            Some(_) => Role::Fixed([255, 255, 255]),
            None => Role::Ink,
        };
        let note = self.reasons().iter().position(|reason| {
            self.marked
                .iter()
                .any(|mark| (mark.row, mark.column) == (row, column) && mark.reason == *reason)
        });
        let mark = note.and_then(|n| notes.get(n));
        let shown =
            mark.map_or_else(|| label.to_owned(), |(letter, _)| format!("{label}^{{{letter}}}"));
        let font = Font::new(LABEL_PX, Anchor::Middle).role(ink);
        canvas.text(
            x + CELL_WIDTH / 2.0,
            y + CELL_HEIGHT / 2.0 + 4.3,
            &shown,
            if mark.is_some() { font.bold() } else { font },
        );
        if mark.is_some() {
            canvas.rect(
                x + 3.0,
                y + 3.0,
                CELL_WIDTH - 6.0,
                CELL_HEIGHT - 6.0,
                &Paint::line(ink, 1.6),
            );
        }
    }

    /// The distinct reasons in the order of their first mark.
    fn reasons(&self) -> Vec<&str> {
        let mut reasons: Vec<&str> = Vec::new();
        for mark in &self.marked {
            if !reasons.contains(&mark.reason.as_str()) {
                reasons.push(&mark.reason);
            }
        }
        reasons
    }

    /// A letter and wrapped lines for each reason.
    fn notes(&self, width: f64) -> Vec<(char, Vec<String>)> {
        ('a'..='z')
            .zip(self.reasons())
            .map(|(letter, reason)| (letter, page::wrap(reason, 11.0, width)))
            .collect()
    }

    fn describe(&self) -> String {
        let mut text =
            format!("Rule table. Rows: {}; columns: {}.", self.row_header, self.column_header);
        for (label, cells) in self.labels.iter().zip(&self.cells) {
            text.push_str(&format!(" {label}: {}.", cells.join(" ")));
        }
        for mark in &self.marked {
            text.push_str(&format!(
                " Marked: row {}, column {}: {}.",
                mark.row + 1,
                mark.column + 1,
                mark.reason
            ));
        }
        text
    }
}
