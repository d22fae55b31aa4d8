//! What pages are made of: sections, figures with captions, tables with heads.

use std::fmt::Display;

use serde::Serialize;

use super::{markdown, number};
use fspid_plot::{Svg, page_style};

/// A figure with its caption.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// File name without its ending, and the figure's id in the page.
    pub name: String,
    /// The drawing.
    pub svg: String,
    /// True for a drawing that does not shrink to a narrow screen but is moved sideways there.
    pub wide: bool,
    /// Width in which it was drawn, px; a wide screen shows it larger, up to a limit.
    pub drawn_px: f64,
    /// What it shows.
    pub caption: String,
    /// Numbers of the assumptions it rests on.
    pub assumptions: Vec<Reference>,
}

/// A drawing that is wider than this cannot be read when it is shrunk to a phone, px.
const WIDE_PX: f64 = 600.0;

/// Numbered things that are referred to: one, or a run of them from the first to the last.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Reference {
    /// Its id in the page.
    pub first: String,
    /// Id of the last one of a run; empty for one alone.
    pub last: String,
}

/// References to these ids; three or more numbers in a row become a run.
pub fn references(ids: &[&str]) -> Vec<Reference> {
    let number = |id: &str| id.get(1..).and_then(|digits| digits.parse::<u32>().ok());
    let mut ids = ids.to_vec();
    ids.sort_by_key(|id| number(id));
    let mut runs: Vec<Vec<&str>> = Vec::new();
    for id in ids {
        let follows = |run: &Vec<&str>| {
            let last = run.last().and_then(|last| number(last));
            last.zip(number(id)).is_some_and(|(last, this)| last + 1 == this)
        };
        match runs.last_mut().filter(|run| follows(run)) {
            Some(run) => run.push(id),
            None => runs.push(vec![id]),
        }
    }
    let one = |id: &str| Reference { first: id.to_owned(), last: String::new() };
    runs.iter()
        .flat_map(|run| match run.as_slice() {
            [first, _, .., last] => {
                vec![Reference { first: (*first).to_owned(), last: (*last).to_owned() }]
            }
            few => few.iter().map(|id| one(id)).collect(),
        })
        .collect()
}

impl Figure {
    /// A figure without assumptions.
    pub fn new(name: impl Into<String>, svg: Svg, caption: impl Into<String>) -> Self {
        let svg = svg.into_string();
        let width = svg.split(" width=\"").nth(1).and_then(|rest| rest.split('"').next());
        let drawn_px = width.and_then(|width| width.parse::<f64>().ok()).unwrap_or(WIDE_PX);
        let (wide, assumptions) = (drawn_px > WIDE_PX, Vec::new());
        Self { name: name.into(), svg, wide, drawn_px, caption: caption.into(), assumptions }
    }

    /// The same, resting on these.
    pub fn resting_on(self, assumptions: &[&str]) -> Self {
        Self { assumptions: references(assumptions), ..self }
    }
}

/// A cell of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Cell {
    /// What it says.
    pub text: String,
    /// How it looks: `number`, `absent`, a status, or nothing.
    pub class: &'static str,
    /// Over how many columns; 0 and 1 are one.
    pub span: usize,
    /// In place of the text: markup of our own.
    pub markup: String,
    /// What it refers to, after the text.
    pub links: Vec<Reference>,
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// A number, already written.
    pub fn number(text: impl Into<String>) -> Self {
        Self { text: text.into(), class: "number", ..Self::default() }
    }

    /// A measure, or in words why there is none.
    pub fn measured(value: Result<f64, impl Display>, decimals: usize) -> Self {
        let class = if value.is_ok() { "number" } else { "absent" };
        Self { text: number::measured(value, decimals), class, ..Self::default() }
    }

    /// Links to these ids.
    pub fn links(ids: &[&str]) -> Self {
        Self { links: references(ids), class: "refs", ..Self::default() }
    }

    /// One reason in place of so many measures.
    pub fn failing(reason: impl Into<String>, span: usize) -> Self {
        Self { text: reason.into(), class: "failing", span, ..Self::default() }
    }

    /// What is not shown here, over so many columns.
    pub fn left_out(what: impl Into<String>, span: usize) -> Self {
        Self { class: "absent", ..Self::failing(what, span) }
    }

    /// Words in which assumptions and errata are linked.
    pub fn linked(text: &str) -> Self {
        Self { markup: markdown::linked(text), ..Self::default() }
    }
}

/// A row of a table; its first cell heads it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct TableRow {
    /// Its id in the page, if something refers to it.
    pub id: String,
    /// How it looks.
    pub class: &'static str,
    /// Its cells.
    pub cells: Vec<Cell>,
}

impl From<Vec<Cell>> for TableRow {
    fn from(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }
}

/// A heading over several columns.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// What it says.
    pub text: String,
    /// Over how many columns.
    pub span: usize,
}

/// A table.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PageTable {
    /// What it holds.
    pub caption: String,
    /// Headings over several columns, or none.
    pub groups: Vec<Group>,
    /// Headings of the columns, with their units.
    pub head: Vec<String>,
    /// What each cell is called where the headings are out of sight.
    pub labels: Vec<String>,
    /// Rows.
    pub rows: Vec<TableRow>,
    /// True for a table that becomes a list of cards on a narrow screen.
    pub cards: bool,
}

impl PageTable {
    /// A table with these columns.
    pub fn new(caption: impl Into<String>, head: &[&str]) -> Self {
        let head: Vec<String> = head.iter().map(|text| (*text).to_owned()).collect();
        Self { caption: caption.into(), labels: head.clone(), head, ..Self::default() }
    }

    /// With headings over its columns.
    pub fn grouped(mut self, groups: &[(&str, usize)]) -> Self {
        let group = |(text, span): &(&str, usize)| Group { text: (*text).to_owned(), span: *span };
        self.groups = groups.iter().map(group).collect();
        let over = groups.iter().flat_map(|(text, span)| std::iter::repeat_n(*text, *span));
        for (label, group) in
            self.labels.iter_mut().zip(over).filter(|(_, group)| !group.is_empty())
        {
            *label = format!("{group}: {label}");
        }
        self
    }

    /// A list of cards where the screen is narrow.
    pub fn in_cards(mut self) -> Self {
        self.cards = true;
        self
    }

    /// Adds a row.
    pub fn push(&mut self, row: impl Into<TableRow>) {
        self.rows.push(row.into());
    }
}

/// A part of a report.
#[derive(Clone, Debug, Serialize)]
pub struct PageSection {
    /// Its id in the page.
    pub id: &'static str,
    /// Its heading.
    pub title: String,
    /// Its markup.
    pub body: String,
    /// The figures in it, for files of their own.
    #[serde(skip)]
    pub figures: Vec<Figure>,
}

impl PageSection {
    /// A section with this markup.
    #[must_use]
    pub fn of(id: &'static str, title: &str, body: String) -> Self {
        Self { id, title: title.to_owned(), body, figures: Vec::new() }
    }

    /// The same, with its figures.
    pub fn with_figures(self, figures: Vec<Figure>) -> Self {
        Self { figures, ..self }
    }
}

/// What makes figures live, where scripts run: read at the pointer, enlarged, curve by curve.
pub const SCRIPT: &str = include_str!("template/figures.js");

/// SHA-256 of [`SCRIPT`], the only script that a browser may run in a report.
pub const SCRIPT_DIGEST: &str = "sha256-Mb7r0ssNZHR3POxqtk+HEgJU+ZbQ9BxxKc/0mQ1ULr4=";

/// What a browser may load and run in a report: its own style and script, and nothing from outside.
pub(crate) fn policy() -> String {
    format!(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
         img-src data:; script-src '{SCRIPT_DIGEST}'\">"
    )
}

/// The style sheet of a report.
pub fn style() -> String {
    format!("{}{}", include_str!("template/style.css"), page_style())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_in_a_row_are_a_run() {
        let found = references(&["A1", "A2", "A23", "A3", "A5", "A6"]);
        let text: Vec<String> = found.iter().map(|r| format!("{}-{}", r.first, r.last)).collect();
        assert_eq!(text, ["A1-A3", "A5-", "A6-", "A23-"]);
    }
}
