//! How measures are distributed: histograms first, all numbers in a table.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item, Picture};
use fspid_plot::{DistributionFigure, DistributionRow, LimitLine};

use super::measures::{self, Measure};
use super::words::{count, cut, number};
use super::{Source, style};
use crate::summary::words::number as four_digits;
use crate::summary::{Extreme, MeasureSummary, QuantileSummary};

/// Most controllers in one figure.
const MOST_ROWS: usize = 12;
/// Most figures of main measures, and most controllers with figures of the others: pages shall stay small.
const MOST_FIGURES: usize = 16;
const FEW_CONTROLLERS: usize = 4;
/// Most rows of the table.
const MOST_TABLE: usize = 400;

pub(super) fn chapter(source: &Source<'_>) -> Chapter {
    let measures = measures::all(source);
    let (shown, empty): (Vec<_>, Vec<_>) = measures.iter().partition(|it| !it.of.is_empty());
    let (main, others): (Vec<_>, Vec<_>) = shown.into_iter().partition(|it| it.is_main);
    let mut items = vec![Item::Text(
        "Each row is the histogram of one controller, as high as its highest bin, whose share of the flights stands left of it. Below: a thin line from 5 to 95 %, a thick one over the middle half, a stroke at the median. A dashed line is a limit; its short strokes point to what is not allowed. Few values far from the others have no bar, and stand in words; without: flights that do not have the measure.".to_owned(),
    )];
    let pictures = |list: &[&Measure<'_>]| list.iter().map(|it| picture(source, it)).collect();
    items.push(Item::Figures(pictures(&main[..main.len().min(MOST_FIGURES)])));
    let missing: Vec<String> =
        empty.iter().filter(|it| it.is_main).map(|it| it.title.to_lowercase()).collect();
    if !missing.is_empty() {
        items.push(Item::Text(format!("No flight has: {}.", cut(&missing.join(", "), 400))));
    }
    if !others.is_empty() && source.summary.controllers.len() <= FEW_CONTROLLERS {
        let title = format!("{} more measures", others.len());
        items.push(Item::Fold(title, vec![Item::Figures(pictures(&others))]));
    }
    items.push(Item::Fold("All measures in numbers".to_owned(), vec![Item::Table(table(source))]));
    Chapter { id: "distributions".to_owned(), title: "Distributions".to_owned(), items }
}

fn picture(source: &Source<'_>, measure: &Measure<'_>) -> Picture {
    let figure = DistributionFigure {
        title: measure.title.clone(),
        x_label: measure.axis.clone(),
        rows: measure.of.iter().take(MOST_ROWS).map(|(n, it)| row(source, *n, it)).collect(),
        limits: measure.limits.iter().flat_map(lines).collect(),
        width_px: 560.0,
    };
    let caption = format!("{}.", cut(&measure.caption, 300));
    Picture { name: measure.name.to_owned(), svg: figure.render(), caption }
}

fn lines((limits, words): &(crate::summary::Limits, String)) -> Vec<LimitLine> {
    let line = |(at, most): (f64, bool)| LimitLine { at, name: cut(words, 60), most };
    let ends = [limits.least.map(|at| (at, false)), limits.most.map(|at| (at, true))];
    ends.into_iter().flatten().map(line).collect()
}

fn row(source: &Source<'_>, controller: usize, it: &MeasureSummary) -> DistributionRow {
    // A bin around a single value would look like a spread.
    let differs = it.moments.is_none_or(|moments| moments.minimum < moments.maximum);
    let (edges, counts) = it
        .histogram
        .as_ref()
        .filter(|_| differs)
        .map(|histogram| (histogram.edges.clone(), histogram.counts.clone()))
        .unwrap_or_default();
    let at = |share: f64| value_at(it, share);
    let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95].map(at);
    let all: Option<Vec<f64>> = quantiles.into_iter().collect();
    DistributionRow {
        name: source.name(controller),
        words: words(it),
        style: style(controller),
        edges,
        counts,
        of: it.count,
        quantiles: all.and_then(|all| all.try_into().ok()),
    }
}

/// Median and percentiles, how many values lie beyond the bars, and how many flights have none.
fn words(it: &MeasureSummary) -> String {
    let [low, median, high] = [0.05, 0.5, 0.95].map(|share| value_at(it, share));
    let same = it.moments.filter(|moments| moments.minimum >= moments.maximum);
    let mut words = match (low, median, high) {
        _ if same.is_some() => {
            same.map_or_else(String::new, |it| format!("all {}", number(it.mean)))
        }
        (Some(low), Some(median), Some(high)) => {
            format!("median {}, 5\u{2013}95 %: {} to {}", number(median), number(low), number(high))
        }
        _ => String::new(),
    };
    if let Some(histogram) = &it.histogram {
        let ends = histogram.edges.first().zip(histogram.edges.last());
        let [low, high] = ends.map_or([f64::NAN; 2], |(low, high)| [*low, *high]);
        for (found, side, end) in
            [(histogram.below, "below", low), (histogram.above, "above", high)]
        {
            if found > 0 {
                words.push_str(&format!("; {} {side} {} without a bar", count(found), number(end)));
            }
        }
    }
    let without = it.missing + it.not_finite;
    if without > 0 && !it.is_event {
        words.push_str(&format!("; {} without", count(without)));
    }
    words
}

pub(super) fn value_at(it: &MeasureSummary, share: f64) -> Option<f64> {
    let near = |found: f64| (found - share).abs() < 1e-9;
    it.quantiles.iter().find(|quantile| near(quantile.share)).map(|quantile| quantile.value)
}

/// Every measure of every controller in numbers.
fn table(source: &Source<'_>) -> DataTable {
    let head = [
        "measure",
        "controller",
        "flights",
        "mean",
        "standard deviation",
        "5 %",
        "median (interval)",
        "95 %",
        "99 %",
        "lowest (run)",
        "highest (run)",
    ];
    let mut rows = Vec::new();
    for measure in measures::all(source) {
        for (n, it) in &measure.of {
            let mut row = vec![Datum::Text(cut(&measure.axis, 48)), Datum::Text(source.name(*n))];
            row.extend(numbers(it));
            rows.push(row);
        }
    }
    let left = rows.len().saturating_sub(MOST_TABLE);
    rows.truncate(MOST_TABLE);
    let left = if left > 0 { format!(" {left} rows are left out.") } else { String::new() };
    DataTable {
        caption: format!(
            "Measures over the flights that have them. The interval of the median is exact at {} for independent runs.{left}",
            super::words::percent(source.summary.head.confidence)
        ),
        head: head.map(str::to_owned).to_vec(),
        rows,
        cards: true,
    }
}

fn numbers(it: &MeasureSummary) -> Vec<Datum> {
    let given = |value: Option<f64>| match value {
        Some(value) => Datum::Number(four_digits(value)),
        None => Datum::Absent("none".to_owned()),
    };
    let extreme = |found: Option<&Extreme>| match found {
        Some(it) => Datum::Number(format!("{} ({})", four_digits(it.value), it.run)),
        None => Datum::Absent("none".to_owned()),
    };
    let end = |value: Option<f64>| value.map_or("unbounded".to_owned(), four_digits);
    let median = it.quantiles.iter().find(|it| (it.share - 0.5).abs() < 1e-9);
    let median = median.map(|it| {
        let [lower, upper] = [it.interval.lower, it.interval.upper].map(end);
        format!("{} ({lower} to {upper})", it.in_words())
    });
    let quantile = |share: f64| {
        let found = it.quantiles.iter().find(|it| (it.share - share).abs() < 1e-9);
        let words = found.map(QuantileSummary::in_words);
        words.map_or_else(|| Datum::Absent("none".to_owned()), Datum::Number)
    };
    vec![
        Datum::Number(count(it.count)),
        given(it.moments.map(|moments| moments.mean)),
        given(it.moments.and_then(|moments| moments.standard_deviation)),
        quantile(0.05),
        median.map_or_else(|| Datum::Absent("none".to_owned()), Datum::Number),
        quantile(0.95),
        quantile(0.99),
        extreme(it.lowest.first()),
        extreme(it.highest.first()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Histogram;

    #[test]
    fn values_beyond_the_bars_are_told_with_the_ends_of_the_bars() {
        let found = MeasureSummary {
            name: "overshoot_pct".to_owned(),
            unit: "%".to_owned(),
            meaning: String::new(),
            count: 20,
            missing: 2,
            not_finite: 1,
            moments: None,
            quantiles: Vec::new(),
            histogram: Some(Histogram {
                edges: vec![0.5, 1.0, 1.5],
                counts: vec![8, 9],
                below: 0,
                above: 3,
            }),
            lowest: Vec::new(),
            highest: Vec::new(),
            bad: None,
            is_event: false,
        };
        assert_eq!(words(&found), "; 3 above 1.5 without a bar; 3 without");
        let quiet = MeasureSummary { is_event: true, histogram: None, ..found };
        assert_eq!(words(&quiet), "");
    }
}
