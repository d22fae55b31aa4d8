//! A column of any length in little memory: counts on a fixed grid of numbers, from which every quantile is known within bounds.

use std::collections::BTreeMap;

use super::exact::ExactSums;
use super::{Moments, Ordered};

/// Bits of a double that name a bin: its sign, its exponent of 11 bits and the first 11 bits of its mantissa.
const BIN_BITS: u32 = 23;
/// Bits that name a bin within its page.
const PAGE_BITS: u32 = 7;
/// Bins of a page: a sixteenth of a power of two.
const PAGE: usize = 1 << PAGE_BITS;

/// Most that two values of a bin differ, as a part of the smaller one: 2⁻¹¹, or 0.05 %.
pub const RELATIVE_WIDTH: f64 = 1.0 / 2048.0;

/// Counts of finite values on a grid that is the same for every column: each power of two in 2048 bins of equal width,
/// below and above 0, and 0 in a bin of its own with the smallest positive ones. Each bin knows its least and greatest value.
///
/// Counts are whole numbers, least and greatest do not depend on an order, and moments come from exact sums: **merging is
/// associative and commutative in every bit**. A quantile lies between the least and the greatest value of one bin, which
/// differ by at most [`RELATIVE_WIDTH`] of the value, for every distribution; the first and the last value of each bin,
/// and thus a value that is repeated, are exact. There is no chance in it.
///
/// Memory: 3 kB for each sixteenth of a power of two that has values, 200 MB if all doubles occur.
///
/// # Source
/// The idea of a fixed grid with a bounded relative error is that of C. Masson, J. E. Rim, H. K. Lee, *DDSketch: a fast and
/// fully-mergeable quantile sketch with relative-error guarantees*, VLDB Endowment 12 (2019); linear bins within powers of
/// two need no logarithm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sketch {
    pages: BTreeMap<u16, Box<[Bin; PAGE]>>,
    sums: ExactSums,
}

/// How many values lie in a piece of the grid, and between which.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bin {
    count: u64,
    least: f64,
    most: f64,
}

const EMPTY: Bin = Bin { count: 0, least: f64::INFINITY, most: f64::NEG_INFINITY };

impl Bin {
    fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.least = if other.least < self.least { other.least } else { self.least };
        self.most = if other.most > self.most { other.most } else { self.most };
    }
}

/// The bin of a value; higher values have higher bins.
fn bin(value: f64) -> u32 {
    let bits = value.to_bits();
    // Doubles are ordered as their bits are, negative ones backwards.
    let ordered = if bits >> 63 == 1 { !bits } else { bits | 1 << 63 };
    (ordered >> (u64::BITS - BIN_BITS)) as u32
}

impl Sketch {
    /// Adds a value; one that is not finite is not added.
    pub fn add(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        // The two zeros are one value.
        let value = value + 0.0;
        let bin = bin(value);
        let page =
            self.pages.entry((bin >> PAGE_BITS) as u16).or_insert_with(|| Box::new([EMPTY; PAGE]));
        if let Some(bin) = page.get_mut(bin as usize % PAGE) {
            bin.merge(Bin { count: 1, least: value, most: value });
        }
        self.sums.add(value);
    }

    /// Adds what another one was given.
    pub fn merge(&mut self, other: &Self) {
        for (number, theirs) in &other.pages {
            let page = self.pages.entry(*number).or_insert_with(|| Box::new([EMPTY; PAGE]));
            page.iter_mut().zip(theirs.iter()).for_each(|(mine, theirs)| mine.merge(*theirs));
        }
        self.sums.merge(&other.sums);
    }

    /// The values in ascending order, as far as they are known.
    #[must_use]
    pub fn ranks(&self) -> Ranks {
        let mut ranks = Ranks::default();
        for bin in self.pages.values().flat_map(|page| page.iter()).filter(|bin| bin.count > 0) {
            ranks.firsts.push(ranks.count);
            ranks.bins.push(*bin);
            ranks.count += bin.count;
        }
        ranks
    }

    /// Mean, spread and extremes, rounded once from exact sums; `None` without values, and where the spread overflows.
    #[must_use]
    pub fn moments(&self) -> Option<Moments> {
        let mut bins = self.pages.values().flat_map(|page| page.iter()).filter(|bin| bin.count > 0);
        let mut whole = *bins.next()?;
        bins.for_each(|bin| whole.merge(*bin));
        let found = self.sums.mean_and_deviation()?;
        Some(Moments {
            count: usize::try_from(whole.count).ok()?,
            mean: found.mean,
            standard_deviation: found.deviation,
            standard_error: found
                .deviation
                .map(|deviation| deviation / (whole.count as f64).sqrt()),
            minimum: whole.least,
            maximum: whole.most,
        })
    }
}

/// The bins of a [`Sketch`] with the ranks of their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranks {
    bins: Vec<Bin>,
    /// Rank of the least value of each bin, from 0.
    firsts: Vec<u64>,
    count: u64,
}

impl Ranks {
    /// The bin that holds the value at a rank, and the rank within it.
    fn bin(&self, rank: u64) -> Option<(Bin, u64)> {
        let index = self.firsts.partition_point(|first| *first <= rank).checked_sub(1)?;
        let (bin, first) = (self.bins.get(index)?, self.firsts.get(index)?);
        (rank < self.count).then_some((*bin, rank - first))
    }

    /// How far the rank of [`at`](Ordered::at) may be from `rank`, in values: 0 where it is exact.
    #[must_use]
    pub fn rank_error(&self, rank: usize) -> u64 {
        match self.bin(rank as u64) {
            Some((bin, place)) if bin.least < bin.most && place > 0 => {
                let behind = bin.count - 1 - place;
                // The last value of a bin is known.
                if behind == 0 { 0 } else { place.max(behind) }
            }
            _ => 0,
        }
    }
}

impl Ordered for Ranks {
    fn count(&self) -> usize {
        self.count as usize
    }

    /// Values of a bin are taken to be evenly spread.
    fn at(&self, place: usize) -> Option<f64> {
        let (bin, place) = self.bin(place as u64)?;
        if place == 0 {
            return Some(bin.least);
        }
        let along = place as f64 / (bin.count - 1) as f64;
        Some((bin.least + along * (bin.most - bin.least)).clamp(bin.least, bin.most))
    }

    fn bounds(&self, place: usize) -> Option<[f64; 2]> {
        let (bin, place) = self.bin(place as u64)?;
        Some(match place {
            0 => [bin.least; 2],
            place if place + 1 == bin.count => [bin.most; 2],
            _ => [bin.least, bin.most],
        })
    }

    fn below(&self, edge: f64, or_equal: bool) -> usize {
        let is_below = |value: f64| value < edge || (or_equal && value <= edge);
        let index = self.bins.partition_point(|bin| is_below(bin.most));
        let whole = self.firsts.get(index).map_or(self.count, |first| *first);
        let of_bin = self.bins.get(index).filter(|bin| is_below(bin.least)).map_or(0, |bin| {
            // The edge cuts the bin: at least its first value is below, its last one is not.
            let along = (edge - bin.least) / (bin.most - bin.least);
            ((along * bin.count as f64) as u64).clamp(1, bin.count - 1)
        });
        (whole + of_bin) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{Histogram, Sorted, quantile::quantile};
    use proptest::prelude::*;

    const SHARES: [f64; 9] = [0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0];

    fn sketch(values: &[f64]) -> Sketch {
        let mut sketch = Sketch::default();
        values.iter().for_each(|value| sketch.add(*value));
        sketch
    }

    /// Every promise, against the sorted values.
    fn check(values: &[f64]) {
        let (sorted, ranks) = (Sorted::of(values), sketch(values).ranks());
        assert_eq!(ranks.count(), sorted.count());
        for (place, &value) in sorted.values().iter().enumerate() {
            let [lower, upper] = ranks.bounds(place).expect("a place");
            let guess = ranks.at(place).expect("a place");
            assert!(lower <= value && value <= upper, "{value} not in {lower} to {upper}");
            assert!(lower <= guess && guess <= upper, "{guess} not in {lower} to {upper}");
            let (least, most) = (lower.abs().min(upper.abs()), lower.abs().max(upper.abs()));
            // Below the normal numbers the grid is as fine as it can be without being relative.
            assert!(
                most - least <= least * RELATIVE_WIDTH || most < f64::MIN_POSITIVE,
                "{lower} {upper}"
            );
            assert!(lower.is_sign_negative() == upper.is_sign_negative());
            // As many values as the error of the rank lie between the guess and the value, and no more.
            let error = ranks.rank_error(place);
            let (below, up_to) = (sorted.below(guess, false), sorted.below(guess, true));
            let off = below.saturating_sub(place).max((place + 1).saturating_sub(up_to.max(1)));
            assert!(off as u64 <= error, "{place} of {}: off by {off}, said {error}", values.len());
        }
        for share in SHARES {
            let (guess, exact) = (quantile(&ranks, share), quantile(&sorted, share));
            let (Some(guess), Some(exact)) = (guess, exact) else {
                continue;
            };
            let size = guess.abs().max(exact.abs());
            assert!(
                (guess - exact).abs() <= 3.0 * RELATIVE_WIDTH * size.max(1e-300),
                "{share}: {guess} {exact}"
            );
        }
    }

    #[test]
    fn columns_that_are_hostile_to_sketches_are_within_the_bounds() {
        let spread = |run: i32| f64::from(run * 7919 % 1009) / 1009.0;
        check(&vec![14.99; 5000]);
        check(&[]);
        check(&[0.0, -0.0, 1e-320, -1e-320, f64::MAX, f64::MIN, f64::MIN_POSITIVE]);
        let bimodal: Vec<f64> = (0..4000)
            .map(|run| if run % 2 == 0 { 1.0 + spread(run) } else { 1e12 + spread(run) })
            .collect();
        check(&bimodal);
        check(&(0..4000).map(|run| -1e-3 - spread(run)).collect::<Vec<_>>());
        check(&(0..4000).map(|run| spread(run) - 0.5).collect::<Vec<_>>());
        // All of them in one bin, where ranks are worst.
        check(&(0..4000).map(|run| 1.0 + spread(run) * 1e-5).collect::<Vec<_>>());
    }

    #[test]
    fn a_value_that_is_repeated_is_exact_however_many_share_its_bin() {
        let sketch = sketch(&vec![0.3; 1_000]);
        assert_eq!(quantile(&sketch.ranks(), 0.5), Some(0.3));
        assert_eq!(sketch.ranks().rank_error(500), 0);
        assert_eq!(sketch.moments().and_then(|it| it.standard_deviation), Some(0.0));
    }

    #[test]
    fn a_histogram_counts_every_value_and_few_of_them_beside_their_bar() {
        let values: Vec<f64> =
            (0..100_000).map(|run| f64::from(run * 7919 % 100_003) / 1e4).collect();
        let (sorted, ranks) = (Sorted::of(&values), sketch(&values).ranks());
        let (exact, near) = (Histogram::of(&sorted), Histogram::of(&ranks));
        let (exact, near) = (exact.expect("a histogram"), near.expect("a histogram"));
        assert_eq!(exact.edges, near.edges);
        assert_eq!(near.counts.iter().sum::<u64>(), 100_000);
        for (one, other) in exact.counts.iter().zip(&near.counts) {
            // The bin that an edge cuts holds a few dozen.
            assert!(one.abs_diff(*other) < 60, "{exact:?} {near:?}");
        }
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        assert_eq!(sketch(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY]), Sketch::default());
        assert_eq!(Sketch::default().moments(), None);
        assert_eq!(Sketch::default().ranks().at(0), None);
    }

    proptest! {
        #[test]
        fn every_order_statistic_lies_in_its_bounds(
            values in prop::collection::vec(prop_oneof![any::<f64>(), -10.0..10.0, Just(2.5), 1e11..1e12, 1.0..1.001], 1..300)
        ) {
            check(&values.into_iter().filter(|value| value.is_finite()).collect::<Vec<_>>());
        }

        #[test]
        fn pieces_in_any_order_make_the_same_sketch(
            values in prop::collection::vec(prop_oneof![any::<f64>(), -1.0..1.0], 1..200),
            pieces in 1usize..8,
        ) {
            let size = values.len().div_ceil(pieces);
            let mut merged = Sketch::default();
            for piece in values.chunks(size).rev() {
                merged.merge(&sketch(piece));
            }
            let whole = sketch(&values);
            prop_assert_eq!(&merged.pages, &whole.pages);
            prop_assert_eq!(merged.moments(), whole.moments());
        }
    }
}
