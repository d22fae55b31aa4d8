//! Columns of numbers over all flights.

use std::cmp::Ordering;

use super::data::{Extreme, Limits, MeasureSummary, QuantileSummary, Sketched};
use super::source::Source;
use super::{EXTREMES, QUANTILES, SummaryError};
use crate::rows::{Bad, DIVERGED_AT, LEFT_VALIDITY_AT, bad_side};
use crate::statistics::quantile::{bounds, interval, quantile};
use crate::statistics::sketch::Ranks;
use crate::statistics::{Histogram, Moments, Ordered, Sketch, Sorted, StatisticsError};
use crate::table;

/// Times of what is not to happen.
const EVENTS: [&str; 2] = [DIVERGED_AT, LEFT_VALIDITY_AT];

/// Beyond so many distances of the quartiles from the quartiles, a histogram only counts. Of normal values that is
/// beyond 7 standard deviations; of a few flights that all but diverged, it keeps the others from being one bar.
const FENCE: f64 = 5.0;

/// Where the finite values of a column go: all of them into a list in the order of the runs, or into a sketch.
pub(super) trait Finite: Default + Send {
    fn add(&mut self, value: f64);

    /// With those of later runs.
    fn merge(&mut self, later: Self);

    /// What they say.
    fn said(self, confidence: f64) -> Result<Said, StatisticsError>;
}

/// The values of one controller in a column.
#[derive(Default)]
pub(super) struct Cells<F> {
    finite: F,
    missing: u64,
    not_finite: u64,
    lowest: Vec<Extreme>,
    highest: Vec<Extreme>,
    /// Of the first runs: the value, NaN where it is not finite or missing.
    pub(super) first: Vec<f64>,
}

/// Reads a column, apart for each controller.
pub(super) fn read<F: Finite>(source: &Source, name: &str) -> Result<Vec<Cells<F>>, SummaryError> {
    let of_run = source.controllers();
    let mut cells: Vec<Cells<F>> = (0..of_run).map(|_| Cells::default()).collect();
    let mut row = 0;
    for values in source.files.floats(name)? {
        for value in values? {
            if let Some(cells) = cells.get_mut(row % of_run) {
                cells.add(source.run(row), value, source.first_runs);
            }
            row += 1;
        }
    }
    Ok(cells)
}

impl<F: Finite> Cells<F> {
    /// With what later rows say.
    pub(super) fn merge(&mut self, later: Self) {
        self.finite.merge(later.finite);
        self.missing += later.missing;
        self.not_finite += later.not_finite;
        self.first.extend(later.first);
        later.lowest.into_iter().for_each(|found| self.keep_low(found));
        later.highest.into_iter().for_each(|found| self.keep_high(found));
    }

    fn add(&mut self, run: u64, value: Option<f64>, first_runs: usize) {
        let finite = value.filter(|value| value.is_finite());
        if self.first.len() < first_runs {
            self.first.push(finite.unwrap_or(f64::NAN));
        }
        match (finite, value) {
            (Some(value), _) => {
                self.finite.add(value);
                self.keep_low(Extreme { run, value });
                self.keep_high(Extreme { run, value });
            }
            (None, Some(_)) => self.not_finite += 1,
            (None, None) => self.missing += 1,
        }
    }

    fn keep_low(&mut self, found: Extreme) {
        keep(&mut self.lowest, found, |a, b| a.total_cmp(&b));
    }

    fn keep_high(&mut self, found: Extreme) {
        keep(&mut self.highest, found, |a, b| b.total_cmp(&a));
    }

    /// What they say.
    pub(super) fn summary(
        self,
        column: &table::Column,
        limits: Option<Limits>,
        confidence: f64,
    ) -> Result<MeasureSummary, StatisticsError> {
        let said = self.finite.said(confidence)?;
        Ok(MeasureSummary {
            name: column.name.clone(),
            unit: column.unit.clone(),
            meaning: column.meaning.clone(),
            count: said.count as u64,
            missing: self.missing,
            not_finite: self.not_finite,
            moments: said.moments,
            quantiles: said.quantiles,
            histogram: said.histogram,
            lowest: self.lowest,
            highest: self.highest,
            bad: bad(&column.name, limits),
            is_event: EVENTS.contains(&column.name.as_str()),
        })
    }
}

/// What finite values say.
pub(super) struct Said {
    count: usize,
    moments: Option<Moments>,
    quantiles: Vec<QuantileSummary>,
    histogram: Option<Histogram>,
}

impl Finite for Vec<f64> {
    fn add(&mut self, value: f64) {
        self.push(value);
    }

    fn merge(&mut self, later: Self) {
        self.extend(later);
    }

    fn said(self, confidence: f64) -> Result<Said, StatisticsError> {
        let moments = Moments::of(&self);
        Said::of(&Sorted::from(self), moments, confidence, |_| None)
    }
}

impl Finite for Sketch {
    fn add(&mut self, value: f64) {
        Self::add(self, value);
    }

    fn merge(&mut self, later: Self) {
        Self::merge(self, &later);
    }

    fn said(self, confidence: f64) -> Result<Said, StatisticsError> {
        let ranks = self.ranks();
        Said::of(&ranks, self.moments(), confidence, |share| sketched(&ranks, share))
    }
}

impl Said {
    fn of(
        sorted: &impl Ordered,
        moments: Option<Moments>,
        confidence: f64,
        off: impl Fn(f64) -> Option<Sketched>,
    ) -> Result<Self, StatisticsError> {
        let one = |&share: &f64| {
            let value = quantile(sorted, share)?;
            let interval = interval(sorted, share, confidence);
            let sketch = off(share);
            Some(interval.map(|interval| QuantileSummary { share, value, interval, sketch }))
        };
        let quantiles = QUANTILES.iter().filter_map(one).collect::<Result<_, _>>()?;
        Ok(Self { count: sorted.count(), moments, quantiles, histogram: histogram(sorted) })
    }
}

/// How far a quantile from a sketch may be off.
fn sketched(ranks: &Ranks, share: f64) -> Option<Sketched> {
    let [at_least, at_most] = bounds(ranks, share)?;
    let place = (ranks.count() - 1) as f64 * share;
    let [below, above] =
        [place.floor(), place.ceil()].map(|place| ranks.rank_error(place as usize));
    let rank_error = below.max(above) as f64 / ranks.count() as f64;
    Some(Sketched { rank_error, at_least, at_most })
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

fn histogram(sorted: &impl Ordered) -> Option<Histogram> {
    let (least, most) = (sorted.at(0)?, sorted.at(sorted.count() - 1)?);
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
        let mut cells = Cells::<Vec<f64>>::default();
        for run in 0..20 {
            cells.add(run, Some(if run % 3 == 0 { 1.0 } else { 2.0 }), 0);
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
