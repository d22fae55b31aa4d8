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

use super::page::Section;
use super::paper::Paper;

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
