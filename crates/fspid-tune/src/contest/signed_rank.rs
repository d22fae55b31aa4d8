//! The test of Wilcoxon on paired differences, and the interval of Hodges and Lehmann that belongs to it.

use fspid_scenario::dispersion::standard_normal::{above, quantile};

/// Most differences whose distribution is counted out; with more it is nearly normal.
const MOST_EXACT: usize = 200;

/// What paired differences say without a distribution of theirs being assumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedRank {
    /// Two-sided p-value of "they lie evenly about 0".
    pub p: f64,
    /// The median of the means of all pairs of differences.
    pub estimate: f64,
    /// Lower end of its interval; infinite where so few differences bound nothing.
    pub lower: f64,
    /// Upper end of its interval.
    pub upper: f64,
}

impl SignedRank {
    /// Of differences, of which infinite ones are the largest; `None` where there are none, or a NaN.
    ///
    /// The p-value is exact, given the ranks: equal sizes share their mean rank, and differences of 0 are ranked and
    /// then left out (Pratt). The interval is that without ties, which is as wide or wider. An infinite difference and
    /// its opposite have the mean 0.
    ///
    /// # Source
    /// J. W. Pratt, *Remarks on zeros and ties in the Wilcoxon signed rank procedures*, JASA 54 (1959); M. Hollander,
    /// D. A. Wolfe, E. Chicken, *Nonparametric Statistical Methods*, 3rd ed. (2014), 3.1 to 3.3.
    #[must_use]
    pub fn of(differences: &[f64], confidence: f64) -> Option<Self> {
        if differences.is_empty() || differences.iter().any(|value| value.is_nan()) {
            return None;
        }
        let means = pair_means(differences);
        let estimate = median(&means);
        let (lower, upper) = match outermost(differences.len(), 1.0 - confidence) {
            0 => (f64::NEG_INFINITY, f64::INFINITY),
            rank => (means[rank - 1], means[means.len() - rank]),
        };
        Some(Self { p: p_value(differences), estimate, lower, upper })
    }
}

/// Means of all pairs, each with itself too, ascending.
fn pair_means(values: &[f64]) -> Vec<f64> {
    let mut means = Vec::with_capacity(values.len() * (values.len() + 1) / 2);
    for (index, a) in values.iter().enumerate() {
        means.extend(values[index..].iter().map(|b| mean(*a, *b)));
    }
    means.sort_by(f64::total_cmp);
    means
}

fn mean(a: f64, b: f64) -> f64 {
    let mean = 0.5 * a + 0.5 * b;
    // Infinity and its opposite; no difference is NaN.
    if mean.is_nan() { 0.0 } else { mean }
}

fn median(sorted: &[f64]) -> f64 {
    let half = sorted.len() / 2;
    match sorted.len() % 2 {
        1 => sorted[half],
        _ => mean(sorted[half - 1], sorted[half]),
    }
}

/// Which of the ordered means is the lower end, from 1; 0 where none is.
fn outermost(count: usize, doubt: f64) -> usize {
    if count > MOST_EXACT {
        let n = count as f64;
        let spread = (n * (n + 1.0) * (2.0 * n + 1.0) / 24.0).sqrt();
        let rank = n * (n + 1.0) / 4.0 + quantile(0.5 * doubt) * spread;
        return rank.max(0.0) as usize;
    }
    let ranks: Vec<usize> = (1..=count).collect();
    let chances = chances(&ranks);
    let (mut below, mut rank) = (0.0, 0);
    for chance in chances {
        below += chance;
        // Rounding must not decide where a tail is exactly what is allowed.
        if below > doubt / 2.0 * (1.0 + 1e-12) {
            break;
        }
        rank += 1;
    }
    rank
}

/// Chance of each sum of ranks where each rank counts or not with one half.
fn chances(ranks: &[usize]) -> Vec<f64> {
    let mut chances = vec![0.0; ranks.iter().sum::<usize>() + 1];
    chances[0] = 1.0;
    let mut most = 0;
    for &rank in ranks {
        most += rank;
        for sum in (0..=most).rev() {
            let without = 0.5 * chances[sum];
            let with = if sum >= rank { 0.5 * chances[sum - rank] } else { 0.0 };
            chances[sum] = without + with;
        }
    }
    chances
}

fn p_value(differences: &[f64]) -> f64 {
    let doubled = doubled_ranks(differences);
    let counted = || differences.iter().zip(&doubled).filter(|(value, _)| **value != 0.0);
    let found: usize = counted().filter(|(value, _)| **value > 0.0).map(|(_, rank)| rank).sum();
    let ranks: Vec<usize> = counted().map(|(_, rank)| *rank).collect();
    let whole: usize = ranks.iter().sum();
    if whole == 0 {
        return 1.0;
    }
    let smaller = found.min(whole - found);
    if ranks.len() > MOST_EXACT {
        let spread = ranks.iter().map(|rank| (*rank * *rank) as f64).sum::<f64>().sqrt() / 2.0;
        // Half a rank of continuity, in doubled ranks.
        let distance = (whole as f64 / 2.0 - smaller as f64 - 1.0).max(0.0);
        return 2.0 * above(distance / spread);
    }
    let tail: f64 = chances(&ranks).iter().take(smaller + 1).sum();
    (2.0 * tail).min(1.0)
}

/// Twice the rank of the size of each difference, so that shared ranks are whole.
fn doubled_ranks(differences: &[f64]) -> Vec<usize> {
    let size = |index: usize| differences[index].abs();
    let mut order: Vec<usize> = (0..differences.len()).collect();
    order.sort_by(|&a, &b| size(a).total_cmp(&size(b)));
    let mut ranks = vec![0; differences.len()];
    let mut first = 0;
    while first < order.len() {
        let is_alike = |it: &&usize| size(**it).total_cmp(&size(order[first])).is_eq();
        let alike = order[first..].iter().take_while(is_alike).count();
        for &index in &order[first..first + alike] {
            ranks[index] = 2 * first + alike + 1;
        }
        first += alike;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_nothing_are_no_difference() {
        let found = SignedRank::of(&[0.0; 6], 0.95);
        let none = SignedRank { p: 1.0, estimate: 0.0, lower: 0.0, upper: 0.0 };
        assert_eq!(found, Some(none));
        assert_eq!(SignedRank::of(&[], 0.95), None);
        assert_eq!(SignedRank::of(&[1.0, f64::NAN], 0.95), None);
    }

    #[test]
    fn six_differences_of_one_sign_are_the_fewest_that_are_significant() {
        let of = |count: u32| {
            let all: Vec<f64> = (1..=count).map(f64::from).collect();
            SignedRank::of(&all, 0.95).expect("differences")
        };
        assert_eq!(of(5).p, 0.0625);
        assert_eq!(of(5).lower, f64::NEG_INFINITY);
        assert_eq!(of(6).p, 0.03125);
        assert_eq!((of(6).lower, of(6).upper), (1.0, 6.0));
    }

    #[test]
    fn a_lost_case_ranks_beyond_every_other() {
        let found = SignedRank::of(&[-1.0, -2.0, f64::INFINITY, -3.0], 0.5).expect("differences");
        // Sum of the ranks above 0 is 4 of 10: P(at most 4) = 7 / 16.
        assert_eq!(found.p, 0.875);
        assert_eq!(found.upper, f64::INFINITY);
        assert!(found.estimate.is_finite());
    }

    /// Rank of the lower end, counted out.
    fn counted(count: usize, doubt: f64) -> usize {
        let ranks: Vec<usize> = (1..=count).collect();
        let sums = chances(&ranks).into_iter().scan(0.0, |below, chance| {
            *below += chance;
            Some(*below)
        });
        sums.take_while(|below| *below <= doubt / 2.0).count()
    }

    #[test]
    fn where_counting_would_be_long_the_interval_ends_where_the_counted_one_does_or_a_little_wider()
    {
        for (count, doubt, most) in [(201, 0.05, 2), (250, 0.05, 2), (400, 0.2, 2), (250, 0.01, 8)]
        {
            let [found, expected] = [outermost(count, doubt), counted(count, doubt)];
            assert!(found.abs_diff(expected) <= most, "{count} {doubt}: {found} {expected}");
        }
        // Of a small doubt it is the wider one.
        assert!(outermost(250, 0.01) < counted(250, 0.01));
        // Up to there it is counted.
        assert_eq!(outermost(MOST_EXACT, 0.05), counted(MOST_EXACT, 0.05));
    }

    #[test]
    fn a_tail_of_just_what_is_allowed_belongs_to_the_doubt() {
        // Five differences: the one sum of no ranks has a chance of 1/32.
        assert_eq!((outermost(5, 1.0 / 16.0), outermost(5, 0.9 / 16.0)), (1, 0));
    }

    #[test]
    fn two_hundred_differences_are_still_counted() {
        let differences: Vec<f64> = (1..=200)
            .map(|size: i32| f64::from(if size % 3 == 0 { -size } else { size }))
            .collect();
        let negative: usize = (1..=200).filter(|size| size % 3 == 0).sum();
        let ranks: Vec<usize> = (1..=200).collect();
        let tail: f64 = chances(&ranks).iter().take(negative + 1).sum();
        let p = p_value(&differences);
        assert!((p - 2.0 * tail).abs() < 1e-12 * p, "{p} {tail}");
    }
}
