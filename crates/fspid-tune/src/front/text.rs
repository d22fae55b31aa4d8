//! The outcome for people.

use fspid_diagnostics::digits::counted;
use fspid_page::columns::{Align, Columns};
use fspid_page::number::{fixed, short, with_sign};

use super::joint::{CONFIDENCE, PLACES};
use super::{Band, FrontOutcome, Rung};
use crate::contest::{Quantity, nothing_allowed};
use crate::limit::NearLimit;

/// Every so many places along a front one is told.
const TOLD: usize = (PLACES - 1) / 4;

pub(super) fn text(outcome: &FrontOutcome) -> String {
    let mut out = format!("{}\n\n", headline(outcome));
    out.push_str(&format!(
        "Difference of the error from {} at equal elevator travel, from the least to the most travel that both have; all bands hold together at {:.0} %:\n",
        outcome.against(),
        100.0 * CONFIDENCE
    ));
    let places = (0..PLACES).step_by(TOLD);
    let heads: Vec<String> =
        places.clone().map(|place| format!("at {:.0} %", share(place))).collect();
    let mut columns = vec![("controller", Align::Left)];
    columns.extend(heads.iter().map(|head| (head.as_str(), Align::Right)));
    columns.extend([("cases", Align::Right), ("standing", Align::Left)]);
    let mut rows = Columns::new(&columns);
    for band in &outcome.bands {
        let mut row = vec![band.name.clone()];
        row.extend(places.clone().map(|place| difference(band, place)));
        row.push(format!("{} of {}", band.cases.compared, band.cases.of()));
        row.push(band.dominance.words().to_owned());
        rows.row(row);
    }
    out.push_str(&rows.to_string());
    outcome.bands.iter().for_each(|band| out.push_str(&format!("  {}\n", whole(band))));
    out.push_str(&format!("\n{}", ladder(outcome)));
    for sentence in nothing_allowed_at(outcome).into_iter().chain(beside_limits(outcome)) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out
}

/// Whose tunings found nothing that was allowed, at which efforts.
pub(super) fn nothing_allowed_at(outcome: &FrontOutcome) -> Vec<String> {
    let of_rung = |rung: &Rung| -> Vec<String> {
        let told = rung.outcome.judged.contestants.iter().filter_map(nothing_allowed);
        told.map(|told| format!("At {} deg {told}", rung.travel_deg)).collect()
    };
    outcome.rungs.iter().flat_map(of_rung).collect()
}

/// What is taken of commands where a limit is told.
pub(super) fn beside_limits(outcome: &FrontOutcome) -> Vec<String> {
    NearLimit::said_beside(outcome.rungs.iter().map(|rung| &rung.near))
}

/// What the whole front of a controller is, and what is left out of it.
pub(super) fn whole(band: &Band) -> String {
    let range = |[least, most]: [f64; 2]| format!("{} to {} deg", short(least, 3), short(most, 3));
    let mut told = match band.travel {
        None => format!("{}: no case is compared", band.name),
        Some(travel) => format!(
            "{}: the whole front is {} of travel in the mean of its cases, {} where it is narrowest",
            band.name,
            range(travel.mean_deg),
            range(travel.narrowest_deg)
        ),
    };
    let cases = |count: usize| format!("{} of {} cases", count, band.cases.of());
    if band.cases.lost > 0 {
        let [own, against] = band.flights;
        told.push_str(&format!(
            "; {} left out, for a flight of one of both is lost in each ({} of its {} flights, {} of {} of the one compared with)",
            cases(band.cases.lost),
            own.lost,
            own.of,
            against.lost,
            against.of
        ));
    }
    if band.cases.apart > 0 {
        told.push_str(&format!(
            "; {} left out, for they have no common range of travel, or the efforts change none",
            cases(band.cases.apart)
        ));
    }
    if band.cases.alike > 0 {
        told.push_str(&format!(
            "; {} more {} no evidence, for both fly {} to a millionth as others, or as the tuning's",
            counted(band.cases.alike, "case"),
            if band.cases.alike == 1 { "is" } else { "are" },
            if band.cases.alike == 1 { "it" } else { "them" },
        ));
    }
    told.push('.');
    told
}

/// How far along a front a place is, %.
pub(super) fn share(place: usize) -> f64 {
    100.0 * place as f64 / (PLACES - 1) as f64
}

/// A difference of logarithms as a change, %.
pub(super) fn change_pct(difference: f64) -> f64 {
    100.0 * libm::expm1(difference)
}

fn difference(band: &Band, place: usize) -> String {
    let Some(middle) = band.middle.get(place) else {
        return "\u{2013}".to_owned();
    };
    let percent = |value: f64| with_sign(change_pct(value), 0);
    match (band.ends[0].get(place), band.ends[1].get(place)) {
        (Some(lower), Some(upper)) => {
            format!("{} % ({} to {})", percent(*middle), percent(*lower), percent(*upper))
        }
        _ => format!("{} %", percent(*middle)),
    }
}

/// Who is better on the whole front.
pub(super) fn headline(outcome: &FrontOutcome) -> String {
    use super::Dominance::Dominates;
    let better = outcome.bands.iter().filter(|band| band.dominance == Dominates);
    let name = |band: &Band| match band.travel {
        None => band.name.clone(),
        Some(travel) => {
            let [least, most] = travel.mean_deg.map(|it| short(it, 3));
            format!("{} ({least} to {most} deg of travel)", band.name)
        }
    };
    let names: Vec<String> = better.map(name).collect();
    let rungs = counted(outcome.rungs.len(), "effort");
    match names.as_slice() {
        [] => format!("Nobody is better than {} on the whole front of {rungs}.", outcome.against()),
        names => format!(
            "Better than {} on the whole front of {rungs}: {}.",
            outcome.against(),
            names.join(", ")
        ),
    }
}

/// Mean error and travel of the designs of every rung, and the limit.
fn ladder(outcome: &FrontOutcome) -> String {
    let mut rows = Columns::new(&[
        ("allowed travel [deg]", Align::Right),
        ("controller", Align::Left),
        ("IAE [deg s]", Align::Right),
        ("travel [deg]", Align::Right),
        ("of what is possible [%]", Align::Right),
        ("lost", Align::Right),
        ("failed", Align::Right),
    ]);
    for rung in &outcome.rungs {
        let judged = &rung.outcome.judged;
        let kept = judged.kept(judged.contestants.iter(), &judged.all());
        let (means, count) = rung.near.means();
        for (place, it) in judged.contestants.iter().enumerate() {
            let mean = |quantity| {
                let designs = it.designs.iter().filter_map(|it| judged.mean(it, &kept, quantity));
                let values: Vec<f64> = designs.collect();
                values.iter().sum::<f64>() / values.len() as f64
            };
            let possible = means.get(place).copied().filter(|_| count > 0).unwrap_or(f64::NAN);
            let flights = || it.designs.iter().flat_map(|it| &it.flights);
            let failed = flights().filter(|flight| flight.failed).count();
            let lost = flights().filter(|flight| flight.lost).count();
            rows.row(vec![
                rung.travel_deg.to_string(),
                it.name.clone(),
                fixed(mean(Quantity::ERROR), 3),
                fixed(mean(Quantity::ACTIVITY), 2),
                fixed(100.0 * possible, 0),
                format!("{lost} of {}", flights().count()),
                format!("{failed} of {}", flights().count()),
            ]);
        }
    }
    format!(
        "{rows}  Means over the cases that nobody lost a flight of on the rung; of what is possible: the proved limit over the error of the best design, over the cases that have a limit.\n"
    )
}
