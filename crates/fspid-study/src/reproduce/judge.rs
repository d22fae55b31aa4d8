//! Holding our flights against the paper's numbers.

use super::claim::{CLAIMS, Claim, Printed, Quantity, Reading, Status, judge_change};
use super::figures::{FIGURES, Fit, FlownFigure};
use crate::metrics::Absent;

/// A number of the paper and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedClaim {
    /// The claim.
    pub claim: Claim,
    /// Our number under the figure's own fit, or why there is none.
    pub ours: Result<f64, Absent>,
    /// Our number under the shared supervisor, or why there is none.
    pub shared: Result<f64, Absent>,
    /// How our own fit stands.
    pub status: Status,
    /// How the shared supervisor stands.
    pub shared_status: Status,
    /// Assumptions it rests on.
    pub assumptions: &'static [&'static str],
    /// What has to be known to read the line rightly.
    pub note: String,
}

/// Judges every number against the flights.
#[must_use]
pub fn judge(figures: &[FlownFigure]) -> Vec<JudgedClaim> {
    CLAIMS.iter().map(|claim| judge_claim(claim, figures)).collect()
}

fn judge_claim(claim: &Claim, figures: &[FlownFigure]) -> JudgedClaim {
    let (ours, status) = judge_under(Fit::Own, claim, figures);
    let (shared, shared_status) = judge_under(Fit::Shared, claim, figures);
    let figure = FIGURES.iter().find(|figure| figure.id == figure_of(claim));
    let note = match (&ours, claim.source) {
        (Err(reason), _) => reason.to_string(),
        (Ok(_), source) => note(claim, source),
    };
    JudgedClaim {
        claim: *claim,
        ours,
        shared,
        status,
        shared_status,
        assumptions: figure.map_or(&[], |figure| figure.assumptions),
        note,
    }
}

fn note(claim: &Claim, source: Quantity) -> String {
    let special = match claim.id {
        "F5.2" => "read at the end of the window (A15); the proportional loop sags further later",
        "F5.3" => "a slow tail, not a steady state: with ki > 0 the error goes to zero in the end",
        "F8b.2.5" => "the paper's own 1.4 and 1.72 make 18.6 % of the later or 22.9 % of the first",
        "F9.1.3" => "the paper's own 1.38 and 0.84 make 39.1 %",
        id if id.starts_with("F9.2") => {
            "no fixed-gain loop found gives both the change of rise time and a constant overshoot; \
             this is the nearest that shares its nominal gains with the FSPID of the figure"
        }
        _ => "",
    };
    let reading = match source {
        Quantity::Later { .. } => "third step of the command; judged with its change from the first",
        Quantity::Percent { of_later: true, .. } => "per cent of the later value, as the paper does",
        Quantity::Percent { of_later: false, .. } => "per cent of the first value",
        Quantity::Value(_) => "",
    };
    [special, reading].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ")
}

/// Number and status of a claim under one fit.
fn judge_under(fit: Fit, claim: &Claim, figures: &[FlownFigure]) -> (Result<f64, Absent>, Status) {
    let ours = number(fit, claim, figures);
    let Ok(value) = ours else { return (ours, Status::Undetermined) };
    let of_number = claim.paper.judge(value);
    let of_change = match claim.source {
        Quantity::Later { first, .. } => change_status(fit, claim.paper, value, first, figures),
        Quantity::Value(_) | Quantity::Percent { .. } => Status::Reproduced,
    };
    (ours, of_number.max(of_change))
}

fn change_status(
    fit: Fit,
    paper: Printed,
    later: f64,
    first: &str,
    figures: &[FlownFigure],
) -> Status {
    let Some(first) = claim(first) else { return Status::Undetermined };
    match number(fit, first, figures) {
        Ok(before) => judge_change((first.paper, paper), (before, later)),
        Err(_) => Status::Undetermined,
    }
}

fn claim(id: &str) -> Option<&'static Claim> {
    CLAIMS.iter().find(|claim| claim.id == id)
}

/// Our number for a claim under one fit.
///
/// # Errors
/// The reason why a measure it needs is absent.
fn number(fit: Fit, of: &Claim, figures: &[FlownFigure]) -> Result<f64, Absent> {
    let named = |id: &str| claim(id).map_or(Err(Absent::NoStep), |c| number(fit, c, figures));
    match of.source {
        Quantity::Value(reading) | Quantity::Later { reading, .. } => read(fit, reading, figures),
        Quantity::Percent { first, later, of_later } => {
            let (first, later) = (named(first)?, named(later)?);
            Ok(100.0 * (later - first).abs() / if of_later { later } else { first })
        }
    }
}

/// The largest magnitude of a measure over the controllers of a reading.
fn read(fit: Fit, reading: Reading, figures: &[FlownFigure]) -> Result<f64, Absent> {
    let flown = figures
        .iter()
        .find(|flown| flown.fit == fit && flown.figure.id == reading.figure)
        .ok_or(Absent::NoStep)?;
    let mut worst = 0.0_f64;
    for name in reading.controllers {
        let result = flown.simulation.result(name).ok_or(Absent::NoStep)?;
        let value = result.metrics.of_step(reading.edge, |step| reading.measure.of(step))?;
        worst = worst.max(value.abs());
    }
    Ok(worst)
}

fn figure_of(claim: &Claim) -> &'static str {
    match claim.source {
        Quantity::Value(reading) | Quantity::Later { reading, .. } => reading.figure,
        Quantity::Percent { first, .. } => self::claim(first).map_or("", figure_of),
    }
}
