//! A legend whose entries are sentences: below the figure, one under the other, broken into lines.

use crate::page::{self, Entry, LABEL_PX, Legend};
use crate::svg::{Anchor, Canvas, Font};

const ROW: f64 = 18.0;
/// Room left of the words for the sign of an entry (px).
const INDENT: f64 = 36.0;

/// Entries with their lines.
pub(super) struct Notes {
    entries: Vec<(Entry, Vec<String>)>,
}

impl Notes {
    /// Breaks the names of `entries` into lines of at most `width` px, where spaces allow it.
    pub(super) fn set(entries: Vec<Entry>, width: f64) -> Self {
        let lines = |entry: &Entry| page::wrap(&entry.name, LABEL_PX, width - INDENT);
        Self {
            entries: entries
                .into_iter()
                .map(|entry| {
                    let lines = lines(&entry);
                    (entry, lines)
                })
                .collect(),
        }
    }

    /// Height of all lines (px).
    pub(super) fn height(&self) -> f64 {
        self.entries.iter().map(|(_, lines)| lines.len()).sum::<usize>() as f64 * ROW
    }

    /// Draws the entries with their upper left corner at (`left`, `top`).
    pub(super) fn draw(&self, canvas: &mut Canvas, left: f64, top: f64) {
        let mut y = top;
        for (entry, lines) in &self.entries {
            let Some((first, rest)) = lines.split_first() else { continue };
            let named = Entry { name: first.clone(), swatch: entry.swatch };
            Legend::set(vec![named], 1e6).draw(canvas, left, y);
            y += ROW;
            for line in rest {
                let font = Font::new(LABEL_PX, Anchor::Start);
                canvas.text(left + INDENT, y + ROW / 2.0 + 4.2, line, font);
                y += ROW;
            }
        }
    }
}
