//! Products of matrices of intervals, by middle and radius.
//!
//! The middle of the product is the product of the middles with twice the working precision, so that
//! it is off by the last rounding only. With $|A - A_m| \le A_r$ and $|B - B_m| \le B_r$,
//!
//! $$ |A B - A_m B_m| \le |A_m| B_r + A_r (|B_m| + B_r) $$
//!
//! # What the doubled precision leaves
//! A sum of n products is split without error into $p + \sum_i (q_i + r_i)$: p the running sum, $r_i$
//! the part of a product that p does not take, $q_i$ what its sum loses. Let u be 2⁻⁵³, T the sum of
//! the absolute products and $\gamma = n u / (1 - n u)$. Then $\sum |r_i| \le u T$ and, as every
//! running sum is below $(1 + \gamma) T$, $\sum |q_i| \le n u (1 + \gamma) T$. Adding them up in
//! plain arithmetic is off by at most γ times their sum: by less than $(n + 2)^2 u^2 T$, of which
//! twice is taken. What the very last sum $p + s$ loses is known and taken as it is.
//!
//! Nothing of this holds where a product leaves the range of floats. Matrices with such entries are
//! multiplied entry by entry in plain intervals.
//!
//! # Source
//! T. Ogita, S. M. Rump and S. Oishi, *Accurate sum and dot product*, SIAM J. Sci. Comput. 26 (2005)
//! 1955, algorithm 5.3; T. J. Dekker, *A floating-point technique for extending the available
//! precision*, Numer. Math. 18 (1971) 224, for the exact product.

use fspid_numeric::rounding::{exact_sum, halves, product_error, sum_up};
use fspid_numeric::scalar::Interval;

use super::matrix::{IntervalMatrix, bounded};

/// Middles are zero or within these powers of two, 2^-400 to 2^400: no product of two, and no part
/// of one, leaves the range of normal numbers.
const MIDDLES: [f64; 2] = [exact_power(-400), exact_power(400)];
/// Likewise radii: 2^-500 to 2^400, as rounding leaves radii below middles.
const RADII: [f64; 2] = [exact_power(-500), exact_power(400)];
/// Products of more numbers than that are not needed, and $n u$ must be far below 1.
const LONGEST: usize = 1 << 20;

/// A power of two within the normal numbers.
const fn exact_power(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The product of matrices whose shapes fit.
pub(super) fn product(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    if in_range(left) && in_range(right) && left.columns < LONGEST {
        let mut result = middles(left, right, None);
        if has_radius(left) || has_radius(right) {
            spread(&mut result, left, right);
        }
        result
    } else {
        entry_by_entry(left, right)
    }
}

/// The square of $I + F$ less the identity, as $2 F + F^2$.
///
/// What is small in F keeps its digits. The radius is that of the square, $|I + F| r + r |I + F|$, up
/// to second order: where I + F is small it shrinks.
pub(super) fn square_beyond_identity(matrix: &IntervalMatrix) -> IntervalMatrix {
    let whole = magnitudes_with_identity(matrix);
    if !(in_range(matrix) && in_range(&whole) && matrix.columns < LONGEST) {
        let twice = matrix.scaled(Interval::point(2.0));
        return entry_by_entry(matrix, matrix).plus(&twice);
    }
    let twice: Vec<f64> = matrix.middle.iter().map(|value| 2.0 * value).collect();
    let mut result = middles(matrix, matrix, Some(&twice));
    if has_radius(matrix) {
        spread(&mut result, &whole, &whole);
    }
    result
}

/// $|I + F_m|$, rounded up, with the radius of F.
fn magnitudes_with_identity(matrix: &IntervalMatrix) -> IntervalMatrix {
    let mut whole = matrix.clone();
    for middle in whole.middle.iter_mut().step_by(matrix.columns + 1) {
        let (sum, error) = exact_sum(1.0, *middle);
        *middle = sum_up(sum.abs(), error.abs());
    }
    whole
}

/// The product of the middles, its radius what rounding leaves. `start` is added exactly.
fn middles(left: &IntervalMatrix, right: &IntervalMatrix, start: Option<&[f64]>) -> IntervalMatrix {
    let columns = right.columns;
    let right_parts = Parts::of(&right.middle);
    let mut result = IntervalMatrix::zeros(left.rows, columns);
    let mut row = ProductRow::new(columns);
    let share = rounding_share(left.columns + 1);
    for i in 0..left.rows {
        row.begin(start.map(|values| &values[i * columns..(i + 1) * columns]));
        for k in 0..left.columns {
            let factor = left.middle[i * left.columns + k];
            if factor != 0.0 {
                row.add(factor, &right_parts, k * columns);
            }
        }
        let places = i * columns..(i + 1) * columns;
        row.end(&mut result.middle[places.clone()], &mut result.radius[places], share);
    }
    result
}

/// $2 (n + 2)^2 u^2$ for sums of n products.
fn rounding_share(terms: usize) -> f64 {
    let terms = terms as f64 + 2.0;
    terms * terms * exact_power(-105)
}

/// Numbers and their upper and lower halves of digits.
struct Parts {
    value: Vec<f64>,
    high: Vec<f64>,
    low: Vec<f64>,
}

impl Parts {
    fn of(values: &[f64]) -> Self {
        let (high, low) = values.iter().map(|&value| halves(value)).unzip();
        Self { value: values.to_vec(), high, low }
    }
}

/// One row of a product while it is summed up.
struct ProductRow {
    sum: Vec<f64>,
    rest: Vec<f64>,
    /// Sum of the absolute products.
    absolute: Vec<f64>,
}

impl ProductRow {
    fn new(columns: usize) -> Self {
        let zeros = || vec![0.0; columns];
        Self { sum: zeros(), rest: zeros(), absolute: zeros() }
    }

    fn begin(&mut self, start: Option<&[f64]>) {
        self.rest.fill(0.0);
        match start {
            Some(values) => {
                self.sum.copy_from_slice(values);
                for (absolute, value) in self.absolute.iter_mut().zip(values) {
                    *absolute = value.abs();
                }
            }
            None => {
                self.sum.fill(0.0);
                self.absolute.fill(0.0);
            }
        }
    }

    /// Adds a factor times one row of the right matrix, which begins at `from`.
    #[inline]
    fn add(&mut self, factor: f64, right: &Parts, from: usize) {
        let columns = self.sum.len();
        let factor_halves = halves(factor);
        let value = &right.value[from..from + columns];
        let high = &right.high[from..from + columns];
        let low = &right.low[from..from + columns];
        let (rest, absolute) = (&mut self.rest[..columns], &mut self.absolute[..columns]);
        for (j, sum) in self.sum.iter_mut().enumerate() {
            let product = factor * value[j];
            let beyond = product_error(product, factor_halves, (high[j], low[j]));
            let (next, lost) = exact_sum(*sum, product);
            *sum = next;
            rest[j] += lost + beyond;
            absolute[j] += product.abs();
        }
    }

    /// Writes middles and radii; `share` of the absolute products is what the rest may be off.
    fn end(&self, middle: &mut [f64], radius: &mut [f64], share: f64) {
        let rest = self.rest.iter().zip(&self.absolute);
        for ((sum, (rest, absolute)), (middle, radius)) in
            self.sum.iter().zip(rest).zip(middle.iter_mut().zip(radius))
        {
            let (value, error) = exact_sum(*sum, *rest);
            // The absolute products are off by n u of themselves, far less than the share is too large.
            (*middle, *radius) = bounded(value, sum_up(error.abs(), share * absolute));
        }
    }
}

/// Adds to a product of middles what radii contribute: $|A_m| B_r + A_r (|B_m| + B_r)$.
fn spread(result: &mut IntervalMatrix, left: &IntervalMatrix, right: &IntervalMatrix) {
    let (n, columns) = (left.columns, right.columns);
    let absolute: Vec<f64> = right.middle.iter().map(|value| value.abs()).collect();
    let largest: Vec<f64> =
        absolute.iter().zip(&right.radius).map(|(value, radius)| value + radius).collect();
    // Sums of 2 n products of numbers that are not negative, each of at most 3 roundings in itself: off by
    // less than (2 n + 3) u, and by as much again for the products with this factor.
    let upward = 1.0 + (2 * n + 8) as f64 * f64::EPSILON;
    let mut sums = vec![0.0; columns];
    for i in 0..left.rows {
        sums.fill(0.0);
        for k in 0..n {
            let (place, row) = (i * n + k, k * columns..(k + 1) * columns);
            let (middle, radius) = (left.middle[place].abs(), left.radius[place]);
            let (radii, largest) = (&right.radius[row.clone()], &largest[row]);
            for ((sum, by_radius), by_largest) in sums.iter_mut().zip(radii).zip(largest) {
                *sum += middle * by_radius + radius * by_largest;
            }
        }
        // Finite, within the range that was asked for.
        let own = &mut result.radius[i * columns..(i + 1) * columns];
        for (radius, sum) in own.iter_mut().zip(&sums) {
            *radius = sum_up(*radius, sum * upward);
        }
    }
}

fn has_radius(matrix: &IntervalMatrix) -> bool {
    matrix.radius.iter().any(|&radius| radius > 0.0)
}

/// True if every middle and radius is zero or within the range where products are what they should be.
fn in_range(matrix: &IntervalMatrix) -> bool {
    let within = |values: &[f64], [least, most]: [f64; 2]| {
        values.iter().all(|value| {
            let size = value.abs();
            size == 0.0 || (size >= least && size <= most)
        })
    };
    within(&matrix.middle, MIDDLES) && within(&matrix.radius, RADII)
}

/// The product in plain intervals.
pub(super) fn entry_by_entry(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    let (a, b): (Vec<_>, Vec<_>) = (left.entries().collect(), right.entries().collect());
    let entry = |place: usize| {
        let (i, j) = (place / right.columns, place % right.columns);
        (0..left.columns)
            .fold(Interval::ZERO, |sum, k| sum + a[i * left.columns + k] * b[k * right.columns + j])
    };
    let places = left.rows * right.columns;
    IntervalMatrix::from_entries(left.rows, right.columns, (0..places).map(entry))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_lti::Matrix;

    fn point(rows: &[[f64; 2]]) -> IntervalMatrix {
        IntervalMatrix::from(&Matrix::from_rows(rows).expect("a test matrix is well formed"))
    }

    #[test]
    fn a_product_with_the_identity_stays_a_point_to_the_square_of_rounding() {
        let matrix = point(&[[0.1, -0.3], [1e5, 7e-9]]);
        let same = product(&matrix, &IntervalMatrix::identity(2));
        assert!(same.encloses(&matrix));
        assert!(same.max_radius() < 1e-24, "{:e}", same.max_radius());
    }

    #[test]
    fn what_cancels_leaves_its_rounding_only() {
        // (1 + e) (1 - e) - 1 = -e², which plain arithmetic loses.
        let e = exact_power(-30);
        let left = point(&[[1.0 + e, -1.0], [0.0, 0.0]]);
        let right = point(&[[1.0 - e, 0.0], [1.0, 0.0]]);
        let entry = product(&left, &right).get(0, 0).expect("exists");
        assert!(entry.contains(-e * e) && entry.radius() < 1e-29, "{entry:?}");
    }

    /// What is left when the large parts cancel is 1 + 2^-160, and the sum of the small parts can only
    /// say 1.
    #[test]
    fn what_doubled_precision_drops_is_in_the_radius() {
        let most = exact_power(53) - 1.0;
        let small = exact_power(-80);
        let left = [most, exact_power(53), most * small, exact_power(53) * small];
        let right = [most, 2.0 - exact_power(53), most * small, (2.0 - exact_power(53)) * small];
        let row = Matrix::from_rows(&[left]).expect("finite");
        let column = Matrix::from_rows(&right.map(|entry| [entry])).expect("finite");
        let product = product(&IntervalMatrix::from(&row), &IntervalMatrix::from(&column));
        let entry = product.get(0, 0).expect("exists");
        assert!(entry.contains(1.0) && entry.upper() > 1.0, "{entry:?}");
    }

    #[test]
    fn entries_at_the_ends_of_the_range_are_multiplied_in_plain_intervals() {
        for size in [1e-200, 1e-140, 1e140, 1e200] {
            let matrix = point(&[[size, 1.0], [0.0, 0.1]]);
            let square = product(&matrix, &matrix);
            assert_eq!(square, entry_by_entry(&matrix, &matrix));
            let corner = square.get(0, 0).expect("exists");
            assert!(corner.upper() > 0.0 && corner.upper() >= size * size);
        }
        let (fair, far) = (point(&[[3.0, 0.1], [0.7, 0.1]]), point(&[[1e200, 1.0], [1e-200, 0.1]]));
        for (left, right) in [(&fair, &far), (&far, &fair)] {
            assert_eq!(product(left, right), entry_by_entry(left, right));
        }
        let mut narrow = point(&[[1.0, 0.1], [0.0, 0.1]]);
        narrow.radius[0] = 1e-200;
        assert_eq!(product(&narrow, &narrow), entry_by_entry(&narrow, &narrow));
        let one = IntervalMatrix::identity(2);
        let square = square_beyond_identity(&narrow).plus(&one);
        let whole = narrow.plus(&one);
        let plain = entry_by_entry(&whole, &whole);
        for (found, expected) in square.entries().zip(plain.entries()) {
            assert!(found.intersection(expected).is_some() && found.radius() < 1e-14);
        }
    }

    #[test]
    fn what_is_far_below_one_beside_the_identity_keeps_its_square_in_the_radius() {
        // 2 F + F² is above 2 F, by less than any float is.
        let matrix = point(&[[1e-300, 0.1], [0.0, 0.1]]);
        let entry = square_beyond_identity(&matrix).get(0, 0).expect("exists");
        assert!(entry.lower() <= 2e-300 && entry.upper() > 2e-300, "{entry:?}");
    }

    #[test]
    fn the_share_of_the_products_that_rounding_may_take_is_twice_the_bound() {
        let u = exact_power(-53);
        for (terms, root) in [(0, 2.0), (1, 3.0), (3, 5.0), (98, 100.0)] {
            assert_eq!(rounding_share(terms).to_bits(), (2.0 * root * root * u * u).to_bits());
        }
    }

    #[test]
    fn sums_of_very_many_radii_do_not_fall_short() {
        // Of 1 and 99 999 times nine tenths of half its last digit, which plain sums lose.
        let count = 100_000;
        let small = 0.9 * exact_power(-53);
        let left = IntervalMatrix {
            rows: 1,
            columns: count,
            middle: vec![1.0; count],
            radius: vec![0.0; count],
        };
        let mut right = IntervalMatrix::zeros(count, 1);
        right.radius.fill(small);
        right.radius[0] = 1.0;
        let radius = product(&left, &right).radius[0];
        assert!(radius >= 1.0 + (count - 1) as f64 * small && radius < 1.0 + 1e-9, "{radius:e}");
    }

    #[test]
    fn structural_zeros_stay_zero() {
        let upper = point(&[[0.1, 0.7], [0.0, 0.3]]);
        assert_eq!(product(&upper, &upper).get(1, 0), Some(Interval::ZERO));
        assert_eq!(square_beyond_identity(&upper).get(1, 0), Some(Interval::ZERO));
    }

    #[test]
    fn the_square_beyond_identity_is_the_square() {
        let matrix = point(&[[-0.4, 0.7], [0.3, -0.9]]);
        let mut wide = matrix.clone();
        wide.radius = vec![1e-3, 0.0, 2e-3, 1e-4];
        for matrix in [matrix, wide] {
            let one = IntervalMatrix::identity(2);
            let whole = matrix.sum(&one).expect("one shape");
            let expected = product(&whole, &whole).difference(&one).expect("one shape");
            let found = square_beyond_identity(&matrix);
            for (found, expected) in found.entries().zip(expected.entries()) {
                assert!(found.intersection(expected).is_some());
                assert!((found.radius() - expected.radius()).abs() < 1e-15);
            }
        }
    }
}
