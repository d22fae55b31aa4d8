//! Differences with intervals, and error against activity.

use fspid_page::analysis::{Chapter, Item};
use fspid_plot::{
    IntervalColumn, IntervalFigure, IntervalMark, IntervalRow, TradeFigure, TradeSeries,
};

use super::{chapter, picture, style, tables};
use crate::contest::Outcome;
use crate::contest::compare::{Comparison, Ratio};
use crate::contest::judged::{CaseGroup, Judged, Quantity};
use crate::contest::words::{counted, cut, group, name, per_cent};

/// Intervals that reach farther than this many times the largest difference are cut at the edge, unless that is near.
const REACH: f64 = 1.3;
const LEAST_PCT: f64 = 30.0;
/// What is more than three times as large is hopeless, and would hide how the others differ.
const MOST_PCT: f64 = 200.0;
/// Most groups that are drawn.
const MOST_GROUPS: usize = 16;

/// Differences by group of cases.
pub(super) fn where_chapter(outcome: &Outcome) -> Chapter {
    let reference = cut(name(outcome, outcome.judged.against), 60);
    let mut items = Vec::new();
    if outcome.error.is_some() {
        items.push(picture(
            "differences",
            differences(outcome),
            format!(
                "Mean difference from {reference} over all cases and by group, left of 0 is better. The intervals of all cases hold together at {}; those of groups each alone. A group of fewer than three cases has a sign without an interval. A sign at the edge lies beyond it, and an interval that ends there reaches farther. Cases that either lost are left out here; lost flights are counted below.",
                per_cent()
            ),
        ));
    }
    items.push(Item::Fold(
        "Every case in numbers".to_owned(),
        vec![Item::Table(tables::cases(outcome))],
    ));
    chapter("where", "Who wins where", items)
}

fn differences(outcome: &Outcome) -> fspid_plot::Svg {
    let groups = outcome.judged.groups();
    let all = counted(outcome.judged.cases.len(), "case", "cases");
    let mut rows = vec![IntervalRow {
        name: "all cases".to_owned(),
        words: all,
        marks: marks(outcome, |it| Some(it.ratio)),
    }];
    let by_group = groups.iter().enumerate().take(MOST_GROUPS);
    if groups.len() > 1 {
        rows.extend(by_group.map(|(place, CaseGroup { name, cases })| IntervalRow {
            name: cut(group(name), 40),
            words: counted(cases.len(), "case", "cases"),
            marks: marks(outcome, |it| it.groups.get(place).copied()),
        }));
    }
    let column = |place: usize, label: &str| {
        let range = range(rows.iter().flat_map(|row| &row.marks).filter(|it| it.column == place));
        IntervalColumn { label: label.to_owned(), range, stems: false }
    };
    let columns = vec![column(0, "IAE [%]"), column(1, "elevator travel [%]")];
    let contestants = outcome.judged.contestants.iter().enumerate();
    let others = contestants.filter(|(place, _)| *place != outcome.judged.against);
    IntervalFigure {
        title: format!("Difference from {}", cut(name(outcome, outcome.judged.against), 60)),
        columns,
        rows,
        series: others.map(|(place, it)| (cut(&it.name, 60), style(outcome, place))).collect(),
        width_px: 760.0,
    }
    .render()
}

/// Ends of an axis that shows every estimate, and no interval that would make the others small.
fn range<'a>(marks: impl Iterator<Item = &'a IntervalMark> + Clone) -> Option<(f64, f64)> {
    let most = |value: fn(&IntervalMark) -> f64| marks.clone().map(value).fold(0.0, f64::max);
    let lower = marks.clone().map(|it| it.lower).fold(0.0, f64::min);
    let upper = most(|it| it.upper).min((REACH * most(|it| it.value)).clamp(LEAST_PCT, MOST_PCT));
    let pad = 0.05 * (upper - lower);
    (pad > 0.0).then_some((lower - pad, upper + pad))
}

fn marks(outcome: &Outcome, of: impl Fn(&Comparison) -> Option<Ratio>) -> Vec<IntervalMark> {
    let columns = [outcome.error.as_ref(), outcome.activity.as_ref()];
    let mut marks = Vec::new();
    for (column, comparisons) in columns.into_iter().enumerate() {
        for found in comparisons.into_iter().flatten() {
            let Some((ratio, mean)) = of(found).and_then(|it| Some((it, it.mean?))) else {
                continue;
            };
            let percent = |ratio: f64| 100.0 * (ratio - 1.0);
            let [lower, upper] = ratio.interval.unwrap_or([mean; 2]).map(percent);
            let style = style(outcome, found.contestant);
            marks.push(IntervalMark { column, style, value: percent(mean), lower, upper });
        }
    }
    marks
}

/// Error against activity, one sign a design.
pub(super) fn trade_chapter(outcome: &Outcome) -> Chapter {
    let judged = &outcome.judged;
    let kept = judged.kept(judged.contestants.iter(), &judged.all());
    if kept.is_empty() {
        let none = "There is no case that nobody lost a flight of, and so no mean to draw.";
        let items = vec![Item::Warning(none.to_owned())];
        return chapter("activity", "Error and elevator activity", items);
    }
    let of = |place: usize| TradeSeries {
        name: cut(&judged.contestants[place].name, 60),
        style: style(outcome, place),
        points: points(judged, place, &kept),
        is_joined: false,
        band: Vec::new(),
    };
    let figure = TradeFigure {
        title: "Error against elevator activity".to_owned(),
        x_label: "mean elevator travel [deg]".to_owned(),
        y_label: "mean IAE [deg s]".to_owned(),
        series: (0..judged.contestants.len()).map(of).collect(),
    };
    let cases = match kept.len() == judged.cases.len() {
        true => "all cases".to_owned(),
        false => format!(
            "the {} of {} cases that nobody lost a flight of",
            kept.len(),
            judged.cases.len()
        ),
    };
    let caption = format!(
        "One sign for each seed of each controller: its means over {cases}. Low is a small error, left is a quiet elevator; a controller that has signs below and left of another's is better in both."
    );
    let items = vec![picture("trade", figure.render(), caption)];
    chapter("activity", "Error and elevator activity", items)
}

fn points(judged: &Judged, place: usize, cases: &[usize]) -> Vec<(f64, f64)> {
    let designs = judged.contestants.get(place).map_or(&[][..], |it| it.designs.as_slice());
    let point = |design| {
        let x = judged.mean(design, cases, Quantity::ACTIVITY)?;
        Some((x, judged.mean(design, cases, Quantity::ERROR)?))
    };
    designs.iter().filter_map(point).collect()
}
