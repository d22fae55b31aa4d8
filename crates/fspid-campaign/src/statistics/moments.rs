//! Mean and spread of a column.

use super::sum::Sum;

/// Mean, spread and extremes of a column, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// How many values.
    pub count: usize,
    /// Arithmetic mean.
    ///
    /// $$ \bar x = \frac{1}{n} \sum x_i $$
    pub mean: f64,
    /// Standard deviation of the population that the values are drawn from; `None` for a single value.
    ///
    /// $$ s = \sqrt{\frac{1}{n - 1} \sum (x_i - \bar x)^2} $$
    pub standard_deviation: Option<f64>,
    /// Standard error of the mean, for independent values; `None` for a single value.
    ///
    /// $$ s / \sqrt{n} $$
    pub standard_error: Option<f64>,
    /// Least value.
    pub minimum: f64,
    /// Greatest value.
    pub maximum: f64,
}

impl Moments {
    /// Of a column; `None` if it is empty, holds NaN or infinity, or values whose squares overflow.
    ///
    /// Two passes over the column with compensated sums: the deviations are taken from the mean itself, so that a large
    /// mean does not drown a small spread, as it can in one pass. What the rounding of the mean leaves is taken off.
    ///
    /// # Source
    /// T. F. Chan, G. H. Golub, R. J. LeVeque, *Algorithms for computing the sample variance*, The American Statistician
    /// 37 (1983): the corrected two-pass algorithm.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let (minimum, maximum) = extremes(values)?;
        let count = values.len();
        let n = count as f64;
        // Rounding may put the mean of equal values beside them.
        let mean = (values.iter().copied().collect::<Sum>().value() / n).clamp(minimum, maximum);
        let (mut deviations, mut squares) = (Sum::default(), Sum::default());
        for value in values {
            let deviation = value - mean;
            deviations.add(deviation);
            squares.add(deviation * deviation);
        }
        let rest = deviations.value();
        let sum_of_squares = (squares.value() - rest * rest / n).max(0.0);
        if !(mean.is_finite() && squares.value().is_finite()) {
            return None;
        }
        let standard_deviation = (count > 1).then(|| (sum_of_squares / (n - 1.0)).sqrt());
        let standard_error = standard_deviation.map(|deviation| deviation / n.sqrt());
        Some(Self { count, mean, standard_deviation, standard_error, minimum, maximum })
    }
}

/// Least and greatest of finite values.
fn extremes(values: &[f64]) -> Option<(f64, f64)> {
    let first = *values.first()?;
    let (mut minimum, mut maximum) = (first, first);
    for &value in values {
        if !value.is_finite() {
            return None;
        }
        // Not `min` and `max`: of the two zeros they may give either.
        minimum = if value < minimum { value } else { minimum };
        maximum = if value > maximum { value } else { maximum };
    }
    Some((minimum, maximum))
}

#[cfg(test)]
mod tests {
    use super::Moments;

    #[test]
    fn a_single_value_has_a_mean_and_no_spread() {
        let moments = Moments::of(&[4.0]).expect("a value");
        assert_eq!((moments.mean, moments.minimum, moments.maximum), (4.0, 4.0, 4.0));
        assert_eq!((moments.standard_deviation, moments.standard_error), (None, None));
    }

    #[test]
    fn equal_values_have_no_spread_at_all() {
        for count in 2..1000 {
            let moments = Moments::of(&vec![0.1; count]).expect("values");
            assert_eq!((moments.mean, moments.standard_deviation), (0.1, Some(0.0)), "{count}");
        }
    }

    /// At 10¹⁶ doubles are 2 apart: the mean of these two is not one of them.
    #[test]
    fn a_mean_that_had_to_be_rounded_does_not_widen_the_spread() {
        let moments = Moments::of(&[1e16, 1e16 + 2.0]).expect("values");
        assert_eq!(moments.standard_deviation, Some(2f64.sqrt()));
    }

    /// 1e9 + (4, 7, 13, 16): mean 10 above 1e9, variance 30. One pass over the squares in doubles gives a variance of 0 or less.
    #[test]
    fn a_large_mean_does_not_drown_the_spread() {
        let moments = Moments::of(&[1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0]).expect("values");
        assert_eq!(moments.mean, 1e9 + 10.0);
        assert_eq!(moments.standard_deviation, Some(30f64.sqrt()));
        assert_eq!(moments.standard_error, Some(30f64.sqrt() / 2.0));
    }

    #[test]
    fn what_is_not_finite_or_not_there_has_no_moments() {
        for values in
            [&[][..], &[1.0, f64::NAN], &[f64::INFINITY], &[1e200, -1e200], &[f64::MAX, f64::MAX]]
        {
            assert_eq!(Moments::of(values), None, "{values:?}");
        }
    }
}
