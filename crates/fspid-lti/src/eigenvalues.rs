//! Eigenvalues of a small real matrix: balanced, brought to Hessenberg form, then the double-shift QR iteration.

use crate::balance::balance;
use crate::complex::{Complex, modulus, sort};
use crate::error::LtiError;
use crate::matrix::Matrix;

/// QR steps for one eigenvalue or pair before giving up; two to four are usual.
const STEPS_PER_EIGENVALUE: usize = 60;
/// After so many steps without success the shifts are replaced by arbitrary ones, which breaks cycles.
const EXCEPTIONAL_EVERY: usize = 10;

const WHAT: &str = "matrix of the eigenvalues";

/// All eigenvalues with their multiplicity, sorted by real part, then imaginary part.
///
/// Complex ones come in exactly conjugate pairs. The error of each is that of a relative change of the balanced
/// matrix by a few $10^{-16}$; for the roots of a polynomial use [`Polynomial::roots`](crate::Polynomial::roots),
/// which is not subject to it.
///
/// # Source
/// J. G. F. Francis, The QR transformation, Computer Journal 4 (1961) 265 and (1962) 332; shifts and deflation as in
/// routine `dlahqr` of LAPACK.
///
/// # Errors
/// A matrix that is not square, an entry that is not finite, no convergence within the limit of steps.
pub fn eigenvalues(matrix: &Matrix) -> Result<Vec<Complex>, LtiError> {
    matrix.require_square_and_finite(WHAT)?;
    let mut work = matrix.clone();
    balance(&mut work);
    let largest = work.data().iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let (_, exponent) = libm::frexp(largest);
    work = work.map(|value| libm::scalbn(value, -exponent));
    to_hessenberg(&mut work);
    let mut values = hessenberg_eigenvalues(work)?;
    for value in &mut values {
        *value = Complex::new(libm::scalbn(value.re, exponent), libm::scalbn(value.im, exponent));
    }
    if !values.iter().all(|value| value.is_finite()) {
        return Err(LtiError::OutOfRange { what: "eigenvalue" });
    }
    sort(&mut values);
    Ok(values)
}

/// Largest modulus of an eigenvalue: below 1 for a sampled system that is stable.
///
/// # Errors
/// As [`eigenvalues`].
pub fn spectral_radius(matrix: &Matrix) -> Result<f64, LtiError> {
    Ok(eigenvalues(matrix)?.into_iter().map(modulus).fold(0.0, f64::max))
}

/// I - tau v v', which turns a vector into a multiple of the first unit vector.
struct Reflector {
    /// The vector, whose first entry is 1.
    v: Vec<f64>,
    tau: f64,
    /// What becomes of the first entry of the vector.
    first: f64,
}

impl Reflector {
    /// `None` when the vector is already such a multiple.
    fn of(x: &[f64]) -> Option<Self> {
        let tail = x[1..].iter().fold(0.0, |norm, &value| libm::hypot(norm, value));
        if tail == 0.0 {
            return None;
        }
        let norm = libm::hypot(x[0], tail);
        let signed = if x[0] < 0.0 { -norm } else { norm };
        let pivot = x[0] + signed;
        let v = core::iter::once(1.0).chain(x[1..].iter().map(|value| value / pivot)).collect();
        Some(Self { v, tau: pivot / signed, first: -signed })
    }

    /// From the left on rows from `row`, in the columns given.
    fn reflect_rows(&self, matrix: &mut Matrix, row: usize, columns: core::ops::Range<usize>) {
        for column in columns {
            let dot = self
                .v
                .iter()
                .enumerate()
                .fold(0.0, |sum, (i, v)| sum + v * matrix.at(row + i, column));
            for (i, v) in self.v.iter().enumerate() {
                *matrix.at_mut(row + i, column) -= self.tau * dot * v;
            }
        }
    }

    /// From the right on columns from `column`, in the rows given.
    fn reflect_columns(&self, matrix: &mut Matrix, column: usize, rows: core::ops::Range<usize>) {
        for row in rows {
            let dot = self
                .v
                .iter()
                .enumerate()
                .fold(0.0, |sum, (i, v)| sum + v * matrix.at(row, column + i));
            for (i, v) in self.v.iter().enumerate() {
                *matrix.at_mut(row, column + i) -= self.tau * dot * v;
            }
        }
    }
}

/// Similar matrix with zeros below the first subdiagonal, by Householder reflections.
pub(crate) fn to_hessenberg(matrix: &mut Matrix) {
    let size = matrix.rows();
    for column in 0..size.saturating_sub(2) {
        let below: Vec<f64> = (column + 1..size).map(|row| matrix.at(row, column)).collect();
        if let Some(reflector) = Reflector::of(&below) {
            reflector.reflect_rows(matrix, column + 1, column + 1..size);
            reflector.reflect_columns(matrix, column + 1, 0..size);
            set_column(matrix, column + 1, column, &reflector);
        }
    }
}

/// Writes the result of a reflection of a column by its own reflector: one entry, then zeros.
fn set_column(matrix: &mut Matrix, row: usize, column: usize, reflector: &Reflector) {
    *matrix.at_mut(row, column) = reflector.first;
    for i in 1..reflector.v.len() {
        *matrix.at_mut(row + i, column) = 0.0;
    }
}

/// Splits off eigenvalues from the bottom of a Hessenberg matrix until none is left.
fn hessenberg_eigenvalues(mut h: Matrix) -> Result<Vec<Complex>, LtiError> {
    let mut values = Vec::with_capacity(h.rows());
    let (mut end, mut steps) = (h.rows(), 0);
    while end > 0 {
        let start = start_of_block(&mut h, end, steps);
        if end - start <= 2 {
            values.extend(block_eigenvalues(&h, start, end));
            (end, steps) = (start, 0);
        } else if steps < STEPS_PER_EIGENVALUE {
            steps += 1;
            qr_step(&mut h, start, end, steps.is_multiple_of(EXCEPTIONAL_EVERY));
        } else {
            return Err(LtiError::NotConverged { what: "eigenvalue", iterations: steps });
        }
    }
    Ok(values)
}

/// First row of the lowest block that does not fall apart; the entry that couples it upwards is set to zero.
fn start_of_block(h: &mut Matrix, end: usize, steps: usize) -> usize {
    for row in (1..end).rev() {
        if h.at(row, row - 1).abs() <= negligible(h, row, steps) {
            *h.at_mut(row, row - 1) = 0.0;
            return row;
        }
    }
    0
}

/// Size below which the entry left of the diagonal in this row counts as zero.
///
/// Rounding of its neighbours on the diagonal at first, which keeps the small eigenvalues of graded matrices. Where
/// eigenvalues coincide in different blocks the shifts lose their force in rounding noise; then rounding of the whole
/// matrix, which is scaled to 1, a little more of it with each step.
fn negligible(h: &Matrix, row: usize, steps: usize) -> f64 {
    let neighbours = h.at(row, row).abs() + h.at(row - 1, row - 1).abs();
    if steps > EXCEPTIONAL_EVERY {
        f64::EPSILON * steps as f64
    } else {
        f64::EPSILON * if neighbours > 0.0 { neighbours } else { 1.0 }
    }
}

fn block_eigenvalues(h: &Matrix, start: usize, end: usize) -> Vec<Complex> {
    if end - start == 1 {
        return vec![Complex::new(h.at(start, start), 0.0)];
    }
    let (a, b, c, d) = (
        h.at(start, start),
        h.at(start, start + 1),
        h.at(start + 1, start),
        h.at(start + 1, start + 1),
    );
    two_by_two(a, b, c, d).to_vec()
}

/// Eigenvalues of ((a, b), (c, d)), the larger real one first found and the other from the product.
pub(crate) fn two_by_two(a: f64, b: f64, c: f64, d: f64) -> [Complex; 2] {
    let half = 0.5 * (a - d);
    let discriminant = half * half + b * c;
    if discriminant < 0.0 {
        let (re, im) = (d + half, (-discriminant).sqrt());
        return [Complex::new(re, -im), Complex::new(re, im)];
    }
    let root = discriminant.sqrt();
    let far = if half < 0.0 { half - root } else { half + root };
    let near = if far == 0.0 { 0.0 } else { -b * c / far };
    [Complex::new(d + far, 0.0), Complex::new(d + near, 0.0)]
}

/// One double-shift step on the block of rows `start..end`, which has at least three.
fn qr_step(h: &mut Matrix, start: usize, end: usize, exceptional: bool) {
    let mut column = first_column(h, start, shifts(h, end, exceptional)).to_vec();
    for row in start..end - 1 {
        let height = column.len().min(end - row);
        if let Some(reflector) = Reflector::of(&column[..height]) {
            reflector.reflect_rows(h, row, row..end);
            reflector.reflect_columns(h, row, start..end.min(row + 4));
            if row > start {
                set_column(h, row, row - 1, &reflector);
            }
        }
        column = (row + 1..end.min(row + 4)).map(|below| h.at(below, row)).collect();
    }
}

/// The two-by-two matrix whose eigenvalues are the shifts, as its diagonal and the product of the other two entries.
fn shifts(h: &Matrix, end: usize, exceptional: bool) -> (f64, f64, f64) {
    let last = end - 1;
    if exceptional {
        let size = h.at(last, last - 1).abs() + h.at(last - 1, last - 2).abs();
        let diagonal = 0.75 * size + h.at(last, last);
        return (diagonal, diagonal, -0.4375 * size * size);
    }
    (h.at(last - 1, last - 1), h.at(last, last), h.at(last, last - 1) * h.at(last - 1, last))
}

/// First column of (H - s1 I)(H - s2 I), up to a factor.
fn first_column(h: &Matrix, start: usize, (x, y, w): (f64, f64, f64)) -> [f64; 3] {
    let corner = h.at(start, start);
    let below = h.at(start + 1, start);
    let (x, y) = (x - corner, y - corner);
    [
        (x * y - w) / below + h.at(start, start + 1),
        h.at(start + 1, start + 1) - corner - x - y,
        h.at(start + 2, start + 1),
    ]
}
