//! What failing and the main measures depend on.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item, Picture};
use fspid_plot::{IntervalColumn, IntervalFigure, IntervalMark, IntervalRow};
use fspid_scenario::measure::label;

use super::measures;
use super::words::{axis_label, cut, number, share};
use super::{Source, style};
use crate::summary::{AboveChance, ControllerSummary, Influence, Sensitivity, SensitivityTarget};

/// Most controllers in one figure.
const MOST_CONTROLLERS: usize = 6;
/// Most signs in one column of a figure: parameters times controllers.
const MOST_MARKS: usize = 48;
/// Most measures with a figure; the table has all.
const MOST_FIGURES: usize = 7;
/// Most rows of the table.
const MOST_TABLE: usize = 400;
/// Half the width of an interval of 95 % in standard errors of a normal estimate.
const STANDARD_ERRORS: f64 = 1.959_963_984_540_054;

/// What depends, with the sensitivities of the controllers that have one.
struct Target<'a> {
    name: String,
    title: String,
    of: Vec<(usize, &'a Sensitivity)>,
}

/// The chapter; none where nothing could be computed.
pub(super) fn chapter(source: &Source<'_>) -> Option<Chapter> {
    let targets: Vec<Target<'_>> = targets(source);
    if targets.is_empty() {
        let reason = "There are none: with so few runs, or with nothing that varies, no dependence can be told from chance.";
        let items = vec![Item::Text(reason.to_owned())];
        return Some(Chapter { items, ..named() });
    }
    let mut items = vec![Item::Text(
        "A share of the variance says how much of the spread would go if that parameter alone stood still; a rank correlation says which way it pulls, from \u{2212}1 (more of it, less of the measure) to 1. Shares that sum to less than 100 % leave the rest to parameters acting together and to noise. Bars are 95 % intervals, approximate, each alone: of many parameters that do nothing some stand out.".to_owned(),
    )];
    items.push(Item::List(above_chance(source)));
    let figures = targets.iter().take(MOST_FIGURES + 1).map(|target| picture(source, target));
    items.push(Item::Figures(figures.collect()));
    items.push(Item::Fold("All measures in numbers".to_owned(), vec![Item::Table(table(source))]));
    Some(Chapter { items, ..named() })
}

/// How many shares of each controller are more than chance, of all that are asked together.
fn above_chance(source: &Source<'_>) -> Vec<String> {
    let controllers = source.summary.controllers.iter().enumerate();
    let found = controllers.map(|(n, it)| (n, AboveChance::of(it))).filter(|(_, it)| it.asked > 0);
    found.map(|(n, it)| format!("{}: {}.", source.name(n), it.in_words())).collect()
}

fn named() -> Chapter {
    Chapter {
        id: "sensitivities".to_owned(),
        title: "What it depends on".to_owned(),
        items: Vec::new(),
    }
}

/// Failing first, then main measures.
fn targets<'a>(source: &Source<'a>) -> Vec<Target<'a>> {
    let mut found = vec![Target {
        name: "failing".to_owned(),
        title: "Failing".to_owned(),
        of: of(source, &SensitivityTarget::Failure),
    }];
    for measure in measures::all(source).into_iter().filter(|it| it.is_main) {
        found.push(Target {
            name: measure.name.to_owned(),
            title: measure.title,
            of: of(source, &SensitivityTarget::Measure(measure.name.to_owned())),
        });
    }
    found.retain(|target| !target.of.is_empty());
    found
}

fn of<'a>(source: &Source<'a>, wanted: &SensitivityTarget) -> Vec<(usize, &'a Sensitivity)> {
    let controllers = source.summary.controllers.iter().enumerate();
    let found = controllers
        .filter_map(|(n, it)| Some((n, it.sensitivities.iter().find(|it| it.of == *wanted)?)));
    let says = |it: &&Influence| it.share.is_some() || it.correlation.is_some();
    found.filter(|(_, it)| it.influences.iter().find(says).is_some()).collect()
}

fn picture(source: &Source<'_>, target: &Target<'_>) -> Picture {
    let shown = &target.of[..target.of.len().min(MOST_CONTROLLERS)];
    let mut names = strongest(shown);
    let most = (MOST_MARKS / shown.len().max(1)).max(4);
    let left = names.len().saturating_sub(most);
    names.truncate(most);
    let column =
        |label: &str, range| IntervalColumn { label: label.to_owned(), range, stems: true };
    let row = |name: &String| IntervalRow {
        name: cut(name, 80),
        words: String::new(),
        marks: shown.iter().flat_map(|(n, it)| marks(*n, it, name)).collect(),
    };
    let figure = IntervalFigure {
        title: format!("What it depends on: {}", target.title),
        columns: vec![
            column("share of the variance [%]", Some((0.0, 100.0))),
            column("rank correlation", Some((-1.0, 1.0))),
        ],
        rows: names.iter().map(row).collect(),
        series: shown.iter().map(|(n, _)| (source.name(*n), style(*n))).collect(),
        width_px: 600.0,
    };
    let mut caption =
        format!("{}: what each parameter does alone, the strongest first.", target.title);
    if left > 0 {
        caption.push_str(&format!(" {left} parameters that do less are in the table."));
    }
    if target.of.len() > shown.len() {
        caption.push_str(" Further controllers are in the table.");
    }
    Picture { name: format!("sensitivity-{}", target.name), svg: figure.render(), caption }
}

/// Names of parameters, those first that do most for any controller.
fn strongest(shown: &[(usize, &Sensitivity)]) -> Vec<String> {
    let Some((_, first)) = shown.first() else { return Vec::new() };
    let strength = |name: &str| {
        let all = shown.iter().flat_map(|(_, it)| &it.influences);
        let mine = all.filter(|it| it.parameter == name);
        mine.map(|it| {
            let share = it.share.map_or(0.0, |share| share.fraction);
            let rank = it.correlation.map_or(0.0, |rank| rank.coefficient);
            share.max(rank * rank)
        })
        .fold(0.0, f64::max)
    };
    let mut names: Vec<(f64, String)> =
        first.influences.iter().map(|it| (strength(&it.parameter), it.parameter.clone())).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0));
    names.into_iter().map(|(_, name)| name).collect()
}

fn marks(controller: usize, sensitivity: &Sensitivity, parameter: &str) -> Vec<IntervalMark> {
    let Some(it) = sensitivity.influences.iter().find(|it| it.parameter == parameter) else {
        return Vec::new();
    };
    let mark = |column, [value, lower, upper]: [f64; 3]| IntervalMark {
        column,
        style: style(controller),
        value,
        lower,
        upper,
    };
    let share = it.share.map(|share| {
        let half = STANDARD_ERRORS * share.standard_error;
        let ends = [share.fraction, share.fraction - half, share.fraction + half];
        mark(0, ends.map(|part| 100.0 * part.clamp(0.0, 1.0)))
    });
    let rank = it.correlation.map(|rank| {
        let [lower, upper] = rank.interval_95.unwrap_or([rank.coefficient; 2]);
        mark(1, [rank.coefficient, lower, upper])
    });
    share.into_iter().chain(rank).collect()
}

/// The three parameters that do most for each measure of each controller.
fn table(source: &Source<'_>) -> DataTable {
    let head = ["what", "controller", "flights", "first", "second", "third"];
    let mut rows = Vec::new();
    for (n, controller) in source.summary.controllers.iter().enumerate() {
        for it in &controller.sensitivities {
            let chosen = strongest(&[(n, it)]);
            let mut row = vec![
                Datum::Text(what(controller, &it.of)),
                Datum::Text(source.name(n)),
                Datum::Number(super::words::count(it.used)),
            ];
            let found = chosen.iter().filter_map(|name| {
                let it = it.influences.iter().find(|it| it.parameter == *name)?;
                (it.share.is_some() || it.correlation.is_some()).then(|| in_words(it))
            });
            row.extend(found.take(3).map(Datum::Text));
            while row.len() < head.len() {
                row.push(Datum::Absent("\u{2013}".to_owned()));
            }
            rows.push(row);
        }
    }
    rows.truncate(MOST_TABLE);
    DataTable {
        caption: "The three parameters that each measure depends on most: share of the variance with its standard error, and rank correlation. The first of a measure need not be more than chance.".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
        cards: true,
    }
}

fn what(controller: &ControllerSummary, target: &SensitivityTarget) -> String {
    match target {
        SensitivityTarget::Failure => "failing".to_owned(),
        SensitivityTarget::Measure(name) => {
            let measure = controller.measures.iter().find(|it| it.name == *name);
            let unit = measure.map_or("", |it| it.unit.as_str());
            cut(&axis_label(&label(name, unit), unit), 48)
        }
    }
}

fn in_words(it: &Influence) -> String {
    let part = it
        .share
        .map(|it| format!("{} \u{b1} {} %", share(it.fraction.max(0.0)), share(it.standard_error)));
    let rank = it.correlation.map(|rank| format!("rank {}", number(rank.coefficient)));
    let said: Vec<String> = part.into_iter().chain(rank).collect();
    format!("{}: {}", cut(&it.parameter, 60), said.join(", "))
}
