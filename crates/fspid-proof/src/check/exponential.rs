//! Enclosures of the matrix exponential and of a sampled system.

use fspid_lti::{LtiError, Matrix};
use fspid_numeric::rounding::sum_up;
use fspid_numeric::scalar::Interval;

use super::balance::balance;
use super::error::NotProved;
use super::matrix::IntervalMatrix;
use super::product::square_beyond_identity;

/// Terms of the Taylor series. With a norm of at most 1/4 the rest is below
/// $0.25^{18} / 19! < 10^{-27}$ of what is expanded.
const TERMS: u32 = 18;
/// Binary exponent of the largest norm that the series is used for.
const LARGEST_EXPONENT: i32 = -2;
/// More squarings are not made: the result would have overflowed, or no digit of it would be left.
const MOST_SQUARINGS: i32 = 60;
/// Binary exponent that held inputs are scaled to, far below the states. The result is linear in each
/// of them, so that the scaling is exact; without it large inputs would force needless squarings.
const INPUT_EXPONENT: i32 = -64;

/// The exponential of every matrix inside a square matrix.
///
/// $$ e^A = \left( I + F \right)^{2^s}, \qquad F = e^{A / 2^s} - I = \sum_{k=1}^{K} \frac{(A / 2^s)^k}{k!} + R $$
///
/// Balanced by powers of two, scaled to a norm of at most 1/4, expanded, and squared s times as
/// $F \leftarrow 2 F + F^2$, so that slow modes beside a fast one keep their digits. What the series
/// leaves out is bounded column by column: with $x = \lVert A \rVert_\infty$ and a column $a$ of A
///
/// $$ \lVert r \rVert_\infty \le \lVert a \rVert_\infty \sum_{k > K} \frac{x^{k-1}}{k!}
/// \le \lVert a \rVert_\infty \frac{x^K}{(K+1)!} \cdot \frac{1}{1 - x / (K + 2)} $$
///
/// and it is exactly zero where no chain of entries leads from column to row.
///
/// # Errors
/// [`NotProved::Shape`] for a matrix that is not square, [`NotProved::Unbounded`] for an entry without
/// bounds and for an exponential beyond the range of floats.
pub fn exponential(matrix: &IntervalMatrix) -> Result<IntervalMatrix, NotProved> {
    let size = matrix.rows();
    matrix.require_shape("matrix of the exponential", size, size)?;
    require_bounded("matrix of the exponential", matrix)?;
    let units = balance(matrix.magnitudes(), size);
    let balanced = matrix.rescaled(|row| -units[row], |column| units[column]);
    let (_, exponent) = libm::frexp(norm(&balanced));
    let squarings = (exponent - LARGEST_EXPONENT).max(0);
    if squarings > MOST_SQUARINGS {
        return Err(too_large());
    }
    let scaled = balanced.rescaled(|_| -squarings, |_| 0);
    let mut beyond = series(&scaled)?;
    for _ in 0..squarings {
        beyond = square_beyond_identity(&beyond);
    }
    let result = beyond.plus(&IntervalMatrix::identity(size));
    let restored = result.rescaled(|row| units[row], |column| -units[column]);
    require_bounded("matrix exponential", &restored)?;
    Ok(restored)
}

/// State and input matrices of a sampled system whose inputs are held over a time.
///
/// $$ \Phi = e^{A t}, \quad \Gamma = \int_0^t e^{A \tau} B \ d\tau, \quad
/// \exp \begin{pmatrix} A t & B t \cr 0 & 0 \end{pmatrix} = \begin{pmatrix} \Phi & \Gamma \cr 0 & I \end{pmatrix} $$
///
/// Both hold every pair that belongs to matrices inside A and B and a time inside `time_s`.
///
/// # Source
/// C. F. Van Loan, *Computing integrals involving the matrix exponential*, IEEE Trans. Automatic
/// Control 23 (1978) 395.
///
/// # Errors
/// As [`exponential`]; [`NotProved::Shape`] also for inputs that do not fit, [`NotProved::Number`] for a
/// time without bounds.
pub fn held(
    a: &IntervalMatrix,
    b: &IntervalMatrix,
    time_s: Interval,
) -> Result<(IntervalMatrix, IntervalMatrix), NotProved> {
    let (states, inputs) = (a.rows(), b.columns());
    a.require_shape("state matrix", states, states)?;
    b.require_shape("input matrix", states, inputs)?;
    if !time_s.is_bounded() {
        let found = time_s.width();
        return Err(NotProved::Number { what: "width of the time, s", found, allowed: "finite" });
    }
    let (a, b) = (a.scaled(time_s), b.scaled(time_s));
    require_bounded("input matrix", &b)?;
    let sizes = columns_of(&b);
    let shift = |input: usize| match sizes[input] {
        size if size > 0.0 => INPUT_EXPONENT - libm::frexp(size).1,
        _ => 0,
    };
    let small = b.rescaled(|_| 0, shift);
    let sampled = exponential(&beside(&a, &small))?;
    let phi = part(&sampled, states, 0..states);
    let gamma = part(&sampled, states, states..states + inputs).rescaled(|_| 0, |i| -shift(i));
    require_bounded("sampled input matrix", &gamma)?;
    Ok((phi, gamma))
}

/// A square matrix with columns beside it and rows of zeros below.
fn beside(a: &IntervalMatrix, b: &IntervalMatrix) -> IntervalMatrix {
    let size = a.rows() + b.columns();
    let mut whole = IntervalMatrix::zeros(size, size);
    for (from, first) in [(a, 0), (b, a.columns())] {
        for (place, (&middle, &radius)) in from.middle.iter().zip(&from.radius).enumerate() {
            let to = place / from.columns * size + first + place % from.columns;
            (whole.middle[to], whole.radius[to]) = (middle, radius);
        }
    }
    whole
}

/// The first rows and some columns.
fn part(matrix: &IntervalMatrix, rows: usize, columns: std::ops::Range<usize>) -> IntervalMatrix {
    let mut result = IntervalMatrix::zeros(rows, columns.len());
    let places = (0..rows).flat_map(|row| columns.clone().map(move |column| (row, column)));
    for (to, (row, column)) in places.enumerate() {
        let from = row * matrix.columns + column;
        (result.middle[to], result.radius[to]) = (matrix.middle[from], matrix.radius[from]);
    }
    result
}

/// $e^A - I$ of a matrix of small norm, by Horner's rule: $A/1 \cdot (I + A/2 \cdot (I + A/3 \dots))$.
fn series(matrix: &IntervalMatrix) -> Result<IntervalMatrix, LtiError> {
    let over = |sum: IntervalMatrix, term: u32| {
        sum.scaled(Interval::ONE / Interval::point(f64::from(term)))
    };
    let mut sum = over(matrix.clone(), TERMS);
    for term in (1..TERMS).rev() {
        sum = over(matrix.product(&sum)?.plus(matrix), term);
    }
    let (rest, reached) = (rest_of_series(matrix), reached(matrix));
    for (place, radius) in sum.radius.iter_mut().enumerate() {
        if reached[place] {
            *radius = sum_up(*radius, rest[place % matrix.columns]);
        }
    }
    Ok(sum)
}

/// What the series leaves out, at most, in every entry of each column.
fn rest_of_series(matrix: &IntervalMatrix) -> Vec<f64> {
    let point = |count: u32| Interval::point(f64::from(count));
    let norm = Interval::point(norm(matrix));
    let power = (2..=TERMS + 1).fold(Interval::ONE, |power, term| power * norm / point(term));
    let factor = power / (Interval::ONE - norm / point(TERMS + 2));
    let columns = columns_of(matrix).into_iter();
    columns.map(|column| (factor * Interval::point(column)).upper()).collect()
}

/// Where a power of the matrix, of any exponent above 0, can differ from zero.
fn reached(matrix: &IntervalMatrix) -> Vec<bool> {
    let size = matrix.columns;
    let mut reached: Vec<bool> = matrix.magnitudes().iter().map(|&size| size > 0.0).collect();
    for via in 0..size {
        for row in 0..size {
            if reached[row * size + via] {
                for column in 0..size {
                    reached[row * size + column] |= reached[via * size + column];
                }
            }
        }
    }
    reached
}

/// Upper bound of the largest row sum of absolute values.
fn norm(matrix: &IntervalMatrix) -> f64 {
    let magnitudes = matrix.magnitudes();
    let rows = magnitudes.chunks(matrix.columns.max(1));
    rows.map(|row| row.iter().fold(0.0, |sum, &size| sum_up(sum, size))).fold(0.0, f64::max)
}

/// Upper bound of the largest absolute value in each column.
fn columns_of(matrix: &IntervalMatrix) -> Vec<f64> {
    let mut largest = vec![0.0_f64; matrix.columns];
    for row in matrix.magnitudes().chunks(matrix.columns.max(1)) {
        for (largest, &size) in largest.iter_mut().zip(row) {
            *largest = largest.max(size);
        }
    }
    largest
}

/// `Ok` if every entry has bounds; otherwise the first that has none.
pub(super) fn require_bounded(
    what: &'static str,
    matrix: &IntervalMatrix,
) -> Result<(), NotProved> {
    match matrix.radius.iter().position(|radius| !radius.is_finite()) {
        None => Ok(()),
        Some(place) => {
            let (row, column) = (place / matrix.columns, place % matrix.columns);
            Err(NotProved::Unbounded { what, row, column })
        }
    }
}

/// `Ok` if every entry of a plain matrix is finite.
pub(super) fn require_finite(what: &'static str, matrix: &Matrix) -> Result<(), NotProved> {
    require_bounded(what, &IntervalMatrix::from(matrix))
}

fn too_large() -> NotProved {
    NotProved::Unbounded { what: "matrix exponential", row: 0, column: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rest of the series of $e^x - 1$ begins with $x^{19} / 19!$ and is little more.
    #[test]
    fn what_the_series_leaves_out_is_bounded_from_above_and_closely() {
        let x = 0.25_f64;
        let first = (1..=19).fold(1.0, |power, term| power * x / f64::from(term));
        let matrix = IntervalMatrix::from_rows(&[[Interval::point(x)]]).expect("square");
        let rest = rest_of_series(&matrix)[0];
        assert!(rest > first * (1.0 + x / 20.0) && rest < 1.001 * first * (1.0 + x / 20.0));
        // Of a narrow column beside wide ones it is a part of the narrow column.
        let row = |left: f64, right: f64| [left, right].map(Interval::point);
        let matrix = IntervalMatrix::from_rows(&[row(x, 1e-30), row(0.0, 0.0)]).expect("square");
        let rest = rest_of_series(&matrix);
        assert!((rest[1] / rest[0] - 1e-30 / x).abs() < 1e-40);
        assert_eq!(reached(&matrix), [true, true, false, false]);
        // Without rounding but for that of twice the working precision: what is left out shows.
        let mut chain = Matrix::zeros(3, 3);
        chain.set(0, 1, x).and_then(|()| chain.set(1, 2, x)).expect("the entries exist");
        let chain = IntervalMatrix::from(&chain);
        let (sum, rest) = (series(&chain).expect("square"), rest_of_series(&chain));
        assert!(sum.radius[2] >= rest[2] && sum.radius[2] < 1.1 * rest[2]);
        assert!(sum.radius[6].max(sum.radius[0]) <= 0.0);
    }

    #[test]
    fn a_chain_of_entries_is_followed_through_states_behind_it() {
        // 1 to 2, 2 to 0: by powers of the matrix 1 comes to 0 as well.
        let mut chain = Matrix::zeros(3, 3);
        chain.set(1, 2, 0.1).and_then(|()| chain.set(2, 0, 0.1)).expect("the entries exist");
        let expected = [false, false, false, true, false, true, true, false, false];
        assert_eq!(reached(&IntervalMatrix::from(&chain)), expected);
    }
}
