//! Reading the paper's quantities off our flights.

use super::claim::{CLAIMS, Claim, Quantity, Reading};
use fspid_study::metrics::{Absent, FlightMetrics};

/// One controller's flight in one figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct FigureFlight<'a> {
    /// Number of the figure.
    pub figure: &'a str,
    /// Name of the controller.
    pub controller: &'a str,
    /// Its measures.
    pub metrics: &'a FlightMetrics,
}

/// The claim with this id.
#[must_use]
pub(super) fn claim(id: &str) -> Option<&'static Claim> {
    CLAIMS.iter().find(|claim| claim.id == id)
}

/// Number of the figure that a claim is read off.
#[must_use]
pub(super) fn figure_of(claim: &Claim) -> &'static str {
    readings(claim).first().map_or("", |reading| reading.figure)
}

/// Everything that a claim is read off.
#[must_use]
pub(super) fn readings(of: &Claim) -> Vec<Reading> {
    match of.source {
        Quantity::Value(reading) | Quantity::Later { reading, .. } => vec![reading],
        Quantity::Percent { first, later, .. } => {
            [first, later].into_iter().filter_map(claim).flat_map(readings).collect()
        }
    }
}

/// Our number for a claim.
///
/// # Errors
/// The reason why a measure that it needs is absent.
pub(super) fn number(of: &Claim, flights: &[FigureFlight<'_>]) -> Result<f64, Absent> {
    match of.source {
        Quantity::Value(reading) | Quantity::Later { reading, .. } => read(reading, flights),
        Quantity::Percent { first, later, of_later } => {
            let named = |id| claim(id).map_or(Err(Absent::NoStep), |c| number(c, flights));
            let (first, later) = (named(first)?, named(later)?);
            Ok(100.0 * (later - first).abs() / if of_later { later } else { first })
        }
    }
}

/// The largest magnitude of a measure over the controllers of a reading.
fn read(reading: Reading, flights: &[FigureFlight<'_>]) -> Result<f64, Absent> {
    let mut worst = 0.0_f64;
    for name in reading.controllers {
        let flight = flights
            .iter()
            .find(|flight| flight.figure == reading.figure && flight.controller == *name)
            .ok_or(Absent::NoStep)?;
        let value = flight.metrics.of_step(reading.edge, |step| step.measured(reading.measure))?;
        worst = worst.max(value.abs());
    }
    Ok(worst)
}
