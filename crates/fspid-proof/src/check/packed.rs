//! Sums of symmetric matrices, and whether they are positive definite, for proofs that ask very many.

use super::error::NotProved;
use super::matrix::IntervalMatrix;

/// Longest sums and largest matrices: roundings that come to more than a share of $10^{-12}$ are not counted.
const MOST: usize = 1000;
/// Larger traces are refused.
const LARGEST: f64 = 1e10;
/// More than all that underflows can amount to, below that trace.
const LEAST: f64 = 1e-290;

/// All symmetric matrices whose entries on and above the diagonal lie within a radius of a middle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Packed {
    size: usize,
    /// Row after row, each from the diagonal on.
    middle: Vec<f64>,
    radius: Vec<f64>,
}

impl Packed {
    /// The symmetric matrices inside a square one.
    pub(super) fn of(matrix: &IntervalMatrix) -> Self {
        let size = matrix.rows();
        let places = (0..size).flat_map(|row| (row..size).map(move |column| row * size + column));
        let (middle, radius) =
            places.map(|place| (matrix.middle[place], matrix.radius[place])).unzip();
        Self { size, middle, radius }
    }

    pub(super) fn negated(&self) -> Self {
        let middle = self.middle.iter().map(|value| -value).collect();
        Self { middle, ..self.clone() }
    }

    /// A weighted sum of matrices of one size, for weights of which each may be off by four roundings.
    ///
    /// With n terms a middle suffers n + 1 roundings of the sum of the absolute terms at most, the weights
    /// four more; the radii, all of one sign, suffer as many, which the factor makes good. What underflows
    /// is far below the smallest normal number.
    pub(super) fn sum<'a>(terms: impl Iterator<Item = (f64, &'a Self)>) -> Self {
        let mut sum: Option<Self> = None;
        let mut sizes: Vec<f64> = Vec::new();
        let mut count = 0_usize;
        for (weight, term) in terms {
            let sum = sum.get_or_insert_with(|| Self {
                size: term.size,
                middle: vec![0.0; term.middle.len()],
                radius: vec![0.0; term.radius.len()],
            });
            sizes.resize(sum.middle.len(), 0.0);
            count += 1;
            let own = sum.middle.iter_mut().zip(&mut sum.radius).zip(&mut sizes);
            for (((middle, radius), size), (value, spread)) in
                own.zip(term.middle.iter().zip(&term.radius))
            {
                let product = weight * value;
                *middle += product;
                *size += product.abs();
                *radius += weight.abs() * spread;
            }
        }
        let Some(mut sum) = sum else {
            return Self { size: 0, middle: Vec::new(), radius: Vec::new() };
        };
        // Twice what is needed, as the sums of absolute values are rounded as well.
        let share = (count + 8) as f64 * f64::EPSILON;
        for (radius, size) in sum.radius.iter_mut().zip(&sizes) {
            *radius = *radius * (1.0 + share) + share * size + f64::MIN_POSITIVE;
            if count > MOST || !size.is_finite() {
                *radius = f64::INFINITY;
            }
        }
        sum
    }

    /// Proves that all of the matrices are positive definite.
    ///
    /// With the middle S, a number c, and $\tilde S = S - c I$ as computed: if the Cholesky algorithm in
    /// ordinary arithmetic reaches its end with a factor R, then $R^T R = \tilde S + \Delta$ with
    ///
    /// $$ \lVert \Delta \rVert_2 \le \frac{\gamma_{n+1}}{1 - \gamma_{n+1}} \operatorname{tr} \tilde S,
    /// \quad \gamma_k = \frac{k u}{1 - k u} $$
    ///
    /// and $R^T R$ is not negative. (Not the loop of `fspid_numeric`: this one works from the right, in packed rows, because
    /// thousands of inequalities are checked with it, and needs no more of a factor than that there is one.) So all is proved if c is above this, the rounding of the difference
    /// and the largest row sum of the radii, which bounds their norm.
    ///
    /// # Source
    /// S. M. Rump, *Verification of positive definiteness*, BIT 46 (2006) 433; N. J. Higham, *Accuracy
    /// and Stability of Numerical Algorithms*, 2nd edition, theorems 10.3 and 10.5.
    ///
    /// # Errors
    /// [`NotProved::NoFactor`] where it could not be shown.
    pub(super) fn prove_definite(&self, what: &'static str) -> Result<(), NotProved> {
        let size = self.size;
        let failed = |row: usize, pivot: f64| NotProved::NoFactor { what, row, pivot };
        let Some(shift) = self.shift() else { return Err(failed(0, f64::NAN)) };
        let mut factor = self.middle.clone();
        let mut start = 0;
        for row in 0..size {
            let (own, below) = factor[start..].split_at_mut(size - row);
            let pivot = own[0] - shift;
            if !(pivot > 0.0 && pivot.is_finite()) {
                return Err(failed(row, pivot));
            }
            let root = pivot.sqrt();
            own.iter_mut().for_each(|entry| *entry /= root);
            let mut next = 0;
            for column in 1..size - row {
                let (by, others) = (own[column], &own[column..]);
                for (entry, other) in below[next..].iter_mut().zip(others) {
                    *entry -= by * other;
                }
                next += size - row - column;
            }
            start += size - row;
        }
        Ok(())
    }

    /// The number c; none where there are no bounds or numbers are so large that what underflows would
    /// have to be counted.
    fn shift(&self) -> Option<f64> {
        let size = self.size;
        let mut sums = vec![0.0; size];
        let (mut trace, mut start) = (0.0, 0);
        for row in 0..size {
            trace += self.middle[start].abs();
            sums[row] += self.radius[start];
            for column in row + 1..size {
                let radius = self.radius[start + column - row];
                sums[row] += radius;
                sums[column] += radius;
            }
            start += size - row;
        }
        let norm = sums.into_iter().fold(0.0, f64::max);
        // Twice what the roundings of factor, difference and row sums need.
        let share = 2.0 * (size + 4) as f64 * f64::EPSILON;
        let shift = norm + share * (trace + norm) + LEAST;
        (trace < LARGEST && shift < LARGEST && size <= MOST).then_some(shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_lti::Matrix;
    use fspid_numeric::scalar::Interval;

    fn packed(rows: &[[f64; 3]; 3]) -> Packed {
        Packed::of(&IntervalMatrix::from(&Matrix::from_rows(rows).expect("finite")))
    }

    #[test]
    fn a_definite_matrix_is_proved_and_others_are_not() {
        let definite = packed(&[[4.0, 2.0, -2.0], [2.0, 10.0, 2.0], [-2.0, 2.0, 6.0]]);
        assert_eq!(definite.prove_definite("matrix"), Ok(()));
        assert!(definite.negated().prove_definite("matrix").is_err());
        let indefinite = packed(&[[4.0, 2.0, 6.0], [2.0, 10.0, 2.0], [6.0, 2.0, 6.0]]);
        let reason = indefinite.prove_definite("matrix").expect_err("its determinant is -96");
        assert!(matches!(reason, NotProved::NoFactor { row: 2, .. }), "{reason:?}");
        let mut broken = definite.clone();
        broken.radius[1] = f64::INFINITY;
        assert!(broken.prove_definite("matrix").is_err());
        broken.middle[1] = f64::NAN;
        assert!(broken.prove_definite("matrix").is_err());
    }

    /// The eigenvalues are 3 and, twice, the smallest one named.
    #[test]
    fn a_matrix_within_rounding_of_singular_is_not_proved() {
        let with = |least: f64| {
            let (on, off) = ((3.0 + 2.0 * least) / 3.0, (3.0 - least) / 3.0);
            packed(&[[on, off, off], [off, on, off], [off, off, on]])
        };
        assert!(with(1e-13).prove_definite("matrix").is_ok());
        for least in [1e-16, 0.0, -1e-16, -1e-13] {
            assert!(with(least).prove_definite("matrix").is_err(), "{least}");
        }
    }

    #[test]
    fn radii_count_by_their_row_sums() {
        let wide = |radius: f64| {
            let side = Interval::between(-radius, radius);
            let entry = |row: usize, column: usize| {
                if row == column { Interval::ONE + side } else { side }
            };
            let rows: Vec<Vec<Interval>> =
                (0..3).map(|row| (0..3).map(|column| entry(row, column)).collect()).collect();
            Packed::of(&IntervalMatrix::from_rows(&rows).expect("square"))
        };
        assert!(wide(0.33).prove_definite("matrix").is_ok());
        assert!(wide(0.34).prove_definite("matrix").is_err(), "all of 0.34 make -0.02");
    }

    #[test]
    fn sums_hold_the_exact_sums() {
        let (one, tenth) = (packed(&[[1.0; 3]; 3]), packed(&[[0.1; 3]; 3]));
        let terms = [(0.1, &one), (-1.0, &tenth), (1e-17, &one)];
        let sum = Packed::sum(terms.into_iter());
        for (middle, radius) in sum.middle.iter().zip(&sum.radius) {
            assert!((middle - 1e-17).abs() <= *radius && *radius < 1e-15, "{middle} {radius}");
        }
        assert_eq!(Packed::sum(core::iter::empty()).size, 0);
    }

    /// Lower unit triangular L of whole numbers and D of ones make $L D L^T$, the pivots of which are those of D.
    #[test]
    fn a_negative_pivot_is_found_wherever_it_stands() {
        for size in 1..=7_usize {
            let lower = |row: usize, column: usize| match row.cmp(&column) {
                core::cmp::Ordering::Less => 0.0,
                core::cmp::Ordering::Equal => 1.0,
                core::cmp::Ordering::Greater => ((3 * row + 5 * column) % 4) as f64 - 1.0,
            };
            let with = |negative: Option<usize>| {
                let pivot = |at: usize| if negative == Some(at) { -1.0 } else { 1.0 };
                let entry = |row: usize, column: usize| {
                    let terms = (0..size).map(|at| lower(row, at) * pivot(at) * lower(column, at));
                    terms.sum::<f64>()
                };
                let rows: Vec<Vec<f64>> = (0..size)
                    .map(|row| (0..size).map(|column| entry(row, column)).collect())
                    .collect();
                Packed::of(&IntervalMatrix::from(&Matrix::from_rows(&rows).expect("finite")))
            };
            assert_eq!(with(None).prove_definite("matrix"), Ok(()), "{size}");
            for place in 0..size {
                let found = with(Some(place)).prove_definite("matrix").expect_err("indefinite");
                assert!(
                    matches!(found, NotProved::NoFactor { row, .. } if row == place),
                    "{size} {place} {found:?}"
                );
            }
        }
    }

    /// Above the largest row sum of the radii and $\gamma_{n + 1}$ of the trace, and not far above.
    #[test]
    fn the_shift_is_above_radii_and_roundings_and_not_far_above() {
        let cases = [1_usize, 3, 20].into_iter().flat_map(|size| {
            [0.0, 0.25]
                .into_iter()
                .flat_map(move |radius| [false, true].map(|first| (size, radius, first)))
        });
        for (size, radius, first) in cases {
            // Wider towards one corner: the first row or the last has the largest sum.
            let last = size - 1;
            let wide = |row: usize, column: usize| {
                radius * (if first { 2 * last - row - column } else { row + column }) as f64
            };
            let entry = |row: usize, column: usize| {
                let middle = if row == column { 1.0 + row as f64 } else { 0.5 };
                Interval::between(middle - wide(row, column), middle + wide(row, column))
            };
            let rows: Vec<Vec<Interval>> =
                (0..size).map(|row| (0..size).map(|column| entry(row, column)).collect()).collect();
            let packed = Packed::of(&IntervalMatrix::from_rows(&rows).expect("square"));
            let trace = (size * (size + 1) / 2) as f64;
            let norm: f64 = (0..size).map(|at| wide(if first { 0 } else { last }, at)).sum();
            let shift = packed.shift().expect("small");
            let (n, u) = (size as f64, 0.5 * f64::EPSILON * (trace + norm));
            assert!(shift >= norm + 2.0 * (n + 1.0) * u, "{size} {radius} {shift:e}");
            assert!(shift <= norm + 10.0 * (n + 4.0) * u + 1e-200, "{size} {radius} {shift:e}");
        }
    }

    #[test]
    fn nothing_at_all_is_not_positive() {
        for size in 1..4 {
            let zeros = Packed::of(&IntervalMatrix::zeros(size, size));
            assert!(zeros.prove_definite("matrix").is_err(), "{size}");
        }
    }

    #[test]
    fn matrices_beyond_what_the_bounds_hold_for_are_refused() {
        let diagonal =
            |value: f64, radius: f64| Packed { size: 1, middle: vec![value], radius: vec![radius] };
        assert!(diagonal(0.9 * LARGEST, 0.0).prove_definite("matrix").is_ok());
        for (value, radius) in [(LARGEST, 0.0), (2.0 * LARGEST, 0.0), (1.0, 2.0 * LARGEST)] {
            assert_eq!(diagonal(value, radius).shift(), None, "{value} {radius}");
        }
        let identity = |size: usize| Packed::of(&IntervalMatrix::identity(size)).shift();
        assert!(identity(MOST).is_some() && identity(MOST + 1).is_none());
    }

    #[test]
    fn the_radius_of_a_sum_covers_its_roundings_and_the_radii_of_its_terms() {
        let one = |middle: f64, radius: f64| Packed {
            size: 1,
            middle: vec![middle],
            radius: vec![radius],
        };
        let u = 0.5 * f64::EPSILON;
        for count in [1_usize, 10, 100, MOST] {
            // Large terms that cancel leave as many roundings as others.
            let terms = [one(1e3, 0.0), one(-1e3, 0.0)];
            let sum = Packed::sum((0..count).map(|at| (0.7, &terms[at % 2])));
            let (n, size) = (count as f64, 700.0 * count as f64);
            assert!(sum.radius[0] >= (n + 5.0) * u * size, "{count} {:e}", sum.radius[0]);
            assert!(sum.radius[0] <= 4.0 * (n + 9.0) * u * size, "{count} {:e}", sum.radius[0]);
            // Radii add up whatever the signs are, and are rounded themselves.
            let wide = [one(0.0, 0.5), one(0.0, 0.5)];
            let sum = Packed::sum(
                (0..count).map(|at| (if at % 2 == 0 { 0.7 } else { -0.7 }, &wide[at % 2])),
            );
            let radii = 0.35 * n;
            assert!(sum.radius[0] >= radii * (1.0 + (n + 5.0) * u), "{count} {:e}", sum.radius[0]);
            assert!(
                sum.radius[0] <= radii * (1.0 + 6.0 * (n + 9.0) * u),
                "{count} {:e}",
                sum.radius[0]
            );
        }
        // What underflows is there all the same.
        let tiny = one(1e-200, 1e-200);
        assert!(Packed::sum([(1e-200, &tiny)].into_iter()).radius[0] > 0.0);
    }

    #[test]
    fn sums_that_are_too_long_or_too_large_have_no_bounds() {
        let one = Packed { size: 1, middle: vec![1.0], radius: vec![0.0] };
        let of = |count: usize| Packed::sum((0..count).map(|_| (1.0, &one))).radius[0];
        assert!(of(MOST).is_finite() && of(MOST + 1).is_infinite());
        let huge = Packed { middle: vec![f64::MAX], ..one };
        assert!(Packed::sum([(1.0, &huge), (1.0, &huge)].into_iter()).radius[0].is_infinite());
        assert!(Packed::sum([(1.0, &huge), (-1.0, &huge)].into_iter()).radius[0].is_infinite());
    }
}
