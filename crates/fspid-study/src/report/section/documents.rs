//! The errata and the assumptions, from the project's own documents.

use fspid_data::{ASSUMPTIONS, ERRATA};

use crate::report::html::context;
use crate::report::markdown;
use crate::report::page::Section;
use crate::report::paper::Paper;

/// What is wrong or contradictory in print.
pub(super) fn errata(_: &Paper<'_>) -> Section {
    Section::of("errata", "Errata", "document", context! { html => markdown::html(ERRATA) })
}

/// What the paper leaves open and what stands in its place.
pub(super) fn assumptions(_: &Paper<'_>) -> Section {
    Section::of(
        "assumptions",
        "Assumptions",
        "document",
        context! { html => markdown::html(ASSUMPTIONS) },
    )
}
