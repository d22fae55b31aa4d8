//! What chapters are made of.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::context;
use crate::html::render;
use crate::page::{Cell, Figure, PageSection, PageTable};
use fspid_plot::Svg;

/// A chapter of a page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chapter {
    /// What links point to: letters, digits and hyphens; anything else becomes a hyphen, and a second one of
    /// the same name gets a number.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// What it holds, in this order.
    pub items: Vec<Item>,
}

/// A part of a chapter.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A paragraph.
    Text(String),
    /// A paragraph that must not be overlooked.
    Warning(String),
    /// A heading within the chapter.
    Heading(String),
    /// A list of short sentences.
    List(Vec<String>),
    /// Lines as a program wrote them, such as a command or a part of a file.
    Code(String),
    /// One figure.
    Figure(Picture),
    /// Figures side by side where there is room: two in a row, or three where they are more.
    Figures(Vec<Picture>),
    /// A table.
    Table(DataTable),
    /// What few will read, behind a heading that opens it.
    Fold(String, Vec<Item>),
}

/// A figure with its caption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// What links point to, as the id of a chapter.
    pub name: String,
    /// The drawing.
    pub svg: Svg,
    /// What it shows.
    pub caption: String,
}

/// A table; the first cell of each row heads it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataTable {
    /// What it holds.
    pub caption: String,
    /// Headings of the columns, with their units.
    pub head: Vec<String>,
    /// Rows of cells.
    pub rows: Vec<Vec<Datum>>,
    /// True for a table that becomes a list of cards on a narrow screen.
    pub cards: bool,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Datum {
    /// Words.
    Text(String),
    /// A number, already written.
    Number(String),
    /// A command or a part of a file, as it was typed.
    Code(String),
    /// Why there is no number here.
    Absent(String),
    /// What is as asked for, in words; the sign is put before it.
    Met(String),
    /// What is not as asked for, in words; the sign is put before it.
    Unmet(String),
    /// One reason in place of so many cells.
    Failing(String, usize),
}

impl Datum {
    fn cell(&self) -> Cell {
        match self {
            Self::Text(text) => Cell::text(text),
            Self::Number(text) => Cell::number(text),
            Self::Code(text) => {
                // Broken between words alone, lest a hyphen end a line; a style sheet has the rest.
                let words =
                    text.split(' ').map(|it| format!("<span>{}</span>", crate::html::escape(it)));
                let words: Vec<String> = words.collect();
                let markup = format!("<code>{}</code>", words.join(" "));
                Cell { markup, ..Cell::default() }
            }
            Self::Absent(reason) => Cell { class: "absent", ..Cell::text(reason) },
            Self::Met(text) => Cell { class: "met", ..Cell::text(format!("\u{2713} {text}")) },
            Self::Unmet(text) => Cell { class: "unmet", ..Cell::text(format!("\u{2717} {text}")) },
            Self::Failing(reason, span) => Cell::failing(reason, *span),
        }
    }
}

impl DataTable {
    pub(crate) fn shown(&self) -> PageTable {
        let head: Vec<&str> = self.head.iter().map(String::as_str).collect();
        let mut table = PageTable::new(&self.caption, &head);
        table.cards = self.cards;
        for row in &self.rows {
            table.push(row.iter().map(Datum::cell).collect::<Vec<Cell>>());
        }
        // A row that is too long would have no headings for its last cells.
        let widest =
            table.rows.iter().map(|row| row.cells.iter().map(|cell| cell.span.max(1)).sum());
        let widest = widest.max().unwrap_or(0);
        for names in [&mut table.head, &mut table.labels] {
            names.resize(names.len().max(widest), String::new());
        }
        table
    }
}

/// An item as the template shows it.
#[derive(Serialize, Default)]
struct Shown {
    kind: &'static str,
    text: String,
    /// Markup of our own.
    body: String,
    lines: Vec<String>,
    figures: Vec<Figure>,
    table: Option<PageTable>,
}

/// A section as the page shows it.
#[derive(Serialize)]
pub(crate) struct ShownSection {
    pub(crate) id: String,
    pub(crate) title: String,
    pub(crate) body: String,
}

impl ShownSection {
    /// A section with an id like that one.
    pub(crate) fn of(wanted: &str, title: &str, body: String, ids: &mut Ids) -> Self {
        Self { id: ids.take(wanted), title: title.to_owned(), body }
    }
}

impl Chapter {
    /// As a section of a report of flights.
    #[must_use]
    pub fn section(&self, id: &'static str) -> PageSection {
        PageSection::of(id, &self.title, markup(&self.items, &mut Ids::default()))
    }

    pub(crate) fn shown(&self, ids: &mut Ids) -> ShownSection {
        // Its own id before those of what is in it.
        let id = ids.take(&self.id);
        ShownSection { id, title: self.title.clone(), body: markup(&self.items, ids) }
    }
}

/// The markup of some items, one after the other.
pub(crate) fn markup(items: &[Item], ids: &mut Ids) -> String {
    let items: Vec<Shown> = items.iter().map(|item| item.shown(ids)).collect();
    render("analysis", context! { part => "chapter", items })
}

impl Item {
    fn shown(&self, ids: &mut Ids) -> Shown {
        let words = |kind, text: &String| Shown { kind, text: text.clone(), ..Shown::default() };
        match self {
            Self::Text(text) => words("text", text),
            Self::Warning(text) => words("warning", text),
            Self::Heading(text) => words("heading", text),
            Self::Code(text) => words("code", text),
            Self::List(lines) => Shown { kind: "list", lines: lines.clone(), ..Shown::default() },
            Self::Fold(title, items) => Shown { body: markup(items, ids), ..words("fold", title) },
            Self::Figure(picture) => {
                Shown { kind: "figure", figures: vec![picture.shown(ids)], ..Shown::default() }
            }
            Self::Figures(pictures) => {
                let figures: Vec<Figure> = pictures.iter().map(|one| one.shown(ids)).collect();
                let kind = if figures.len() > 2 { "three" } else { "pair" };
                Shown { kind, figures, ..Shown::default() }
            }
            Self::Table(table) => {
                Shown { kind: "table", table: Some(table.shown()), ..Shown::default() }
            }
        }
    }
}

impl Picture {
    fn shown(&self, ids: &mut Ids) -> Figure {
        Figure::new(ids.take(&self.name), self.svg.clone(), &self.caption)
    }
}

/// Ids that a page has given away.
#[derive(Default)]
pub(crate) struct Ids {
    taken: BTreeSet<String>,
}

impl Ids {
    /// An id like `wanted` that no other element of the page has.
    pub(crate) fn take(&mut self, wanted: &str) -> String {
        let plain: String = wanted
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' })
            .collect();
        // The page itself has an element of this name.
        let plain = match plain.trim_matches('-') {
            "" => "part",
            "content" => "content-part",
            name => name,
        };
        let mut id = plain.to_owned();
        let mut n = 1;
        while !self.taken.insert(id.clone()) {
            n += 1;
            id = format!("{plain}-{n}");
        }
        id
    }
}
