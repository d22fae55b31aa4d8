//! The report of the paper, section by section: one file and one row each.

mod claims;
mod conventions;
mod disturbances;
mod documents;
mod identification;
mod provenance;
mod responses;
mod rules;
mod stability;
mod summary;
mod templates;
mod variants;

use self::templates::render;
use crate::{Library, Reproduction, Status, Stored};
use fspid_page::context;
use fspid_page::page::{self, Cell, PageSection};

/// What the report is about.
#[derive(Clone, Copy, Debug)]
struct Paper<'a> {
    /// All scenarios.
    library: &'a Library,
    /// What came of them.
    reproduction: &'a Reproduction,
}

/// The page.
fn report(paper: &Paper<'_>) -> String {
    let title = "A fuzzy self-tuning PID pitch autopilot, flown again";
    let sections: Vec<PageSection> = ALL.iter().map(|of| of(paper)).collect();
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
fn files(paper: &Paper<'_>) -> Vec<(String, String)> {
    let Paper { library, reproduction } = paper;
    let mut files: Vec<(String, String)> = DRAWING
        .iter()
        .flat_map(|of| of(paper).figures)
        .map(|figure| (format!("figures/{}.svg", figure.name), figure.svg))
        .collect();
    for flown in &reproduction.figures {
        let name = format!("traces/figure-{}-{}.csv", flown.figure.id, flown.fit.name());
        files.push((name, flown.simulation.csv()));
    }
    for disturbances::StoredFlight { name, simulation, .. } in disturbances::flights(library) {
        files.push((format!("traces/{name}.csv"), simulation.csv()));
    }
    files.push(("traces/long-term-change.csv".to_owned(), reproduction.long_term.csv()));
    for Stored { name, text } in library.scenarios() {
        files.push((format!("scenarios/{name}"), text.clone()));
    }
    files
}

/// The sections that draw figures, which are files of their own beside the report.
const DRAWING: &[fn(&Paper<'_>) -> PageSection] = &[
    summary::section,
    conventions::section,
    rules::section,
    responses::section,
    disturbances::section,
    claims::section,
    identification::section,
    variants::section,
];

/// The sections in their order.
const ALL: &[fn(&Paper<'_>) -> PageSection] = &[
    summary::section,
    conventions::section,
    rules::section,
    responses::section,
    disturbances::section,
    claims::section,
    stability::section,
    documents::errata,
    documents::assumptions,
    identification::section,
    variants::section,
    provenance::section,
];

/// A status as a sign and a word.
fn status(status: Status) -> Cell {
    Cell { class: status.name(), ..Cell::text(format!("{} {}", sign(status), status.name())) }
}

/// The sign of a status; the word always stands beside it.
const fn sign(status: Status) -> &'static str {
    match status {
        Status::Reproduced => "\u{2713}",
        Status::Approached => "\u{2248}",
        Status::Contradicted => "\u{2717}",
        Status::Undetermined => "?",
    }
}

/// The report of the paper.
#[must_use]
pub fn of_reproduction(library: &Library, reproduction: &Reproduction) -> String {
    report(&Paper { library, reproduction })
}

/// Everything that lies beside the report: names below its folder, and texts.
#[must_use]
pub fn files_of_reproduction(
    library: &Library,
    reproduction: &Reproduction,
) -> Vec<(String, String)> {
    files(&Paper { library, reproduction })
}
