//! Sets NaN and infinities apart and counts them.

use std::borrow::Cow;

/// The finite values of a column, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Finite<'a> {
    /// The finite values; the column itself where all are.
    pub values: Cow<'a, [f64]>,
    /// How many were NaN or infinite.
    pub left_out: usize,
}

/// The finite values of two columns of the same runs, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct FinitePairs<'a> {
    /// From the first column, in the runs where both are finite.
    pub x: Cow<'a, [f64]>,
    /// From the second column, in the same runs.
    pub y: Cow<'a, [f64]>,
    /// How many runs had a NaN or an infinity in either.
    pub left_out: usize,
}

/// The finite values, and how many others there were; copies only where there are others.
#[must_use]
pub fn finite(values: &[f64]) -> Finite<'_> {
    let left_out = values.iter().filter(|value| !value.is_finite()).count();
    let values = match left_out {
        0 => Cow::Borrowed(values),
        _ => values.iter().copied().filter(|value| value.is_finite()).collect(),
    };
    Finite { values, left_out }
}

/// The pairs of which both values are finite, and how many others there were; `None` if the columns differ in length.
#[must_use]
pub fn finite_pairs<'a>(x: &'a [f64], y: &'a [f64]) -> Option<FinitePairs<'a>> {
    if x.len() != y.len() {
        return None;
    }
    let both = |&(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
    let pairs = || x.iter().copied().zip(y.iter().copied());
    let left_out = pairs().filter(|pair| !both(pair)).count();
    if left_out == 0 {
        return Some(FinitePairs { x: Cow::Borrowed(x), y: Cow::Borrowed(y), left_out });
    }
    let (x, y): (Vec<f64>, Vec<f64>) = pairs().filter(both).unzip();
    Some(FinitePairs { x: x.into(), y: y.into(), left_out })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOLED: [f64; 5] = [1.0, f64::NAN, 3.0, f64::INFINITY, 5.0];

    #[test]
    fn a_column_without_holes_is_not_copied() {
        let column = [1.0, 2.0];
        assert!(matches!(finite(&column).values, Cow::Borrowed(_)));
        let pairs = finite_pairs(&column, &column).expect("the same length");
        assert!(matches!((pairs.x, pairs.y), (Cow::Borrowed(_), Cow::Borrowed(_))));
    }

    #[test]
    fn nan_and_infinity_are_left_out_and_counted() {
        let found = finite(&HOLED);
        assert_eq!((found.values.as_ref(), found.left_out), ([1.0, 3.0, 5.0].as_slice(), 2));
    }

    #[test]
    fn a_pair_goes_when_either_of_its_values_is_missing() {
        let found = finite_pairs(&HOLED, &[f64::NEG_INFINITY, 2.0, 30.0, 4.0, 50.0])
            .expect("the same length");
        assert_eq!(
            (found.x.as_ref(), found.y.as_ref()),
            ([3.0, 5.0].as_slice(), [30.0, 50.0].as_slice())
        );
        assert_eq!(found.left_out, 3);
    }

    #[test]
    fn columns_of_different_lengths_are_no_pairs() {
        assert_eq!(finite_pairs(&HOLED, &[1.0]), None);
    }
}
