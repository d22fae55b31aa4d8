//! Ranks, and the correlation of ranks: does one column rise with another, whatever the shape of the curve?

use serde::Serialize;

use super::sum::Sum;

/// How closely two columns follow each other in rank.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Correlation {
    /// Spearman's coefficient, −1 (one falls as the other rises) to 1.
    pub coefficient: f64,
    /// Interval of 95 % confidence, lower end first; `None` for fewer than four pairs, and where the coefficient is ±1 and the
    /// formula claims a certainty that it does not have.
    pub interval_95: Option<[f64; 2]>,
    /// How many pairs.
    pub pairs: usize,
}

/// Rank of each value from 1 on, in the order of the column; equal values share the mean of their ranks.
///
/// NaN ranks beyond infinity: take it out before with [`finite`](super::finite).
#[must_use]
pub fn ranks(values: &[f64]) -> Vec<f64> {
    let order = ordered(values);
    let mut ranks = vec![0.0; values.len()];
    let mut before = 0;
    for together in equal(&order) {
        let rank = before as f64 + (together.len() + 1) as f64 / 2.0;
        for &(_, index) in together {
            if let Some(place) = ranks.get_mut(index) {
                *place = rank;
            }
        }
        before += together.len();
    }
    ranks
}

/// The values in ascending order with their places in the column; equal ones in the order of the column.
pub(super) fn ordered(values: &[f64]) -> Vec<(f64, usize)> {
    // Adding zero makes the two zeros equal.
    let mut order: Vec<(f64, usize)> =
        values.iter().enumerate().map(|(index, value)| (value + 0.0, index)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order
}

/// Runs of equal values.
pub(super) fn equal(order: &[(f64, usize)]) -> impl Iterator<Item = &[(f64, usize)]> {
    order.chunk_by(|a, b| a.0.total_cmp(&b.0).is_eq())
}

/// Spearman's rank correlation of two columns of the same runs.
///
/// The coefficient is Pearson's of the mid-ranks. The interval is Fisher's with the variance of Bonett and Wright,
///
/// $$ \tanh \left( \operatorname{artanh} r \pm 1.96 \sqrt{\frac{1 + r^2 / 2}{n - 3}} \right) $$
///
/// for many independent pairs without many ties. For normal pairs it held the truth in 95 to 97 % of 10 000 samples, each of
/// 10 to 1000 pairs, up to a coefficient of 0.89; at 0.97 in 92 % (10 pairs) to 95 % (1000 pairs). Measured with
/// `oracles/make_statistics.py --simulate`.
///
/// `None` for columns of different lengths, fewer than three pairs, a constant column, and values that are not finite.
///
/// # Source
/// D. G. Bonett, T. A. Wright, *Sample size requirements for estimating Pearson, Kendall and Spearman correlations*,
/// Psychometrika 65 (2000).
#[must_use]
pub fn spearman(x: &[f64], y: &[f64]) -> Option<Correlation> {
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    if x.len() != y.len() || !finite(x) || !finite(y) {
        return None;
    }
    spearman_of_ranks(&ranks(x), &ranks(y))
}

/// The same for columns that [`ranks`] has ranked already: each column of a table needs ranking once.
#[must_use]
pub fn spearman_of_ranks(x: &[f64], y: &[f64]) -> Option<Correlation> {
    let pairs = x.len();
    if pairs != y.len() || pairs < 3 {
        return None;
    }
    // Ties or not, the ranks of n values have the mean (n + 1) / 2.
    let middle = (pairs + 1) as f64 / 2.0;
    let product = |x: &[f64], y: &[f64]| {
        x.iter().zip(y).map(|(x, y)| (x - middle) * (y - middle)).collect::<Sum>().value()
    };
    let scale = (product(x, x) * product(y, y)).sqrt();
    if !(scale > 0.0) {
        return None;
    }
    let coefficient = (product(x, y) / scale).clamp(-1.0, 1.0);
    Some(Correlation { coefficient, interval_95: interval_95(coefficient, pairs), pairs })
}

fn interval_95(coefficient: f64, pairs: usize) -> Option<[f64; 2]> {
    let free = pairs.checked_sub(3).filter(|&free| free > 0)? as f64;
    let middle = libm::atanh(coefficient);
    let half = NORMAL_975 * ((1.0 + coefficient * coefficient / 2.0) / free).sqrt();
    middle.is_finite().then(|| [libm::tanh(middle - half), libm::tanh(middle + half)])
}

/// Quantile 0.975 of the standard normal distribution.
const NORMAL_975: f64 = 1.959_963_984_540_054;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share_the_mean_of_their_ranks() {
        assert_eq!(ranks(&[30.0, 10.0, 20.0, 10.0]), [4.0, 1.5, 3.0, 1.5]);
        assert_eq!(ranks(&[5.0; 4]), [2.5; 4]);
        assert_eq!(ranks(&[0.0, -0.0, -1.0]), [2.5, 2.5, 1.0]);
        assert!(ranks(&[]).is_empty());
    }

    #[test]
    fn a_curve_that_rises_has_one_and_one_that_falls_minus_one() {
        let x: Vec<f64> = (0..50).map(f64::from).collect();
        let rising: Vec<f64> = x.iter().map(|x| x * x * x).collect();
        let falling: Vec<f64> = x.iter().map(|x| 1.0 / (1.0 + x)).collect();
        for (y, expected) in [(rising, 1.0), (falling, -1.0)] {
            let found = spearman(&x, &y).expect("a correlation");
            assert_eq!((found.coefficient, found.interval_95, found.pairs), (expected, None, 50));
        }
    }

    /// The example of ci.spear in R's statpsych, by the first of the two authors: 0.8699639, 0.5840951 to 0.9638297.
    #[test]
    fn the_authors_own_example_comes_out() {
        let y = [21., 4., 9., 12., 35., 18., 10., 22., 24., 1., 6., 8., 13., 16., 19.];
        let x = [67., 28., 30., 28., 52., 40., 25., 37., 44., 10., 14., 20., 28., 40., 51.];
        let found = spearman(&x, &y).expect("a correlation");
        let [low, high] = found.interval_95.expect("an interval");
        for (found, printed) in
            [(found.coefficient, 0.8699639), (low, 0.5840951), (high, 0.9638297)]
        {
            assert!((found - printed).abs() < 0.5e-7, "{found} {printed}");
        }
    }

    #[test]
    fn columns_that_say_nothing_have_no_correlation() {
        let x = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(spearman(&x, &[7.0; 4]), None);
        assert_eq!(spearman(&x, &x[..3]), None);
        assert_eq!(spearman(&x[..2], &x[..2]), None);
        assert_eq!(spearman(&x, &[1.0, f64::NAN, 2.0, 3.0]), None);
        assert_eq!(spearman(&[], &[]), None);
    }

    #[test]
    fn three_pairs_have_a_coefficient_but_no_interval() {
        let found = spearman(&[1.0, 2.0, 3.0], &[1.0, 3.0, 2.0]).expect("a correlation");
        assert_eq!((found.coefficient, found.interval_95), (0.5, None));
    }
}
