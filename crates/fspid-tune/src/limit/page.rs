//! The answer as a page: error over travel, the limit and who flies.

use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Picture, Provenance, Standing as Colour, Verdict,
};
use fspid_page::number::fixed;
use fspid_plot::{SeriesStyle, Svg, TradeFigure, TradeSeries};
use fspid_scenario::units::degrees;

use super::text::{flown, limits, possible, without_future};
use super::words::{beside, called, causal_is_told, in_unit, lead, unit};
use super::{Answer, Rung};

pub(super) fn page(answer: &Answer, command: &str) -> String {
    let verdict = |it: &super::Standing| {
        let [value, way] = flown(answer, it);
        let measure = answer.options.measure;
        match &it.flown {
            Ok(_) => Verdict {
                standing: Colour::Fair,
                word: possible(it),
                name: it.name.clone(),
                detail: format!(
                    "of what is possible: {} of {value} {} at {way} deg of travel.",
                    called(measure),
                    unit(measure)
                ),
            },
            Err(why) => Verdict {
                standing: Colour::Bad,
                word: "not compared".to_owned(),
                name: it.name.clone(),
                detail: format!("{why}."),
            },
        }
    };
    AnalysisPage {
        title: answer.lead_name(),
        heading: answer.lead_name(),
        lead: lead(answer),
        verdicts: answer.controllers.iter().map(verdict).collect(),
        beside: beside(answer),
        chapters: vec![Chapter {
            id: "limit".to_owned(),
            title: "Error over travel".to_owned(),
            items: items(answer),
        }],
        provenance: Provenance {
            command: command.to_owned(),
            digest: answer.digest.clone(),
            further: Vec::new(),
        },
        ..AnalysisPage::default()
    }
    .render()
}

/// Figure and table.
fn items(answer: &Answer) -> Vec<Item> {
    let caption = "Error over travel. At its corners the line is proved: nobody gets below it; between them the limit is a little below the line, which sags. Every controller is a sign; its distance from the line, upwards, is what is left to win at its travel.";
    let figure =
        Picture { name: "limit".to_owned(), svg: figure(answer), caption: caption.to_owned() };
    vec![Item::Figure(figure), Item::Table(table(answer))]
}

/// The chapter of a report whose controllers have flown: how much of what is possible each reaches.
pub(super) fn beside_flights(answer: &Answer) -> Chapter {
    let mut all = vec![Item::Text(lead(answer)), Item::Table(shares(answer))];
    let lost = answer.controllers.iter().filter_map(|it| {
        Some(format!("{}: {}; nothing to compare.", it.name, it.flown.as_ref().err()?))
    });
    all.extend(lost.map(Item::Text));
    all.extend(items(answer).into_iter().take(1));
    all.push(Item::List(beside(answer)));
    Chapter { id: "limit".to_owned(), title: "What is possible".to_owned(), items: all }
}

/// The controllers at their travels.
fn shares(answer: &Answer) -> DataTable {
    let (name, unit) = (called(answer.options.measure), unit(answer.options.measure));
    let row = |it: &super::Standing| {
        let [value, way] = flown(answer, it);
        let limit =
            it.rung.as_ref().map_or("\u{2013}".to_owned(), |it| limits(answer, it)[0].clone());
        let numbers = [value, way, limit, possible(it)].map(Datum::Number);
        [vec![Datum::Text(it.name.clone())], numbers.to_vec()].concat()
    };
    DataTable {
        caption: "How much of what is possible at its own travel each controller reaches"
            .to_owned(),
        head: vec![
            "controller".to_owned(),
            format!("{name} [{unit}]"),
            "travel [deg]".to_owned(),
            format!("limit there [{unit}]"),
            "of what is possible".to_owned(),
        ],
        rows: answer.controllers.iter().map(row).collect(),
        cards: true,
    }
}

/// Rungs of the ladder and of the controllers, by travel.
fn all(answer: &Answer) -> Vec<&Rung> {
    let own = answer.controllers.iter().filter_map(|it| it.rung.as_ref());
    let mut all: Vec<&Rung> = answer.rungs.iter().chain(own).collect();
    all.sort_by(|one, other| one.travel_rad.total_cmp(&other.travel_rad));
    all
}

fn figure(answer: &Answer) -> Svg {
    let measure = answer.options.measure;
    let curve = |of: &dyn Fn(&Rung) -> Option<f64>| {
        let point = |rung: &&Rung| Some((degrees(rung.travel_rad), in_unit(measure, of(rung)?)));
        all(answer).iter().filter_map(point).collect::<Vec<(f64, f64)>>()
    };
    let line = |name: &str, style, points| TradeSeries {
        name: name.to_owned(),
        style,
        points,
        is_joined: true,
        band: Vec::new(),
    };
    let controllers = answer.controllers.iter().enumerate().map(|(place, it)| TradeSeries {
        name: it.name.clone(),
        style: SeriesStyle::Numbered(place),
        points: it.flown.iter().map(|(v, way)| (degrees(*way), in_unit(measure, *v))).collect(),
        is_joined: false,
        band: Vec::new(),
    });
    let mut series: Vec<TradeSeries> = controllers.collect();
    let next = series.len();
    if causal_is_told(answer) {
        let points = curve(&|rung| rung.causal.as_ref().map(|it| it.reached.measure));
        series.push(line("reached without the future", SeriesStyle::Numbered(next + 1), points));
    }
    let points = curve(&|rung| rung.limit.as_ref().ok().map(|it| it.proved));
    series.push(line("limit, proved", SeriesStyle::Numbered(next), points));
    TradeFigure {
        title: answer.lead_name(),
        x_label: format!("{} [deg]", answer.options.travel.words()),
        y_label: format!("{} [{}]", called(measure), unit(measure)),
        series,
    }
    .render()
}

fn table(answer: &Answer) -> DataTable {
    let measure = answer.options.measure;
    let unit = unit(measure);
    let causal = causal_is_told(answer);
    let mut head = vec![
        format!("{} [deg]", answer.options.travel.words()),
        format!("{} proved, at least [{unit}]", called(measure)),
        format!("reached [{unit}]"),
    ];
    head.extend(causal.then(|| format!("without the future [{unit}]")));
    let row = |rung: &&Rung| {
        let [proved, reached] = limits(answer, rung);
        let mut row = vec![fixed(degrees(rung.travel_rad), 2), proved, reached];
        row.extend(causal.then(|| without_future(answer, rung)));
        row.into_iter().map(Datum::Number).collect()
    };
    DataTable {
        caption: "The limit by travel, at the travel of every controller as well".to_owned(),
        head,
        rows: all(answer).iter().map(row).collect(),
        cards: false,
    }
}
