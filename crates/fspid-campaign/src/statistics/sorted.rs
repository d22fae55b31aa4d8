//! A column in ascending order.

/// The finite values of a column in ascending order: what quantiles and histograms are read from.
///
/// Sorting costs O(n log n) once; every question after that is cheap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sorted {
    values: Vec<f64>,
    left_out: usize,
}

impl Sorted {
    /// A sorted copy of the finite values; [`From<Vec<f64>>`](#impl-From%3CVec%3Cf64%3E%3E-for-Sorted) sorts in place.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        values.to_vec().into()
    }

    /// The values in ascending order, all finite.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// How many values were NaN or infinite and are left out.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }
}

impl From<Vec<f64>> for Sorted {
    fn from(mut values: Vec<f64>) -> Self {
        let all = values.len();
        values.retain(|value| value.is_finite());
        values.sort_unstable_by(f64::total_cmp);
        let left_out = all - values.len();
        Self { values, left_out }
    }
}

#[cfg(test)]
mod tests {
    use super::Sorted;

    #[test]
    fn values_come_in_order_and_the_others_are_counted() {
        let sorted = Sorted::of(&[3.0, f64::NAN, -1.0, f64::INFINITY, 2.0]);
        assert_eq!((sorted.values(), sorted.left_out()), ([-1.0, 2.0, 3.0].as_slice(), 2));
    }
}
