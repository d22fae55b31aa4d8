//! Reports: one HTML file each, without any outside reference or needed script.
//!
//! Sentences stand in the templates, numbers are computed here; nothing in a template knows a value
//! of its own. What a user has named is escaped wherever it appears, in figures too.
//!
//! Not here: what is measured and judged (`metrics`, `reproduce`), and how a line is drawn (`figure`).

mod audit;
mod loops;
mod measures;
mod paper;
mod section;
mod settings;
mod supervisor;
mod templates;
mod traces;
mod user;

use crate::analysis::Analysis;
use crate::fuzzy_system::Audit;
use crate::reproduce::{Library, Reproduction};
use crate::simulation::Simulation;
use fspid_scenario::file::Study;

/// The report of a user's scenario.
#[must_use]
pub fn of_simulation(study: &Study, simulation: &Simulation) -> String {
    user::report(study, simulation)
}

/// The report of an audit of a fuzzy system.
#[must_use]
pub fn of_audit(audit: &Audit<'_>) -> String {
    audit::report(audit)
}

/// The report of a loop analysis.
///
/// # Errors
/// Eigenvalues that are not found.
pub fn of_analysis(study: &Study, analysis: &Analysis) -> Result<String, fspid_sim::SimError> {
    loops::report(study, analysis)
}

/// The report of the paper.
#[must_use]
pub fn of_reproduction(library: &Library, reproduction: &Reproduction) -> String {
    paper::report(&paper::Paper { library, reproduction })
}

/// Everything that lies beside the report: names below its folder, and texts.
#[must_use]
pub fn files_of_reproduction(
    library: &Library,
    reproduction: &Reproduction,
) -> Vec<(String, String)> {
    paper::files(&paper::Paper { library, reproduction })
}
