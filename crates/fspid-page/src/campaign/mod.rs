//! The page of a campaign: which one it is, what it says, then chapters of figures and tables.
//!
//! What goes in is plain, as for the page of an analysis, whose chapters it has. The page escapes all words,
//! gives ids that do not clash, and has the look of the other reports. It judges nothing.

#[cfg(test)]
mod tests;

use super::analysis::{Chapter, Ids, Item, ShownSection, Verdict, markup};
use super::page;
use crate::context;
use crate::html::render;

/// Everything that the page of a campaign holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CampaignPage {
    /// Title of the document, as a browser shows it in its tab.
    pub title: String,
    /// Heading of the page, such as the name of the scenario.
    pub heading: String,
    /// One or two sentences below the heading.
    pub lead: String,
    /// Which campaign it is: what, and its value.
    pub facts: Vec<(String, String)>,
    /// Commands that make everything again, one a line.
    pub commands: String,
    /// What was found out, one box each, in this order.
    pub verdicts: Vec<Verdict>,
    /// Below the boxes: figures and tables that belong to the answer.
    pub answer: Vec<Item>,
    /// Below the answer: what is to be known before the numbers are believed.
    pub notes: Vec<String>,
    /// Chapters, in this order.
    pub chapters: Vec<Chapter>,
}

impl CampaignPage {
    /// The page as one HTML file without any outside reference.
    #[must_use]
    pub fn render(&self) -> String {
        let mut ids = Ids::default();
        let mut sections = vec![self.answer_section(&mut ids)];
        sections.extend(self.chapters.iter().map(|chapter| chapter.shown(&mut ids)));
        let lead = context! {
            part => "lead",
            lead => self.lead,
            facts => self.facts,
            commands => self.commands,
        };
        let context = context! {
            title => self.title,
            heading => self.heading,
            lead => render("campaign", lead),
            style => format!("{}{}", page::style(), include_str!("../template/campaign.css")),
            sections,
            verdict_first => true,
            version => env!("CARGO_PKG_VERSION"),
        };
        render("page", context)
    }

    fn answer_section(&self, ids: &mut Ids) -> ShownSection {
        let id = ids.take("answer");
        let verdicts: Vec<_> = self.verdicts.iter().map(Verdict::shown).collect();
        let context = context! {
            part => "answer",
            verdicts,
            answer => markup(&self.answer, ids),
            notes => self.notes,
        };
        ShownSection { id, title: "Answer".to_owned(), body: render("campaign", context) }
    }
}
