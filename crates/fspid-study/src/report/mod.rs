//! Reports: one HTML file each, without any outside reference or needed script.

use crate::file::Study;
use crate::reproduce::{Library, Reproduction};
use crate::simulation::Simulation;

/// The report of a user's scenario.
#[must_use]
pub fn of_simulation(_study: &Study, simulation: &Simulation) -> String {
    format!("<pre>{}</pre>", simulation.text())
}

/// The report of the paper.
#[must_use]
pub fn of_reproduction(_library: &Library, _reproduction: &Reproduction) -> String {
    String::new()
}

/// Everything that lies beside the report: names below its folder, and texts.
#[must_use]
pub fn files_of_reproduction(
    _library: &Library,
    reproduction: &Reproduction,
) -> Vec<(String, String)> {
    reproduction
        .figures
        .iter()
        .map(|flown| {
            let name = format!("traces/figure-{}-{}.csv", flown.figure.id, flown.fit.name());
            (name, flown.simulation.csv())
        })
        .collect()
}
