//! The largest and smallest of many numbers.
//!
//! Eight running extremes side by side, which do not wait for each other and become vectors: the order of
//! comparing does not change which number is the largest. NaN is passed over.

const SIDE_BY_SIDE: usize = 8;

/// What remains of all values, by a function of two that may be called in any order.
pub(super) fn extreme(values: &[f64], start: f64, of_two: impl Fn(f64, f64) -> f64) -> f64 {
    let (rows, rest) = values.as_chunks::<SIDE_BY_SIDE>();
    let mut found = [start; SIDE_BY_SIDE];
    for row in rows {
        for (found, value) in found.iter_mut().zip(row) {
            *found = of_two(*found, *value);
        }
    }
    found.into_iter().chain(rest.iter().copied()).fold(start, of_two)
}

/// The largest of a function of two columns, from 0 on; as far as the shorter one goes.
pub(super) fn largest_of_both(left: &[f64], right: &[f64], value: impl Fn(f64, f64) -> f64) -> f64 {
    let (left_rows, left_rest) = left.as_chunks::<SIDE_BY_SIDE>();
    let (right_rows, right_rest) = right.as_chunks::<SIDE_BY_SIDE>();
    if left_rest.len() != right_rest.len() || left_rows.len() != right_rows.len() {
        let rows = left.len().min(right.len());
        return largest_of_both(
            left.get(..rows).unwrap_or_default(),
            right.get(..rows).unwrap_or_default(),
            value,
        );
    }
    let mut found = [0.0; SIDE_BY_SIDE];
    for (left, right) in left_rows.iter().zip(right_rows) {
        for (found, (left, right)) in found.iter_mut().zip(left.iter().zip(right)) {
            *found = f64::max(*found, value(*left, *right));
        }
    }
    let rest = left_rest.iter().zip(right_rest).map(|(left, right)| value(*left, *right));
    found.into_iter().chain(rest).fold(0.0, f64::max)
}

/// True if no value is NaN or infinite.
pub(super) fn all_finite(values: &[f64]) -> bool {
    // Without an early end, so that it becomes vectors.
    values.iter().fold(true, |all, value| all & value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(count: usize) -> Vec<f64> {
        (0..count).map(|n| (n as f64 * 0.618).fract() - 0.5).collect()
    }

    #[test]
    fn extremes_are_those_of_one_comparison_after_the_other() {
        for count in 0..40 {
            let values = values(count);
            let plain = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(extreme(&values, f64::NEG_INFINITY, f64::max).to_bits(), plain.to_bits());
            let plain = values.iter().copied().fold(f64::INFINITY, f64::min);
            assert_eq!(extreme(&values, f64::INFINITY, f64::min).to_bits(), plain.to_bits());
            let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let after = values.get(1..).unwrap_or_default();
            let largest = largest_of_both(&values, after, |before, after| (after - before).abs());
            assert_eq!(largest.to_bits(), changes.fold(0.0, f64::max).to_bits(), "{count}");
        }
    }

    #[test]
    fn a_nan_is_passed_over_by_extremes_and_found_by_the_check() {
        let mut values = values(19);
        for place in 0..19 {
            let good = std::mem::replace(&mut values[place], f64::NAN);
            assert!(extreme(&values, f64::NEG_INFINITY, f64::max).is_finite());
            assert!(!all_finite(&values));
            values[place] = good;
        }
        assert!(all_finite(&values));
    }
}
