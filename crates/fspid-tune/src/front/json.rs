//! The outcome for programs.

use serde_json::{Value, json};

use super::joint::{CONFIDENCE, DRAWS};
use super::text::{change_pct, headline, share};
use super::{Band, FrontOutcome, Travel};

pub(super) fn json(outcome: &FrontOutcome) -> Value {
    let bands = outcome.bands.iter().map(of_band);
    let lines = outcome.lines().into_iter().map(|line| {
        let ends = |which: usize| line.band.iter().map(|(_, ends)| ends[which]).collect::<Vec<_>>();
        json!({
            "name": line.controller.as_deref().unwrap_or("limit, proved"),
            "is_limit": line.controller.is_none(),
            "travel_deg": line.points.iter().map(|it| it.0).collect::<Vec<_>>(),
            "iae_deg_s": line.points.iter().map(|it| it.1).collect::<Vec<_>>(),
            "band_travel_deg": line.band.iter().map(|it| it.0).collect::<Vec<_>>(),
            "band_lower_deg_s": ends(0),
            "band_upper_deg_s": ends(1),
        })
    });
    let rungs = outcome.rungs.iter().map(|rung| {
        json!({
            "travel_deg": rung.travel_deg,
            "contest": rung.outcome.json(),
            "limit": rung.near.json(),
        })
    });
    json!({
        "schema": 1,
        "headline": headline(outcome),
        "against": outcome.against(),
        "confidence": CONFIDENCE,
        "draws": DRAWS,
        "lines": lines.collect::<Vec<_>>(),
        "fronts": bands.collect::<Vec<_>>(),
        "rungs": rungs.collect::<Vec<_>>(),
        "command": outcome.command,
    })
}

fn of_band(band: &Band) -> Value {
    let change = |values: &[f64]| values.iter().map(|it| change_pct(*it)).collect::<Vec<_>>();
    let travel = |which: fn(&Travel) -> [f64; 2]| {
        band.travel.as_ref().map_or(Vec::new(), |it| which(it).to_vec())
    };
    let [own, against] = band.flights;
    json!({
        "name": band.name,
        "standing": band.dominance.words(),
        "cases": band.cases.compared,
        "cases_lost": band.cases.lost,
        "cases_apart": band.cases.apart,
        "cases_alike": band.cases.alike,
        "cases_of": band.cases.of(),
        "travel_deg": travel(|it| it.mean_deg),
        "narrowest_travel_deg": travel(|it| it.narrowest_deg),
        "along_pct": (0..band.middle.len()).map(share).collect::<Vec<_>>(),
        "change_pct": change(&band.middle),
        "lower_pct": change(&band.ends[0]),
        "upper_pct": change(&band.ends[1]),
        "failed": own.failed,
        "failed_of_against": against.failed,
        "lost": own.lost,
        "lost_of_against": against.lost,
        "undecided": own.undecided,
        "undecided_of_against": against.undecided,
        "unstable": own.unstable,
        "unstable_of_against": against.unstable,
    })
}
