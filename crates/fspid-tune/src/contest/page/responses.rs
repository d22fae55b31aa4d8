//! One or two cases flown again, everyone's best design in one figure.

use std::ops::ControlFlow;

use fspid_page::analysis::{Chapter, Item, Picture};
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle};
use fspid_scenario::units::degrees;
use fspid_sim::Perturbation;

use super::{chapter as chapter_of, style};
use crate::contest::judged::{Contestant, Judged, Quantity};
use crate::contest::words::{cut, list};
use crate::contest::{Contest, Outcome};

/// Cases that are drawn.
const MOST_CASES: usize = 2;
/// Instants that curves have at most; more than pixels nobody sees.
const MOST_INSTANTS: usize = 700;
/// A panel shows at most this many times the range of the set-point and of flights that came back.
const HEADROOM: f64 = 1.5;

/// Curves of one flight.
#[derive(Default)]
struct Curves {
    time_s: Vec<f64>,
    setpoint_deg: Vec<f64>,
    pitch_deg: Vec<f64>,
    elevator_deg: Vec<f64>,
}

pub(super) fn chapter(contest: &Contest, outcome: &Outcome) -> Chapter {
    let designs = match outcome.judged.is_tuned() {
        true => "Of each controller the design that costs least on the training cases. ",
        false => "",
    };
    let mut items = vec![Item::Text(format!(
        "{designs}The first figure is the case in which the controllers differ most, the second the one in which they differ as they mostly do."
    ))];
    for case in chosen(outcome) {
        items.extend(figure(contest, outcome, case));
    }
    chapter_of("responses", "Responses", items)
}

/// The case in which errors differ most, and the one in the middle.
fn chosen(outcome: &Outcome) -> Vec<usize> {
    let width = |case: usize| {
        let medians =
            outcome.summaries.iter().filter_map(|it| it.cases[case].spread(Quantity::ERROR));
        let medians: Vec<f64> = medians.map(|it| it.median).collect();
        let most = medians.iter().copied().fold(0.0, f64::max);
        let least = medians.iter().copied().fold(f64::INFINITY, f64::min);
        let ratio = most / least;
        if ratio.is_nan() { 0.0 } else { ratio }
    };
    let mut order = outcome.judged.all();
    order.sort_by(|&a, &b| width(b).total_cmp(&width(a)).then(a.cmp(&b)));
    let picks = [0, order.len() / 2];
    let mut cases: Vec<usize> = picks.iter().filter_map(|it| order.get(*it).copied()).collect();
    cases.dedup();
    cases.truncate(MOST_CASES);
    cases
}

fn figure(contest: &Contest, outcome: &Outcome, case: usize) -> Option<Item> {
    let judged = &outcome.judged;
    let ranking = outcome.first().ranking;
    let (drawn, left) = ranking.split_at(ranking.len().min(SeriesStyle::COUNT));
    let flown = drawn.iter().map(|&place| {
        let it = &judged.contestants[place];
        let curves = flown(contest, place, Judged::best(it), outcome, case);
        (place, cut(&it.name, 60), curves.unwrap_or_default())
    });
    let flown: Vec<(usize, String, Curves)> = flown.collect();
    let longest = flown.iter().map(|(_, _, it)| it).max_by_key(|it| it.time_s.len())?;
    let setpoint = Series {
        name: "set-point".to_owned(),
        style: SeriesStyle::Setpoint,
        x: longest.time_s.clone(),
        y: longest.setpoint_deg.clone(),
        stairs: true,
    };
    let whole = longest.time_s.len();
    let panel = |y_label: &str, pick: fn(&Curves) -> &Vec<f64>, first: Option<Series>| {
        let curve = |(place, name, curves): &(usize, String, Curves)| Series {
            name: name.clone(),
            style: style(outcome, *place),
            x: curves.time_s.clone(),
            y: pick(curves).clone(),
            stairs: false,
        };
        let back = flown.iter().filter(|(_, _, it)| it.time_s.len() == whole);
        let values = back.flat_map(|(_, _, it)| pick(it)).chain(first.iter().flat_map(|it| &it.y));
        let is_cut = flown.iter().any(|(_, _, it)| it.time_s.len() < whole);
        LinePanel {
            y_label: y_label.to_owned(),
            x_label: "time [s]".to_owned(),
            y_range: is_cut.then(|| widened(values)).flatten(),
            series: first.iter().cloned().chain(flown.iter().map(curve)).collect(),
            ..LinePanel::default()
        }
    };
    let name = cut(&judged.cases.get(case)?.name, 80);
    let figure = LineFigure {
        title: name.clone(),
        panels: vec![
            panel("pitch [deg]", |it| &it.pitch_deg, Some(setpoint)),
            panel("elevator [deg]", |it| &it.elevator_deg, None),
        ],
        width_px: 760.0,
    };
    let draw = if judged.cases.get(case)?.runs > 1 { ", its first draw" } else { "" };
    let lost: Vec<String> =
        judged.contestants.iter().filter_map(|it| lost(judged, it, case)).collect();
    let lost = if lost.is_empty() { String::new() } else { format!(" Lost: {}.", list(&lost)) };
    let left: Vec<String> =
        left.iter().map(|place| cut(&judged.contestants[*place].name, 60)).collect();
    let left =
        if left.is_empty() { String::new() } else { format!(" Not drawn: {}.", list(&left)) };
    let caption = format!("Case \"{name}\"{draw}.{lost}{left}");
    Some(Item::Figure(Picture { name: format!("response-{case}"), svg: figure.render(), caption }))
}

/// The name of a controller whose flight is lost, with the verdict.
fn lost(judged: &Judged, contestant: &Contestant, case: usize) -> Option<String> {
    let design = contestant.designs.get(Judged::best(contestant))?;
    let flight = judged.flights(design, case).first().filter(|it| it.lost)?;
    Some(format!("{} ({})", cut(&contestant.name, 60), flight.verdict))
}

/// Ends of an ordinate that lost flights cannot stretch.
fn widened<'a>(values: impl Iterator<Item = &'a f64>) -> Option<(f64, f64)> {
    let ends = values.filter(|it| it.is_finite()).fold(None, |ends: Option<(f64, f64)>, it| {
        Some(ends.map_or((*it, *it), |(lo, hi)| (lo.min(*it), hi.max(*it))))
    });
    let (lo, hi) = ends?;
    let pad = (HEADROOM - 1.0) / 2.0 * (hi - lo);
    (pad > 0.0).then_some((lo - pad, hi + pad))
}

/// The first flight of a design on a case, again; `None` where it cannot be flown.
fn flown(
    contest: &Contest,
    place: usize,
    design: usize,
    outcome: &Outcome,
    case: usize,
) -> Option<Curves> {
    let flights = &contest.entrants.get(place)?.flights;
    let design = outcome.judged.contestants.get(place)?.designs.get(design)?;
    let point = design.found.as_ref().map_or(&[][..], |it| it.point.as_slice());
    let study = flights.study(point, flights.cases().get(case)?, 0).ok()?;
    let prepared = study.scenario.prepare().ok()?;
    let flyer = study.scenario.flyers().next()?;
    let timing = study.scenario.timing;
    let every = timing.rows().div_ceil(MOST_INSTANTS).max(1);
    let mut curves = Curves::default();
    flyer
        .respondent()
        .fly(&prepared, &Perturbation::NONE, |instant| {
            if instant.k.is_multiple_of(every) {
                curves.time_s.push(timing.time_s(instant.k));
                curves.setpoint_deg.push(degrees(instant.setpoint_rad));
                curves.pitch_deg.push(degrees(instant.theta_rad));
                curves.elevator_deg.push(degrees(instant.elevator_rad));
            }
            ControlFlow::Continue(())
        })
        .ok()?;
    Some(curves)
}
