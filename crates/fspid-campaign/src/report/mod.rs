//! The page of a campaign: a [`Summary`] with figures, one HTML file that needs nothing else.
//!
//! ```text
//! merged file ─Summary::of▶ Summary ─▶ words, tables, figures ─CampaignPage::render▶ HTML
//!        └─plan in its metadata▶ a few hundred runs flown again ─▶ bands of responses
//! ```
//!
//! The same file, with the same files beside it, gives the same bytes. What is drawn point by point is
//! bounded, so that a page of a million runs is not longer than one of ten thousand.

mod answer;
mod by_parameter;
mod distributions;
mod head;
mod maps;
mod measures;
mod notes;
mod reflown;
mod responses;
mod sensitivities;
#[cfg(test)]
mod tests;
mod words;
mod worst;

use std::path::Path;

use fspid_page::analysis::{Item, Picture};
use fspid_page::campaign::CampaignPage;
use fspid_plot::{SeriesStyle, Svg};

use crate::folder::Folder;
use crate::summary::{Files, Found, Summary, SummaryError, SummarySettings};
pub use responses::{Envelope, Envelopes};

/// What can be chosen about a page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Confidence of intervals and bounds.
    pub summary: SummarySettings,
    /// The campaign's folder as commands shall name it; `DIR` if none is given.
    pub folder: Option<String>,
}

/// The page of the merged file at a path, or of the parts in a campaign's folder.
///
/// Runs are flown again on the threads of the pool that this is called in. If they cannot be (files that the
/// scenario names are gone, another version of the program flew), the page says why in place of their figures.
///
/// # Errors
/// A file that cannot be read, is damaged, or is not that of a whole campaign.
pub fn page(path: &Path, settings: &Settings) -> Result<String, SummaryError> {
    page_of(path, &Summary::of(path, settings.summary)?, settings)
}

/// As [`page`], of a file that is summarised already. The summary of another file is not used.
///
/// # Errors
/// As there.
pub fn page_of(
    path: &Path,
    summary: &Summary,
    settings: &Settings,
) -> Result<String, SummaryError> {
    let found = Found::at(path, settings.summary)?;
    if !found.is_of(summary) {
        // Figures and words of two files must not stand on one page.
        return page(path, settings);
    }
    let folder = settings.folder.as_deref().unwrap_or("DIR");
    let scenario = settings.folder.as_ref().and_then(|_| scenario_beside(path, summary));
    let scenario = scenario.as_deref().unwrap_or("SCENARIO.toml");
    Ok(Source { summary, files: &found.files, folder, scenario }.page()?.render())
}

/// The scenario as it was given when the campaign was planned: rows keep its text, and the plan beside them its path. Of a
/// path from the root the name alone is told: pages are handed on, and such folders are of one machine.
fn scenario_beside(path: &Path, summary: &Summary) -> Option<String> {
    let folder = if path.is_dir() { path } else { path.parent()? };
    let plan = Folder::new(folder).plan().ok()?;
    let given = Path::new(&plan.scenario_path);
    let shown = if given.is_relative() { given.as_os_str() } else { given.file_name()? };
    let is_planned = plan.scenario_digest == summary.head.scenario_digest && !shown.is_empty();
    is_planned.then(|| shown.to_string_lossy().into_owned())
}

/// What pitch does over time in the first runs, `most` at most, of the merged file at a path or of the parts in a
/// campaign's folder, which `summary` is about. They are flown again on the threads of the pool that this is called in.
///
/// # Errors
/// In a sentence: a file that cannot be read or is not that of the summary; runs that cannot be flown again, or that do
/// not give the bits of the file.
pub fn envelopes(
    path: &Path,
    summary: &Summary,
    settings: SummarySettings,
    most: u64,
) -> Result<Envelopes, String> {
    let found = Found::at(path, settings).map_err(|error| error.to_string())?;
    match found.is_of(summary) {
        true => {
            let source = Source { summary, files: &found.files, folder: "", scenario: "" };
            responses::envelopes(&source, most)
        }
        false => Err("the file has changed since it was summarised".to_owned()),
    }
}

/// What a page is made from.
#[derive(Clone, Copy)]
struct Source<'a> {
    summary: &'a Summary,
    files: &'a Files,
    folder: &'a str,
    scenario: &'a str,
}

impl Source<'_> {
    fn page(&self) -> Result<CampaignPage, SummaryError> {
        let mut chapters = vec![distributions::chapter(self)];
        chapters.push(responses::chapter(self));
        chapters.extend(maps::chapter(self)?);
        chapters.extend(sensitivities::chapter(self));
        chapters.push(worst::chapter(self));
        chapters.push(head::scenario(self));
        let heading = head::heading(self);
        Ok(CampaignPage {
            title: format!("{heading}: campaign"),
            lead: head::lead(self),
            facts: head::facts(self),
            commands: head::commands(self),
            verdicts: answer::verdicts(self),
            answer: answer::items(self),
            notes: notes::notes(self),
            chapters,
            heading,
        })
    }

    /// The command that flies a run again.
    fn replay(&self, run: u64) -> String {
        let folder = fspid_study::shell::word(self.folder);
        format!("fspid campaign replay {folder} --run {run} --trace run-{run}.csv")
    }

    /// Names of controllers, cut to a length that headings and legends have room for.
    fn name(&self, controller: usize) -> String {
        let name = self.summary.controllers.get(controller).map_or("", |it| it.name.as_str());
        words::cut(name, 60)
    }
}

/// How the controller at a place is drawn in every figure.
fn style(controller: usize) -> SeriesStyle {
    SeriesStyle::Numbered(controller)
}

fn picture(name: &str, svg: Svg, caption: impl Into<String>) -> Item {
    Item::Figure(Picture { name: name.to_owned(), svg, caption: caption.into() })
}
