//! Holding our flights against the paper's numbers.

use super::claim::{CLAIMS, Claim, Printed, Quantity, Status, judge_change};
use super::figures::{FIGURES, Fit, FlownFigure};
use super::reading::{FigureFlight, claim, figure_of, number, readings};
use fspid_scenario::measure::Measure;
use fspid_study::metrics::Absent;

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
pub(super) fn judge(figures: &[FlownFigure]) -> Vec<JudgedClaim> {
    let own = flights(Fit::Own, figures);
    let shared = flights(Fit::Shared, figures);
    CLAIMS.iter().map(|claim| judge_claim(claim, &own, &shared)).collect()
}

/// The flights of all figures under one fit.
fn flights(fit: Fit, figures: &[FlownFigure]) -> Vec<FigureFlight<'_>> {
    let of_figure = |flown: &'_ FlownFigure| flown.fit == fit;
    figures
        .iter()
        .filter(|flown| of_figure(flown))
        .flat_map(|flown| {
            flown.simulation.results.iter().map(|result| FigureFlight {
                figure: flown.figure.id,
                controller: &result.name,
                metrics: &result.metrics,
            })
        })
        .collect()
}

fn judge_claim(
    claim: &Claim,
    own: &[FigureFlight<'_>],
    shared: &[FigureFlight<'_>],
) -> JudgedClaim {
    let (ours, status) = judge_under(claim, own);
    let (shared, shared_status) = judge_under(claim, shared);
    let figure = FIGURES.iter().find(|figure| figure.id == figure_of(claim));
    let note = match ours {
        Err(reason) => reason.to_string(),
        Ok(_) => {
            let parts = [note(claim, claim.source), unclaimed_overshoots(claim, own)];
            parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ")
        }
    };
    let assumptions = figure.map_or(&[][..], |figure| figure.assumptions);
    JudgedClaim { claim: *claim, ours, shared, status, shared_status, assumptions, note }
}

fn note(claim: &Claim, source: Quantity) -> String {
    let special = match claim.id {
        "F5.2" => "read at the end of the window (A15); the proportional loop sags further later",
        "F5.3" => "a slow tail, not a steady state: with ki > 0 the error goes to zero in the end",
        "F8b.2.5" => {
            "the paper's own 1.4 and 1.72 make 18.6 % of the later or 22.9 % of the first; with \
             less than 10 % overshoot on the first step down no fit was found that rounds to 18 as well"
        }
        "F9.1.3" => "the paper's own 1.38 and 0.84 make 39.1 %",
        id if id.starts_with("F9.2") => {
            "no fixed-gain loop found gives both the change of rise time and a constant overshoot; \
             this is the nearest that shares its nominal gains with the FSPID of the figure"
        }
        _ => "",
    };
    let reading = match source {
        Quantity::Later { .. } => {
            "third step of the command; judged with its change from the first"
        }
        Quantity::Percent { of_later: true, .. } => {
            "per cent of the later value, as the paper does"
        }
        Quantity::Percent { of_later: false, .. } => "per cent of the first value",
        Quantity::Value(_) => "",
    };
    [special, reading].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ")
}

/// Overshoots above this, in per cent, are named wherever the paper does not show them.
const NAMED_OVERSHOOT_PCT: f64 = 10.0;

/// What the flights of an overshoot claim do on the steps that the paper does not speak of.
fn unclaimed_overshoots(claim: &Claim, flights: &[FigureFlight<'_>]) -> String {
    let readings = readings(claim);
    let of_claim = |flight: &&FigureFlight<'_>| {
        readings.iter().any(|reading| {
            reading.measure == Measure::Overshoot
                && reading.figure == flight.figure
                && reading.controllers.contains(&flight.controller)
        })
    };
    let mut named = Vec::new();
    for flight in flights.iter().filter(of_claim) {
        for (edge, step) in flight.metrics.edges.iter().zip(1_usize..) {
            let overshoot = edge.step.overshoot_pct.unwrap_or(0.0);
            let claimed = readings.iter().any(|reading| reading.edge + 1 == step);
            if overshoot > NAMED_OVERSHOOT_PCT && !claimed {
                let way = if edge.to_rad < edge.from_rad { "down" } else { "up" };
                named.push(format!("step {step}, {way}: {overshoot:.1} %"));
            }
        }
    }
    if named.is_empty() {
        return String::new();
    }
    format!("overshoots that the paper does not show: {}", named.join(", "))
}

/// Number and status of a claim.
fn judge_under(claim: &Claim, flights: &[FigureFlight<'_>]) -> (Result<f64, Absent>, Status) {
    let ours = number(claim, flights);
    let Ok(value) = ours else {
        return (ours, Status::Undetermined);
    };
    let of_change = match claim.source {
        Quantity::Later { first, .. } => change_status(claim.paper, value, first, flights),
        Quantity::Value(_) | Quantity::Percent { .. } => Status::Reproduced,
    };
    (ours, claim.paper.judge(value).max(of_change))
}

fn change_status(paper: Printed, later: f64, first: &str, flights: &[FigureFlight<'_>]) -> Status {
    let Some(first) = claim(first) else {
        return Status::Undetermined;
    };
    match number(first, flights) {
        Ok(before) => judge_change((first.paper, paper), (before, later)),
        Err(_) => Status::Undetermined,
    }
}
