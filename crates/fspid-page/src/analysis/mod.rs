//! The page of a loop analysis: verdicts first, then chapters of text, tables and figures.
//!
//! What goes in is plain: words, written numbers and drawings, in the order in which they shall stand. The
//! page escapes all words, gives ids that do not clash, and has the look of the other reports. It judges
//! nothing; only a page to which no verdict was given says so in the place where one would stand.

mod chapter;
#[cfg(test)]
mod tests;

pub use chapter::{Chapter, DataTable, Datum, Item, Picture};
pub(crate) use chapter::{Ids, ShownSection, markup};

use serde::Serialize;

use super::page;
use crate::context;
use crate::html::render;

/// Everything that a page of an analysis holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnalysisPage {
    /// Title of the document, as a browser shows it in its tab.
    pub title: String,
    /// Heading of the page, such as the name of the scenario.
    pub heading: String,
    /// One or two sentences below the heading: what was analysed, and in which units.
    pub lead: String,
    /// What was found out, one box each, in this order.
    pub verdicts: Vec<Verdict>,
    /// Below the verdicts: what is to be known before they are believed.
    pub warnings: Vec<String>,
    /// Below the warnings: what the verdicts do not cover.
    pub beside: Vec<String>,
    /// Below the warnings: a table of requirements, and whether all are met.
    pub requirements: Option<(DataTable, bool)>,
    /// Chapters, in this order.
    pub chapters: Vec<Chapter>,
    /// The last chapter: what wrote the page and from what.
    pub provenance: Provenance,
}

/// A verdict: who is judged, how it stands, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// How it stands; gives the colour and the sign.
    pub standing: Standing,
    /// The verdict in a word or two, such as "Stable" or "UNSTABLE"; the sign is put before it.
    pub word: String,
    /// Who is judged, such as the name of a controller.
    pub name: String,
    /// The numbers behind it, in a sentence or two.
    pub detail: String,
}

/// How something stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// As it should be.
    Good,
    /// Neither good nor bad: open, or below what is asked for without harm.
    Fair,
    /// Not as it should be.
    Bad,
}

impl Standing {
    const fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Fair => "fair",
            Self::Bad => "bad",
        }
    }

    const fn sign(self) -> &'static str {
        match self {
            Self::Good => "\u{2713}",
            Self::Fair => "!",
            Self::Bad => "\u{2717}",
        }
    }
}

/// What wrote a page, and from what.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The command, such as `fspid analyse FILE --report OUT.html`.
    pub command: String,
    /// SHA-256 of the scenario and all it refers to.
    pub digest: String,
    /// Further rows: what, and its value.
    pub further: Vec<(String, String)>,
}

/// A verdict as the template shows it.
#[derive(Serialize)]
pub(crate) struct Shown<'a> {
    class: &'static str,
    sign: &'static str,
    word: &'a str,
    name: &'a str,
    detail: &'a str,
}

impl AnalysisPage {
    /// The page as one HTML file without any outside reference.
    #[must_use]
    pub fn render(&self) -> String {
        let mut ids = Ids::default();
        let mut sections = vec![self.verdict_section(&mut ids)];
        sections.extend(self.chapters.iter().map(|chapter| chapter.shown(&mut ids)));
        sections.push(self.provenance_section(&mut ids));
        let context = context! {
            title => self.title,
            heading => self.heading,
            lead => render("analysis", context! { part => "lead", lead => self.lead }),
            style => page::style(),
            sections,
            verdict_first => true,
            version => env!("CARGO_PKG_VERSION"),
        };
        render("page", context)
    }

    fn verdict_section(&self, ids: &mut Ids) -> ShownSection {
        let verdicts: Vec<Shown<'_>> = self.verdicts.iter().map(Verdict::shown).collect();
        let context = context! {
            part => "verdicts",
            verdicts,
            warnings => self.warnings,
            beside => self.beside,
            requirements => self.requirements.as_ref().map(|(table, _)| table.shown()),
            met => self.requirements.as_ref().is_some_and(|(_, met)| *met),
        };
        ShownSection::of("verdict", "Verdict", render("analysis", context), ids)
    }

    fn provenance_section(&self, ids: &mut Ids) -> ShownSection {
        let Provenance { command, digest, further } = &self.provenance;
        let context = context! {
            part => "provenance",
            version => env!("CARGO_PKG_VERSION"),
            command,
            digest,
            further,
        };
        ShownSection::of("provenance", "Provenance", render("analysis", context), ids)
    }
}

impl Verdict {
    pub(crate) fn shown(&self) -> Shown<'_> {
        Shown {
            class: self.standing.class(),
            sign: self.standing.sign(),
            word: &self.word,
            name: &self.name,
            detail: &self.detail,
        }
    }
}
