//! The page of a front: error over travel, and differences along it with their bands.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item, Picture, Standing, Verdict};
use fspid_page::campaign::CampaignPage;
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle, Svg, TradeFigure, TradeSeries};

use super::band::{CONFIDENCE, DRAWS, PLACES};
use super::text::{change_pct, headline, share};
use super::{Dominance, FrontOutcome, Rung};
use crate::contest::{Judged, Quantity};

pub(super) fn page(outcome: &FrontOutcome) -> String {
    let name = match outcome.rungs.first().map(|rung| rung.outcome.setting.scenario.trim()) {
        None | Some("") => "Scenario without a name".to_owned(),
        Some(name) => name.to_owned(),
    };
    let is_decided = outcome.bands.iter().any(|band| band.dominance == Dominance::Dominates);
    let word = if is_decided { "Decided" } else { "Not decided" };
    CampaignPage {
        title: format!("{name}: front"),
        heading: format!("{name}: who wins along the front"),
        lead: "Every controller tuned alike at a ladder of efforts, and compared at equal travel all along it.".to_owned(),
        commands: outcome.command.clone(),
        verdicts: vec![Verdict {
            standing: if is_decided { Standing::Good } else { Standing::Fair },
            word: word.to_owned(),
            name: format!("compared with {}", outcome.against()),
            detail: headline(outcome),
        }],
        answer: answer(outcome),
        notes: notes(),
        chapters: vec![Chapter {
            id: "rungs".to_owned(),
            title: "The contests of the rungs".to_owned(),
            items: vec![Item::List(
                outcome
                    .rungs
                    .iter()
                    .map(|rung| {
                        let deg = rung.travel_deg;
                        format!("{deg} deg: travel-{deg}-deg/contest.html beside this page")
                    })
                    .collect(),
            )],
        }],
        ..CampaignPage::default()
    }
    .render()
}

fn answer(outcome: &FrontOutcome) -> Vec<Item> {
    let over = "Error over travel. A line goes through the means of a controller's best designs, one at each effort, over the cases that have a limit and of which nobody lost a flight on any rung; the lowest line is the limit at the travel of the controller that the others are compared with. At its corners nobody gets below it.";
    let along = format!(
        "Change of the error from {} at equal travel, %, from the least to the most travel that both have in a case. All bands hold together and everywhere at once, at {:.0} %: below 0 everywhere is better on the whole front.",
        outcome.against(),
        100.0 * CONFIDENCE
    );
    let picture = |name: &str, svg, caption: String| {
        Item::Figure(Picture { name: name.to_owned(), svg, caption })
    };
    let mut items = Vec::new();
    match error_over_travel(outcome) {
        Some(svg) => items.push(picture("front", svg, over.to_owned())),
        None => items.push(Item::Warning("No case has a limit and a flight of everybody on every rung, so that there is no common curve to draw.".to_owned())),
    }
    if !outcome.bands.iter().all(|band| band.ends[0].is_empty()) {
        items.push(picture("along", differences(outcome), along));
    }
    items.push(Item::Table(standings(outcome)));
    items
}

fn notes() -> Vec<String> {
    vec![
        format!("Bands: cases and seeds drawn anew with replacement, each on its own, {DRAWS} times (pigeonhole bootstrap); the mean ± a quantile of the largest standardised deviation along the front, with Bonferroni's correction for the number of controllers."),
        "Assumed: cases and seeds are like draws of those that matter, and between two efforts error over travel is near a straight line in logarithms. With one seed, or fewer than six cases with a common range of travel, nothing is claimed.".to_owned(),
    ]
}

/// Cases with a limit of which nobody lost a flight on any rung.
fn common(outcome: &FrontOutcome) -> Vec<usize> {
    let Some(first) = outcome.rungs.first() else {
        return Vec::new();
    };
    let kept = |rung: &Rung, case: usize| {
        let judged = &rung.outcome.judged;
        let all = rung.near.controllers.iter();
        let has_limit =
            all.clone().all(|(_, shares)| shares.get(case).copied().flatten().is_some());
        has_limit && !judged.kept(judged.contestants.iter(), &[case]).is_empty()
    };
    let cases = first.outcome.judged.all();
    cases.into_iter().filter(|case| outcome.rungs.iter().all(|rung| kept(rung, *case))).collect()
}

fn error_over_travel(outcome: &FrontOutcome) -> Option<Svg> {
    let cases = common(outcome);
    let first = &outcome.rungs.first()?.outcome.judged;
    if cases.is_empty() {
        return None;
    }
    let point = |rung: &Rung, place: usize| {
        let judged = &rung.outcome.judged;
        let contestant = judged.contestants.get(place)?;
        let design = contestant.designs.get(Judged::best(contestant))?;
        let x = judged.mean(design, &cases, Quantity::ACTIVITY)?;
        Some((x, judged.mean(design, &cases, Quantity::ERROR)?))
    };
    let mut series: Vec<TradeSeries> = first
        .contestants
        .iter()
        .enumerate()
        .map(|(place, it)| TradeSeries {
            name: it.name.clone(),
            style: SeriesStyle::Numbered(place),
            points: outcome.rungs.iter().filter_map(|rung| point(rung, place)).collect(),
            is_joined: it.is_tuned,
        })
        .collect();
    let limit = |rung: &Rung| {
        let (x, _) = point(rung, first.against)?;
        Some((x, limit_of(rung, &cases)?))
    };
    series.push(TradeSeries {
        name: "limit, proved".to_owned(),
        style: SeriesStyle::Numbered(series.len()),
        points: outcome.rungs.iter().filter_map(limit).collect(),
        is_joined: true,
    });
    let figure = TradeFigure {
        title: "Error over travel".to_owned(),
        x_label: "mean elevator travel [deg]".to_owned(),
        y_label: "mean IAE [deg s]".to_owned(),
        series,
    };
    Some(figure.render())
}

/// The mean proved limit of some cases at the travel of the controller compared with, deg s.
fn limit_of(rung: &Rung, cases: &[usize]) -> Option<f64> {
    let judged = &rung.outcome.judged;
    let contestant = judged.contestants.get(judged.against)?;
    let design = contestant.designs.get(Judged::best(contestant))?;
    let (_, shares) = rung.near.controllers.get(judged.against)?;
    let (mut sum, mut weights) = (0.0, 0.0);
    for &case in cases {
        let weight = judged.cases.get(case)?.weight;
        let error = judged.mean(design, &[case], Quantity::ERROR)?;
        sum += weight * error * shares.get(case).copied().flatten()?;
        weights += weight;
    }
    Some(sum / weights)
}

fn differences(outcome: &FrontOutcome) -> Svg {
    let panels = outcome.bands.iter().filter(|band| !band.ends[0].is_empty()).map(|band| {
        let line = |name: String, style, values: &[f64]| Series {
            name,
            style,
            x: (0..PLACES).map(share).collect(),
            y: values.iter().map(|it| change_pct(*it)).collect(),
            stairs: false,
        };
        let [lower, upper] = &band.ends;
        let ends = SeriesStyle::Numbered(1);
        LinePanel {
            y_label: format!("change of IAE [%], {}", band.name),
            x_label: "along the common range of travel [%]".to_owned(),
            series: vec![
                line("no change".to_owned(), SeriesStyle::Setpoint, &[0.0; PLACES]),
                line("mean".to_owned(), SeriesStyle::Numbered(0), &band.middle),
                line(format!("{:.0} %, everywhere at once", 100.0 * CONFIDENCE), ends, lower),
                line(String::new(), ends, upper),
            ],
            ..LinePanel::default()
        }
    });
    LineFigure {
        title: format!("Change of the error from {}", outcome.against()),
        panels: panels.collect(),
        width_px: 760.0,
    }
    .render()
}

fn standings(outcome: &FrontOutcome) -> DataTable {
    let head = ["controller", "standing", "cases", "flights that fail", "of the one compared with"];
    let row = |band: &super::Band| {
        vec![
            Datum::Text(band.name.clone()),
            Datum::Text(band.dominance.words().to_owned()),
            Datum::Number(format!("{} of {}", band.cases.0, band.cases.1)),
            Datum::Number(band.failed[0].to_string()),
            Datum::Number(band.failed[1].to_string()),
        ]
    };
    DataTable {
        caption: format!("Fronts beside that of {}", outcome.against()),
        head: head.map(str::to_owned).to_vec(),
        rows: outcome.bands.iter().map(row).collect(),
        cards: true,
    }
}
