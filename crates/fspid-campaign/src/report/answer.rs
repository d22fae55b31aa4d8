//! The answer first: how often flights fail, and which requirements are not met.

use fspid_page::analysis::{DataTable, Datum, Item, Standing, Verdict};
use fspid_plot::{IntervalColumn, IntervalFigure, IntervalMark, IntervalRow};
use fspid_study::simulation::FAILS_BY_ITSELF;

use super::words::{count, cut, percent, probability, with_unit};
use super::{Source, picture, style};
use crate::summary::{ControllerSummary, Probability, RequirementSummary};

/// Most requirements in the figure; the table has all.
const MOST_ROWS: usize = 24;

/// One box a controller.
pub(super) fn verdicts(source: &Source<'_>) -> Vec<Verdict> {
    let controllers = source.summary.controllers.iter().enumerate();
    controllers.map(|(n, controller)| verdict(source, n, controller)).collect()
}

fn verdict(source: &Source<'_>, place: usize, controller: &ControllerSummary) -> Verdict {
    let failed = &controller.failed;
    let word = match (failed.count, failed.of) {
        (0, 1) => "The only flight did not fail".to_owned(),
        (0, of) => format!("None of {} flights failed", count(of)),
        (all, of) if all == of && of == 1 => "The only flight failed".to_owned(),
        (all, of) if all == of => format!("All {} flights failed", count(of)),
        (some, of) => format!("{} of {} flights failed", count(some), count(of)),
    };
    let (judged, word) = match controller.is_judged() {
        true => ("", word),
        false => {
            ("Nothing is required of it. ", format!("Nothing required: {}", lower_first(&word)))
        }
    };
    let standing = match (failed.count, failed.at_most) {
        // Nothing was judged that could be called good.
        (0, _) if !controller.is_judged() => Standing::Fair,
        // Nobody can tell whether these are stable.
        (0, _) if controller.undecided > 0 => Standing::Fair,
        // None failed of so few flights that half of all may: nothing to call good yet.
        (0, Some(bound)) if bound >= 0.5 => Standing::Fair,
        (0, _) => Standing::Good,
        _ => Standing::Bad,
    };
    let verdicts: Vec<String> = controller
        .verdicts
        .iter()
        .map(|it| format!("{} {}", cut(&it.verdict, 40), count(it.flights)))
        .collect();
    let undecided = match controller.undecided {
        0 => String::new(),
        flights => format!(" Stability at rest is undecided of {}.", count(flights)),
    };
    let sure = probability(failed, source.summary.head.confidence);
    let detail = format!(
        "{judged}Probability that a flight fails: {sure}. Verdicts on the flights: {}.{undecided}",
        verdicts.join(", ")
    );
    Verdict { standing, word, name: source.name(place), detail }
}

/// A sentence that goes on in another.
fn lower_first(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

/// Figures and the table of requirements.
pub(super) fn items(source: &Source<'_>) -> Vec<Item> {
    let summary = source.summary;
    let mut items = vec![picture(
        "failing",
        failing(source),
        format!(
            "Probability that a flight fails: estimates with their exact {} intervals (Clopper and Pearson); where none failed, up to the one-sided bound. A flight fails that {FAILS_BY_ITSELF}; one that does not meet a requirement, and one whose numbers make no scenario; where nothing is required of its controller, also one that does not settle.",
            percent(summary.head.confidence)
        ),
    )];
    if summary.controllers.iter().any(|it| !it.requirements.is_empty()) {
        items.push(Item::Heading("Requirements".to_owned()));
        items.push(Item::Table(requirements(source)));
        if let Some(svg) = requirement_figure(source) {
            let caption = "Probability that a flight does not meet a requirement, of the flights that were judged.";
            items.push(picture("requirements", svg, caption));
        }
    } else {
        items.push(Item::Text(format!(
            "The scenario has no requirements: a flight fails that does not settle, or that {FAILS_BY_ITSELF}."
        )));
    }
    items
}

fn mark(column: usize, controller: usize, found: &Probability) -> Option<IntervalMark> {
    let [lower, upper] = [found.lower, found.upper].map(|end| 100.0 * end);
    let value = 100.0 * found.estimate?;
    // Where nothing or everything was seen, the one-sided bound is what is said in words.
    let upper = found.at_most.map_or(upper, |bound| 100.0 * bound);
    let lower = found.at_least.map_or(lower, |bound| 100.0 * bound);
    Some(IntervalMark { column, style: style(controller), value, lower, upper })
}

fn failing(source: &Source<'_>) -> fspid_plot::Svg {
    let controllers = source.summary.controllers.iter().enumerate();
    let row = |(n, it): (usize, &ControllerSummary)| IntervalRow {
        name: source.name(n),
        words: probability(&it.failed, source.summary.head.confidence),
        marks: mark(0, n, &it.failed).into_iter().collect(),
    };
    IntervalFigure {
        title: "Probability that a flight fails".to_owned(),
        columns: vec![IntervalColumn {
            label: "probability [%]".to_owned(),
            ..IntervalColumn::default()
        }],
        rows: controllers.map(row).collect(),
        series: Vec::new(),
        width_px: 720.0,
    }
    .render()
}

/// Ids of requirements in the order of the scenario.
fn ids<'a>(source: &Source<'a>) -> Vec<&'a RequirementSummary> {
    source.summary.controllers.first().map_or(Vec::new(), |it| it.requirements.iter().collect())
}

/// A requirement of each controller that it concerns.
fn of_each<'a>(
    source: &Source<'a>,
    place: usize,
) -> impl Iterator<Item = (usize, &'a RequirementSummary)> {
    let controllers = source.summary.controllers.iter().enumerate();
    let found = controllers.filter_map(move |(n, it)| Some((n, it.requirements.get(place)?)));
    found.filter(|(_, requirement)| requirement.not_met.of > 0)
}

fn requirement_figure(source: &Source<'_>) -> Option<fspid_plot::Svg> {
    let row = |(place, requirement): (usize, &&RequirementSummary)| IntervalRow {
        name: cut(&requirement.id, 60),
        words: cut(&requirement.required, 40),
        marks: of_each(source, place).filter_map(|(n, it)| mark(0, n, &it.not_met)).collect(),
    };
    let ids = ids(source);
    let rows: Vec<IntervalRow> = ids.iter().enumerate().take(MOST_ROWS).map(row).collect();
    let any = rows.iter().any(|row| !row.marks.is_empty());
    let controllers = 0..source.summary.controllers.len();
    any.then(|| {
        IntervalFigure {
            title: "Requirements that are not met".to_owned(),
            columns: vec![IntervalColumn {
                label: "probability that it is not met [%]".to_owned(),
                ..IntervalColumn::default()
            }],
            rows,
            series: controllers.map(|n| (source.name(n), style(n))).collect(),
            width_px: 720.0,
        }
        .render()
    })
}

fn requirements(source: &Source<'_>) -> DataTable {
    let head = [
        "requirement",
        "controller",
        "required",
        "not met, of judged",
        "probability",
        "worst value",
        "worst run, flown again",
    ];
    let mut rows = Vec::new();
    for (place, _) in ids(source).iter().enumerate() {
        for (n, requirement) in of_each(source, place) {
            rows.push(requirement_row(source, n, requirement));
        }
    }
    DataTable {
        caption: format!(
            "Requirements: probability that a flight does not meet each, with its {} interval; the worst value and the run that it is from. A flight without a value does not meet the requirement.",
            percent(source.summary.head.confidence)
        ),
        head: head.map(str::to_owned).to_vec(),
        rows,
        cards: true,
    }
}

fn requirement_row(source: &Source<'_>, place: usize, it: &RequirementSummary) -> Vec<Datum> {
    let judged = format!("{} of {}", count(it.not_met.count), count(it.not_met.of));
    let judged = match it.without_value {
        0 => judged,
        without => format!("{judged}, {} without a value", count(without)),
    };
    let met = if it.not_met.count == 0 { Datum::Met(judged) } else { Datum::Unmet(judged) };
    let (value, replay) = match &it.worst {
        Some(worst) => {
            (Datum::Number(with_unit(worst.value, &it.unit)), Datum::Code(source.replay(worst.run)))
        }
        None => {
            let none = || Datum::Absent("no value".to_owned());
            (none(), none())
        }
    };
    vec![
        Datum::Text(cut(&it.id, 48)),
        Datum::Text(source.name(place)),
        Datum::Text(unbroken(&cut(&it.required, 48))),
        met,
        Datum::Number(probability(&it.not_met, source.summary.head.confidence)),
        value,
        replay,
    ]
}

/// The text with its last word, the unit, kept beside its number.
fn unbroken(text: &str) -> String {
    let (rest, last) = text.rsplit_once(' ').unwrap_or(("", text));
    if rest.is_empty() { last.to_owned() } else { format!("{rest}\u{a0}{last}") }
}
