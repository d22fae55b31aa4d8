//! How often which values occur, in bins whose edges are round numbers.

use std::ops::Range;

use serde::Serialize;

use super::Ordered;
use super::quantile::quantile_between;

/// Counts of values in adjoining bins of one width.
///
/// Bin *i* holds the values from `edges[i]` up to but without `edges[i + 1]`; the last one holds its upper edge too. The edges
/// are multiples of 1, 2 or 5 times a power of ten, each the double nearest to that decimal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Ends of the bins in ascending order, one more than bins, in the unit of the column.
    pub edges: Vec<f64>,
    /// Values in each bin.
    pub counts: Vec<u64>,
    /// Values below the first edge.
    pub below: u64,
    /// Values above the last edge.
    pub above: u64,
}

/// Fewest and most bins of a column whose values differ.
pub const BINS: [u32; 2] = [10, 60];

impl Histogram {
    /// Of all values of a column.
    ///
    /// The width is the round number at or below $2 (q_{0.75} - q_{0.25}) n^{-1/3}$, as far as 10 to 60 bins allow. Fewer
    /// bins come where the values are so near each other that doubles between them run out; a single value repeated has one bin.
    /// `None` for a column without finite values, and for one whose edges would overflow.
    ///
    /// # Source
    /// D. Freedman, P. Diaconis, *On the histogram as a density estimator: L₂ theory*, Zeitschrift für
    /// Wahrscheinlichkeitstheorie 57 (1981).
    #[must_use]
    pub fn of(sorted: &impl Ordered) -> Option<Self> {
        let last = sorted.count().checked_sub(1)?;
        Self::between(sorted, sorted.at(0)?, sorted.at(last)?)
    }

    /// Of the values between two limits, and around them up to the next round number; the others are counted as outside.
    ///
    /// `None` unless the limits are finite and the first is not above the second, and as for [`of`](Self::of).
    #[must_use]
    pub fn between(sorted: &impl Ordered, lower: f64, upper: f64) -> Option<Self> {
        if !(lower <= upper && lower.is_finite() && upper.is_finite()) {
            return None;
        }
        sorted.at(0)?;
        let inside = sorted.below(lower, false)..sorted.below(upper, true);
        let wanted = freedman_diaconis(sorted, inside);
        let edges = Width::of(lower, upper, wanted)?.edges(lower, upper);
        edges.iter().all(|edge| edge.is_finite()).then(|| Self::counted(sorted, edges))
    }

    fn counted(sorted: &impl Ordered, edges: Vec<f64>) -> Self {
        let bins = edges.len() - 1;
        let ranks = edges.iter().enumerate().map(|(at, &edge)| sorted.below(edge, at == bins));
        let ranks: Vec<usize> = ranks.collect();
        let counts = ranks.windows(2).map(|ends| (ends[1] - ends[0]) as u64).collect();
        let below = ranks.first().map_or(0, |&rank| rank as u64);
        let above = ranks.last().map_or(0, |&rank| (sorted.count() - rank) as u64);
        Self { edges, counts, below, above }
    }
}

/// Twice the distance of the quartiles of the values at some places over the cube root of their number; 0 without values.
fn freedman_diaconis(sorted: &impl Ordered, places: Range<usize>) -> f64 {
    let quartile = |share| quantile_between(sorted, places.clone(), share).unwrap_or(0.0);
    2.0 * (quartile(0.75) - quartile(0.25)) / libm::cbrt(places.len().max(1) as f64)
}

/// A round width: 1, 2 or 5 times a power of ten, numbered in ascending order, 0 for 1.
#[derive(Clone, Copy, Debug)]
struct Width(i32);

impl Width {
    /// Near `wanted`, with 10 to 60 bins from `lower` to `upper`; `None` if they are no numbers.
    fn of(lower: f64, upper: f64, wanted: f64) -> Option<Self> {
        let size = lower.abs().max(upper.abs());
        // Bins begin and end beside the limits: two more than their distance holds. Divided first, lest it overflow.
        let (most, fewest) = (f64::from(BINS[1] - 2), f64::from(BINS[0]));
        let least = upper / most - lower / most;
        let wanted = match (lower < upper, size > 0.0) {
            (true, _) => wanted.max(least).min(upper / fewest - lower / fewest),
            // One value: a tenth of it, to be shown with its first two digits.
            (false, true) => size / fewest,
            (false, false) => 1.0,
        };
        // Narrower bins would have both edges on the same double.
        let least = least.max(4.0 * f64::EPSILON * size).max(1e-300);
        let mut width = Self::at_most(wanted.max(least))?;
        while width.value() < least {
            width.0 += 1;
        }
        Some(width)
    }

    /// The widest at or below `limit`, which is above 0.
    fn at_most(limit: f64) -> Option<Self> {
        let power = libm::floor(libm::log10(limit));
        if !power.is_finite() {
            return None;
        }
        // One more, lest the logarithm was rounded down across a power.
        let mut width = Self(3 * (power as i32 + 1));
        while width.value() > limit {
            width.0 -= 1;
        }
        Some(width)
    }

    /// `times` this width: the double nearest to the decimal.
    fn times(self, times: i64) -> f64 {
        let digit = match self.0.rem_euclid(3) {
            0 => 1,
            1 => 2,
            _ => 5,
        };
        let decimal = format!("{}e{}", digit * i128::from(times), self.0.div_euclid(3));
        decimal.parse().unwrap_or(f64::NAN)
    }

    fn value(self) -> f64 {
        self.times(1)
    }

    /// From the last multiple at or below `lower` to the first at or above `upper`, and one bin at least.
    fn edges(self, lower: f64, upper: f64) -> Vec<f64> {
        // The quotient may be rounded across a whole number, the multiples decide.
        let mut first = libm::floor(lower / self.value()) as i64;
        if self.times(first) > lower {
            first -= 1;
        } else if self.times(first + 1) <= lower {
            first += 1;
        }
        let mut last = libm::ceil(upper / self.value()) as i64;
        if self.times(last) < upper {
            last += 1;
        } else if self.times(last - 1) >= upper {
            last -= 1;
        }
        (first..=last.max(first + 1)).map(|index| self.times(index)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Sorted;

    fn of(values: &[f64]) -> Histogram {
        Histogram::of(&Sorted::of(values)).expect("a histogram")
    }

    fn line(count: u32) -> Vec<f64> {
        (0..count).map(|index| f64::from(index) / f64::from(count - 1)).collect()
    }

    #[test]
    fn edges_are_the_doubles_that_their_decimals_read_as() {
        let histogram = of(&line(601));
        assert_eq!(histogram.edges, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        // The value 1 is in the last bin, every other edge in the bin above it.
        assert_eq!(histogram.counts, [60, 60, 60, 60, 60, 60, 60, 60, 60, 61]);
    }

    #[test]
    fn a_single_value_repeated_has_one_bin_that_holds_it() {
        for value in [0.0, 0.3, -7.25, 1000.0, 1e-310, -1e300] {
            let histogram = of(&[value; 5]);
            assert_eq!(histogram.counts, [5], "{value}");
            assert!(histogram.edges[0] <= value && value <= histogram.edges[1], "{histogram:?}");
        }
    }

    #[test]
    fn a_column_without_values_has_none() {
        assert_eq!(Histogram::of(&Sorted::default()), None);
        assert_eq!(Histogram::of(&Sorted::of(&[f64::NAN])), None);
        let sorted = Sorted::of(&[1.0, 2.0]);
        for (lower, upper) in [(2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert_eq!(Histogram::between(&sorted, lower, upper), None);
        }
    }

    #[test]
    fn values_outside_the_limits_are_counted_as_outside() {
        let sorted = Sorted::of(&[-5.0, 0.0, 0.25, 0.5, 1.0, 1.0, 7.0, 8.0]);
        let histogram = Histogram::between(&sorted, 0.0, 1.0).expect("a histogram");
        assert_eq!((histogram.below, histogram.above), (1, 2));
        assert_eq!(histogram.counts.iter().sum::<u64>(), 5);
        assert_eq!((histogram.edges.first(), histogram.edges.last()), (Some(&0.0), Some(&1.0)));
    }

    #[test]
    fn limits_without_values_between_them_still_have_bins() {
        let histogram = Histogram::between(&Sorted::of(&[9.0]), 0.0, 1.0).expect("a histogram");
        assert_eq!((histogram.counts.iter().sum::<u64>(), histogram.above), (0, 1));
    }

    #[test]
    fn values_as_far_apart_as_doubles_go_and_neighbours_have_a_histogram_or_none() {
        assert_eq!(Histogram::of(&Sorted::of(&[f64::MIN, f64::MAX])), None);
        let near = of(&[1e9, 1e9 + 1e-6]);
        assert_eq!(near.counts.iter().sum::<u64>(), 2);
        assert!(near.edges.windows(2).all(|ends| ends[0] < ends[1]), "{near:?}");
    }

    /// 0.3 / 0.1 is 2.9999999999999996: quotients of round numbers are rounded across whole numbers, both ways.
    #[test]
    fn the_outer_bins_hold_the_limits_and_no_bin_lies_beyond() {
        let sorted = Sorted::of(&line(50));
        for lower in (-30..30).map(|tenths| f64::from(tenths) / 10.0) {
            for upper in (1..40).map(|tenths| lower + f64::from(tenths) / 10.0) {
                for (lower, upper) in [
                    (lower, upper),
                    (lower.next_down(), upper.next_up()),
                    (lower.next_up(), upper.next_down()),
                ] {
                    let edges =
                        Histogram::between(&sorted, lower, upper).expect("a histogram").edges;
                    let bins = edges.len() - 1;
                    assert!(edges[0] <= lower && lower < edges[1], "{lower} {upper}: {edges:?}");
                    assert!(
                        edges[bins - 1] < upper && upper <= edges[bins],
                        "{lower} {upper}: {edges:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_column_with_a_narrow_middle_has_sixty_bins_at_most() {
        for upper in (100..1000).map(|hundredths| f64::from(hundredths) / 100.0) {
            let mut values = vec![1.0; 50];
            values.extend([-0.01, upper]);
            let bins = of(&values).counts.len();
            assert!((20..=60).contains(&bins), "{upper}: {bins}");
        }
    }

    proptest::proptest! {
        #[test]
        fn every_value_is_counted_once_in_ten_to_sixty_bins(
            values in proptest::collection::vec(-1.0..1.0f64, 2..200),
            scale in -200..200i32,
            offset in -1e3..1e3f64,
        ) {
            let scale = libm::pow(10.0, f64::from(scale));
            let values: Vec<f64> = values.iter().map(|value| (value + offset) * scale).collect();
            let histogram = of(&values);
            let bins = histogram.counts.len();
            proptest::prop_assert!((BINS[0] as usize..=BINS[1] as usize).contains(&bins), "{bins} bins");
            proptest::prop_assert_eq!(histogram.edges.len(), bins + 1);
            proptest::prop_assert!(histogram.edges.windows(2).all(|ends| ends[0] < ends[1]));
            for (index, &count) in histogram.counts.iter().enumerate() {
                let (from, to) = (histogram.edges[index], histogram.edges[index + 1]);
                let last = index + 1 == bins;
                let inside = values.iter().filter(|&&value| from <= value && (value < to || (last && value == to)));
                proptest::prop_assert_eq!(inside.count() as u64, count);
            }
            proptest::prop_assert_eq!(histogram.counts.iter().sum::<u64>(), values.len() as u64);
        }
    }
}
