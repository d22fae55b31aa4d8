//! The sections of the paper's report: one file and one row each.

mod claims;
mod conventions;
pub(super) mod disturbances;
mod documents;
mod identification;
mod provenance;
mod responses;
mod rules;
mod stability;
mod summary;
mod variants;

use super::paper::Paper;
use crate::reproduce::Status;
use fspid_page::page::{Cell, Section};

/// The sections that draw figures, which are files of their own beside the report.
pub(super) const DRAWING: &[fn(&Paper<'_>) -> Section] = &[
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
pub(super) const ALL: &[fn(&Paper<'_>) -> Section] = &[
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
