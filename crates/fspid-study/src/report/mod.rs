//! Reports: one HTML file each, without any outside reference or needed script.
//!
//! Sentences stand in the templates, numbers are computed here; nothing in a template knows a value
//! of its own. What a user has named is escaped wherever it appears, in figures too.
//!
//! Not here: what is measured and judged (`metrics`), and how a line is drawn (`figure`).

mod around;
mod audit;
mod flight_path;
mod loops;
pub mod measures;
pub mod settings;
pub mod supervisor;
mod templates;
pub mod traces;
mod user;

use crate::analysis::Analysis;
use crate::fuzzy_system::Audit;
use crate::shell;
use crate::simulation::Simulation;
use fspid_page::page::PageSection;
use fspid_scenario::file::Study;

/// The report of a user's scenario.
#[must_use]
pub fn of_simulation(study: &Study, simulation: &Simulation) -> String {
    of_simulation_with(study, simulation, None)
}

/// The same with a section of somebody who knows more, behind the measures.
#[must_use]
pub fn of_simulation_with(
    study: &Study,
    simulation: &Simulation,
    further: Option<PageSection>,
) -> String {
    user::report(study, simulation, further)
}

/// The figure of the time responses in that report.
#[must_use]
pub fn responses_of(study: &Study, simulation: &Simulation) -> fspid_plot::Svg {
    user::drawing(study, simulation).render()
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

/// The command that writes a report of this study again, with everything that was set from outside of its file.
#[must_use]
pub fn command(name: &str, study: &Study, options: &str) -> String {
    let set = |change: &String| format!(" --set {}", shell::word(change));
    let sets: String = study.overrides.iter().map(set).collect();
    format!("fspid {name} FILE{options}{sets} --report OUT.html")
}
