//! Columns of numbers over all flights.

use std::cmp::Ordering;

use super::data::{Extreme, Limits, MeasureSummary, QuantileSummary};
use super::source::Source;
use super::{EXTREMES, QUANTILES, SENSITIVITY_RUNS, SummaryError};
use crate::rows::{Bad, DIVERGED_AT, LEFT_VALIDITY_AT, bad_side};
use crate::statistics::quantile::{interval, quantile};
use crate::statistics::{Histogram, Moments, Sorted, StatisticsError};
use crate::table;

/// Times of what is not to happen.
const EVENTS: [&str; 2] = [DIVERGED_AT, LEFT_VALIDITY_AT];

/// Beyond so many distances of the quartiles from the quartiles, a histogram only counts. Of normal values that is
/// beyond 7 standard deviations; of a few flights that all but diverged, it keeps the others from being one bar.
const FENCE: f64 = 5.0;

/// The values of one controller in a column.
#[derive(Default)]
pub(super) struct Cells {
    /// The finite ones, in the order of the runs.
    finite: Vec<f64>,
    missing: u64,
    not_finite: u64,
    lowest: Vec<Extreme>,
    highest: Vec<Extreme>,
    /// Of the first runs: the value, NaN where it is not finite or missing.
    pub(super) first: Vec<f64>,
}

/// Reads a column, apart for each controller.
pub(super) fn read(source: &Source, name: &str) -> Result<Vec<Cells>, SummaryError> {
    let of_run = source.controllers();
    let mut cells: Vec<Cells> = (0..of_run).map(|_| Cells::default()).collect();
    let mut row = 0;
    for values in source.reader.floats(name)? {
        for value in values? {
            if let Some(cells) = cells.get_mut(row % of_run) {
                cells.add((row / of_run) as u64, value);
            }
            row += 1;
        }
    }
    Ok(cells)
}

impl Cells {
    fn add(&mut self, run: u64, value: Option<f64>) {
        let finite = value.filter(|value| value.is_finite());
        if self.first.len() < SENSITIVITY_RUNS {
            self.first.push(finite.unwrap_or(f64::NAN));
        }
        match (finite, value) {
            (Some(value), _) => {
                self.finite.push(value);
                keep(&mut self.lowest, Extreme { run, value }, |a, b| a.total_cmp(&b));
                keep(&mut self.highest, Extreme { run, value }, |a, b| b.total_cmp(&a));
            }
            (None, Some(_)) => self.not_finite += 1,
            (None, None) => self.missing += 1,
        }
    }

    /// What they say.
    pub(super) fn summary(
        self,
        column: &table::Column,
        limits: Option<Limits>,
        confidence: f64,
    ) -> Result<MeasureSummary, StatisticsError> {
        let count = self.finite.len() as u64;
        let moments = Moments::of(&self.finite);
        let sorted = Sorted::from(self.finite);
        Ok(MeasureSummary {
            name: column.name.clone(),
            unit: column.unit.clone(),
            meaning: column.meaning.clone(),
            count,
            missing: self.missing,
            not_finite: self.not_finite,
            moments,
            quantiles: quantiles(&sorted, confidence)?,
            histogram: histogram(&sorted),
            lowest: self.lowest,
            highest: self.highest,
            bad: bad(&column.name, limits),
            is_event: EVENTS.contains(&column.name.as_str()),
        })
    }
}

/// Puts a value among the first few in some order; equal ones stay in the order in which they came.
fn keep(list: &mut Vec<Extreme>, found: Extreme, order: impl Fn(f64, f64) -> Ordering) {
    let full = list.len() == EXTREMES;
    if full && list.last().is_some_and(|last| order(found.value, last.value).is_ge()) {
        return;
    }
    let place = list.partition_point(|other| order(other.value, found.value).is_le());
    list.insert(place, found);
    list.truncate(EXTREMES);
}

fn quantiles(sorted: &Sorted, confidence: f64) -> Result<Vec<QuantileSummary>, StatisticsError> {
    let one = |&share: &f64| {
        let value = quantile(sorted, share)?;
        let interval = interval(sorted, share, confidence);
        Some(interval.map(|interval| QuantileSummary { share, value, interval }))
    };
    QUANTILES.iter().filter_map(one).collect()
}

fn histogram(sorted: &Sorted) -> Option<Histogram> {
    let (&least, &most) = (sorted.values().first()?, sorted.values().last()?);
    let (low, high) = (quantile(sorted, 0.25)?, quantile(sorted, 0.75)?);
    let fence = FENCE * (high - low);
    if !(fence > 0.0 && fence.is_finite()) {
        return Histogram::of(sorted);
    }
    Histogram::between(sorted, least.max(low - fence), most.min(high + fence))
}

fn bad(name: &str, limits: Option<Limits>) -> Option<Bad> {
    match limits {
        _ if name == DIVERGED_AT => Some(Bad::Low),
        Some(Limits { least: Some(_), most: None }) => Some(Bad::Low),
        Some(Limits { least: None, most: Some(_) }) => Some(Bad::High),
        _ => bad_side(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_extremes_are_those_of_the_first_runs() {
        let mut cells = Cells::default();
        for run in 0..20 {
            cells.add(run, Some(if run % 3 == 0 { 1.0 } else { 2.0 }));
        }
        let runs = |list: &[Extreme]| list.iter().map(|it| it.run).collect::<Vec<_>>();
        assert_eq!(runs(&cells.lowest), [0, 3, 6, 9, 12]);
        assert_eq!(runs(&cells.highest), [1, 2, 4, 5, 7]);
    }

    #[test]
    fn a_value_far_from_all_others_is_counted_and_does_not_widen_the_histogram() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        values.push(1e9);
        let histogram = histogram(&Sorted::of(&values)).expect("a histogram");
        assert_eq!(histogram.above, 1);
        assert!(histogram.edges.last().is_some_and(|edge| *edge < 1e4), "{histogram:?}");
    }
}
