//! The report of the paper, section by section.

use super::section;
use crate::report::templates::render;
use crate::reproduce::{Library, Reproduction, Stored};
use fspid_page::context;
use fspid_page::page::{self, Section};

/// What the report is about.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper<'a> {
    /// All scenarios.
    pub(super) library: &'a Library,
    /// What came of them.
    pub(super) reproduction: &'a Reproduction,
}

/// The page.
pub(super) fn report(paper: &Paper<'_>) -> String {
    let title = "A fuzzy self-tuning PID pitch autopilot, flown again";
    let sections: Vec<Section> = section::ALL.iter().map(|of| of(paper)).collect();
    let context = context! {
        title,
        heading => title,
        lead => render("paper", context! {}),
        style => page::style(),
        sections,
        verdict_first => false,
        version => env!("CARGO_PKG_VERSION"),
    };
    render("page", context)
}

/// Figures, traces and scenarios, each as a file.
pub(super) fn files(paper: &Paper<'_>) -> Vec<(String, String)> {
    let Paper { library, reproduction } = paper;
    let mut files: Vec<(String, String)> = section::DRAWING
        .iter()
        .flat_map(|of| of(paper).figures)
        .map(|figure| (format!("figures/{}.svg", figure.name), figure.svg))
        .collect();
    for flown in &reproduction.figures {
        let name = format!("traces/figure-{}-{}.csv", flown.figure.id, flown.fit.name());
        files.push((name, flown.simulation.csv()));
    }
    for (name, _, simulation) in section::disturbances::flights(library) {
        files.push((format!("traces/{name}.csv"), simulation.csv()));
    }
    files.push(("traces/long-term-change.csv".to_owned(), reproduction.long_term.csv()));
    for Stored { name, text } in library.scenarios() {
        files.push((format!("scenarios/{name}"), text.clone()));
    }
    files
}
