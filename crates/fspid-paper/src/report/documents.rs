//! The errata and the assumptions, from the project's own documents.

use crate::report::Paper;
use crate::report::templates::render;
use fspid_data::{ASSUMPTIONS, ERRATA};
use fspid_page::page::PageSection;
use fspid_page::{context, markdown};

/// What is wrong or contradictory in print.
pub(super) fn errata(_: &Paper<'_>) -> PageSection {
    PageSection::of(
        "errata",
        "Errata",
        render("document", context! { html => markdown::html(ERRATA), dense => false }),
    )
}

/// What the paper leaves open and what stands in its place.
pub(super) fn assumptions(_: &Paper<'_>) -> PageSection {
    PageSection::of(
        "assumptions",
        "Assumptions",
        render("document", context! { html => markdown::html(ASSUMPTIONS), dense => true }),
    )
}
