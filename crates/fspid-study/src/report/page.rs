//! What pages are made of: sections, figures with captions, tables with heads.

use minijinja::value::Value;
use serde::Serialize;

use super::{html, markdown, number};
use crate::metrics::Measured;
use crate::reproduce::Status;
use fspid_plot::{Svg, page_style};

/// A figure with its caption.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Figure {
    /// File name without its ending, and the figure's id in the page.
    pub(super) name: String,
    /// The drawing.
    pub(super) svg: String,
    /// True for a drawing that does not shrink to a narrow screen but is moved sideways there.
    pub(super) wide: bool,
    /// What it shows.
    pub(super) caption: String,
    /// Numbers of the assumptions it rests on.
    pub(super) assumptions: Vec<Reference>,
}

/// A drawing that is wider than this cannot be read when it is shrunk to a phone, px.
const WIDE_PX: f64 = 600.0;

/// Numbered things that are referred to: one, or a run of them from the first to the last.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Reference {
    /// Its id in the page.
    pub(super) first: String,
    /// Id of the last one of a run; empty for one alone.
    pub(super) last: String,
}

/// References to these ids; three or more numbers in a row become a run.
pub(super) fn references(ids: &[&str]) -> Vec<Reference> {
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
    pub(super) fn new(name: impl Into<String>, svg: Svg, caption: impl Into<String>) -> Self {
        let svg = svg.into_string();
        let width = svg.split(" width=\"").nth(1).and_then(|rest| rest.split('"').next());
        let wide =
            width.and_then(|width| width.parse::<f64>().ok()).is_some_and(|width| width > WIDE_PX);
        Self { name: name.into(), svg, wide, caption: caption.into(), assumptions: Vec::new() }
    }

    /// The same, resting on these.
    pub(super) fn resting_on(self, assumptions: &[&str]) -> Self {
        Self { assumptions: references(assumptions), ..self }
    }
}

/// A cell of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Cell {
    /// What it says.
    pub(super) text: String,
    /// How it looks: `number`, `absent`, a status, or nothing.
    pub(super) class: &'static str,
    /// Over how many columns; 0 and 1 are one.
    pub(super) span: usize,
    /// In place of the text: markup of our own.
    pub(super) markup: String,
    /// What it refers to, after the text.
    pub(super) links: Vec<Reference>,
}

impl Cell {
    /// Words.
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// A number, already written.
    pub(super) fn number(text: impl Into<String>) -> Self {
        Self { text: text.into(), class: "number", ..Self::default() }
    }

    /// A measure, or in words why there is none.
    pub(super) fn measured(value: Measured, decimals: usize) -> Self {
        let class = if value.is_ok() { "number" } else { "absent" };
        Self { text: number::measured(value, decimals), class, ..Self::default() }
    }

    /// A status as a sign and a word.
    pub(super) fn status(status: Status) -> Self {
        Self {
            text: format!("{} {}", sign(status), status.name()),
            class: status.name(),
            ..Self::default()
        }
    }

    /// Links to these ids.
    pub(super) fn links(ids: &[&str]) -> Self {
        Self { links: references(ids), class: "refs", ..Self::default() }
    }

    /// One reason in place of so many measures.
    pub(super) fn failing(reason: impl Into<String>, span: usize) -> Self {
        Self { text: reason.into(), class: "failing", span, ..Self::default() }
    }

    /// What is not shown here, over so many columns.
    pub(super) fn left_out(what: impl Into<String>, span: usize) -> Self {
        Self { class: "absent", ..Self::failing(what, span) }
    }

    /// Words in which assumptions and errata are linked.
    pub(super) fn linked(text: &str) -> Self {
        Self { markup: markdown::linked(text), ..Self::default() }
    }
}

/// The sign of a status; the word always stands beside it.
pub(super) const fn sign(status: Status) -> &'static str {
    match status {
        Status::Reproduced => "\u{2713}",
        Status::Approached => "\u{2248}",
        Status::Contradicted => "\u{2717}",
        Status::Undetermined => "?",
    }
}

/// A row of a table; its first cell heads it.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Row {
    /// Its id in the page, if something refers to it.
    pub(super) id: String,
    /// How it looks.
    pub(super) class: &'static str,
    /// Its cells.
    pub(super) cells: Vec<Cell>,
}

impl From<Vec<Cell>> for Row {
    fn from(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }
}

/// A heading over several columns.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Group {
    /// What it says.
    pub(super) text: String,
    /// Over how many columns.
    pub(super) span: usize,
}

/// A table.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Table {
    /// What it holds.
    pub(super) caption: String,
    /// Headings over several columns, or none.
    pub(super) groups: Vec<Group>,
    /// Headings of the columns, with their units.
    pub(super) head: Vec<String>,
    /// What each cell is called where the headings are out of sight.
    pub(super) labels: Vec<String>,
    /// Rows.
    pub(super) rows: Vec<Row>,
    /// True for a table that becomes a list of cards on a narrow screen.
    pub(super) cards: bool,
}

impl Table {
    /// A table with these columns.
    pub(super) fn new(caption: impl Into<String>, head: &[&str]) -> Self {
        let head: Vec<String> = head.iter().map(|text| (*text).to_owned()).collect();
        Self { caption: caption.into(), labels: head.clone(), head, ..Self::default() }
    }

    /// With headings over its columns.
    pub(super) fn grouped(mut self, groups: &[(&str, usize)]) -> Self {
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
    pub(super) fn in_cards(mut self) -> Self {
        self.cards = true;
        self
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: impl Into<Row>) {
        self.rows.push(row.into());
    }
}

/// A part of a report.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Section {
    /// Its id in the page.
    pub(super) id: &'static str,
    /// Its heading.
    pub(super) title: String,
    /// Its markup.
    pub(super) body: String,
    /// The figures in it, for files of their own.
    #[serde(skip)]
    pub(super) figures: Vec<Figure>,
}

impl Section {
    /// A section whose body is a filled template.
    pub(super) fn of(id: &'static str, title: &str, template: &str, context: Value) -> Self {
        let body = html::render(template, context);
        Self { id, title: title.to_owned(), body, figures: Vec::new() }
    }

    /// The same, with its figures.
    pub(super) fn with_figures(self, figures: Vec<Figure>) -> Self {
        Self { figures, ..self }
    }
}

/// The style sheet of a report.
pub(super) fn style() -> String {
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
