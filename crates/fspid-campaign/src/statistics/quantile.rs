//! Quantiles of a column and how sure they are.

use std::ops::Range;

use serde::Serialize;

use super::Ordered;
use super::error::{StatisticsError, confidence as checked_confidence, share as checked_share};
use super::tail::{Chance, at_least, at_most};

/// Where the quantile of the population lies; an end that so few runs cannot bound is `None`: unbounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end, in the unit of the column.
    pub lower: Option<f64>,
    /// Upper end, in the unit of the column.
    pub upper: Option<f64>,
}

/// The value that a share of the runs stays below, estimated by linear interpolation between neighbours.
///
/// $$ x_{(i)} + (h - i) (x_{(i+1)} - x_{(i)}), \quad h = (n - 1) s + 1, \ i = \lfloor h \rfloor $$
///
/// 0 gives the minimum, 1 the maximum, 0.5 the median. `None` for an empty column and a share outside [0, 1].
///
/// # Source
/// R. J. Hyndman, Y. Fan, *Sample quantiles in statistical packages*, The American Statistician 50 (1996), definition 7.
#[must_use]
pub fn quantile(sorted: &impl Ordered, share: f64) -> Option<f64> {
    quantile_between(sorted, 0..sorted.count(), checked_share(share).ok()?)
}

/// The same of the values at some places, for a share from 0 to 1.
pub(super) fn quantile_between(
    sorted: &impl Ordered,
    places: Range<usize>,
    share: f64,
) -> Option<f64> {
    let (index, along) = place(places.len(), share)?;
    let low = sorted.at(places.start + index)?;
    let high = sorted.at((places.start + index + 1).min(places.end - 1))?;
    Some((low + along * (high - low)).clamp(low, high))
}

/// Between which places a quantile of so many values lies: the lower one, and how far it is to the next.
fn place(count: usize, share: f64) -> Option<(usize, f64)> {
    let place = count.checked_sub(1)? as f64 * share;
    let below = place.floor();
    Some((below as usize, place - below))
}

/// What the quantile of these values is at least and at most; the ends are equal where it is known exactly.
#[must_use]
pub fn bounds(sorted: &impl Ordered, share: f64) -> Option<[f64; 2]> {
    let (index, along) = place(sorted.count(), checked_share(share).ok()?)?;
    let low = sorted.bounds(index)?;
    let high = sorted.bounds((index + 1).min(sorted.count() - 1))?;
    let ends =
        low.into_iter().zip(high).map(|(low, high)| (low + along * (high - low)).clamp(low, high));
    let ends: Vec<f64> = ends.collect();
    ends.try_into().ok()
}

/// Two-sided interval for the quantile of the population, from order statistics: exact for every distribution.
///
/// The number of runs below the quantile is binomial. The lower end is the highest value $x_{(r)}$ with
/// $P(X \le r - 1) \le (1 - c)/2$, the upper end the lowest $x_{(r)}$ with $P(X \ge r) \le (1 - c)/2$,
/// $X \sim \mathrm{Bin}(n, s)$. It holds the quantile with at least the confidence, for independent runs.
///
/// # Source
/// W. J. Conover, *Practical Nonparametric Statistics*, 3rd ed. (1999), section 3.2.
///
/// # Errors
/// The share is not in [0, 1] or the confidence not inside (0, 1).
pub fn interval(
    sorted: &impl Ordered,
    share: f64,
    confidence: f64,
) -> Result<Interval, StatisticsError> {
    let share = Chance::of(checked_share(share)?);
    let each = (1.0 - checked_confidence(confidence)?) / 2.0;
    Ok(Interval { lower: lower(sorted, share, each), upper: upper(sorted, share, each) })
}

/// One-sided bound: at least this share of the population lies at or below it, with the confidence (a tolerance limit).
///
/// `None` if there are too few runs: 59 are the fewest for 95 % of the population with 95 % confidence, 299 for 99 %.
/// Assumes independent runs.
///
/// # Source
/// S. S. Wilks, *Determination of sample sizes for setting tolerance limits*, Annals of Mathematical Statistics 12 (1941).
///
/// # Errors
/// The share is not in [0, 1] or the confidence not inside (0, 1).
pub fn upper_bound(
    sorted: &impl Ordered,
    share: f64,
    confidence: f64,
) -> Result<Option<f64>, StatisticsError> {
    Ok(upper(sorted, Chance::of(checked_share(share)?), 1.0 - checked_confidence(confidence)?))
}

/// One-sided bound: at most this share of the population lies below it, with the confidence.
///
/// `None` if there are too few runs. Assumes independent runs.
///
/// # Errors
/// The share is not in [0, 1] or the confidence not inside (0, 1).
pub fn lower_bound(
    sorted: &impl Ordered,
    share: f64,
    confidence: f64,
) -> Result<Option<f64>, StatisticsError> {
    Ok(lower(sorted, Chance::of(checked_share(share)?), 1.0 - checked_confidence(confidence)?))
}

/// Rounding must not decide where a tail is exactly what is allowed.
const ROUNDING: f64 = 1.0 + 1e-12;

fn lower(sorted: &impl Ordered, share: Chance, tail: f64) -> Option<f64> {
    let runs = sorted.count() as f64;
    let rank = first(sorted.count(), |below| at_most(below as f64, runs, share) > tail * ROUNDING);
    let [least, _] = sorted.bounds(rank.checked_sub(1)?)?;
    Some(least)
}

fn upper(sorted: &impl Ordered, share: Chance, tail: f64) -> Option<f64> {
    let (count, runs) = (sorted.count(), sorted.count() as f64);
    let index = first(count, |index| at_least((index + 1) as f64, runs, share) <= tail * ROUNDING);
    let [_, most] = sorted.bounds(index)?;
    Some(most)
}

/// The first of `0..count` that holds, `count` if none does; once true it stays true.
fn first(count: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut from, mut to) = (0, count);
    while from < to {
        let middle = from + (to - from) / 2;
        if holds(middle) { to = middle } else { from = middle + 1 }
    }
    from
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Sorted;

    fn counted(count: u32) -> Sorted {
        (1..=count).map(f64::from).collect::<Vec<_>>().into()
    }

    #[test]
    fn the_ends_are_minimum_and_maximum_and_the_middle_is_the_median() {
        let sorted = Sorted::of(&[3.0, 1.0, 10.0, 2.0]);
        let shares = [0.0, 0.5, 1.0].map(|share| quantile(&sorted, share));
        assert_eq!(shares, [Some(1.0), Some(2.5), Some(10.0)]);
    }

    #[test]
    fn an_empty_column_and_a_share_that_is_none_have_no_quantile() {
        assert_eq!(quantile(&Sorted::default(), 0.5), None);
        for share in [-0.1, 1.1, f64::NAN] {
            assert_eq!(quantile(&counted(5), share), None);
            assert!(matches!(
                interval(&counted(5), share, 0.9),
                Err(StatisticsError::Share { .. })
            ));
        }
        assert!(matches!(interval(&counted(5), 0.5, 1.0), Err(StatisticsError::Confidence { .. })));
    }

    #[test]
    fn an_empty_column_bounds_nothing() {
        let nothing = Interval { lower: None, upper: None };
        assert_eq!(interval(&Sorted::default(), 0.5, 0.95), Ok(nothing));
    }

    /// Wilks (1941): 59 runs for 95 % with 95 %, 299 for 99 %, 93 for the second largest of 95 %.
    #[test]
    fn the_largest_value_is_a_tolerance_limit_from_the_number_of_runs_on_that_wilks_gives() {
        for (runs, share) in [(59, 0.95), (299, 0.99)] {
            assert_eq!(upper_bound(&counted(runs), share, 0.95), Ok(Some(f64::from(runs))));
            assert_eq!(upper_bound(&counted(runs - 1), share, 0.95), Ok(None));
            assert_eq!(lower_bound(&counted(runs), 1.0 - share, 0.95), Ok(Some(1.0)));
        }
        assert_eq!(upper_bound(&counted(93), 0.95, 0.95), Ok(Some(92.0)));
        assert_eq!(upper_bound(&counted(92), 0.95, 0.95), Ok(Some(92.0)));
    }

    /// Six values, the median, 31/32: both ends at 1/64 = 0.5⁶ exactly.
    #[test]
    fn a_tail_that_is_exactly_what_is_allowed_counts() {
        let found = interval(&counted(6), 0.5, 31.0 / 32.0);
        assert_eq!(found, Ok(Interval { lower: Some(1.0), upper: Some(6.0) }));
    }

    #[test]
    fn the_extremes_of_the_population_are_bounded_on_one_side_only() {
        let sorted = counted(10);
        assert_eq!(interval(&sorted, 0.0, 0.95), Ok(Interval { lower: None, upper: Some(1.0) }));
        assert_eq!(interval(&sorted, 1.0, 0.95), Ok(Interval { lower: Some(10.0), upper: None }));
    }
}
