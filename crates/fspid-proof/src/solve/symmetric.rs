//! Symmetric matrices: eigenvalues by rotations, packing into vectors, Newton's equations.

use core::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use fspid_numeric::matrix::{Jacobi, Turn};

use super::dense::{Dense, add_scaled};

/// Six to eight sweeps are usual.
const ROTATIONS: Jacobi = Jacobi { sweeps: 40, turn, clears: false };

/// Eigenvalues of a symmetric matrix with their unit eigenvectors in the columns, smallest first.
pub(super) struct Spectrum {
    pub(super) values: Vec<f64>,
    pub(super) vectors: Dense,
}

impl Spectrum {
    /// By cyclic rotations.
    pub(super) fn of(matrix: &Dense) -> Self {
        let size = matrix.rows;
        let (mut work, mut vectors) = (matrix.symmetric(), Dense::identity(size));
        ROTATIONS.diagonalise(&mut work.data, &mut vectors.data, size);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&left, &right| work[(left, left)].total_cmp(&work[(right, right)]));
        Self {
            values: order.iter().map(|&i| work[(i, i)]).collect(),
            vectors: Dense::from_function(size, size, |row, column| vectors[(row, order[column])]),
        }
    }

    /// Smallest eigenvalue; infinite for a matrix without rows.
    pub(super) fn smallest(&self) -> f64 {
        self.values.first().copied().unwrap_or(f64::INFINITY)
    }

    /// Largest eigenvalue; minus infinity for a matrix without rows.
    pub(super) fn largest(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// Unit eigenvector of the eigenvalue with this number.
    pub(super) fn vector(&self, number: usize) -> Vec<f64> {
        (0..self.vectors.rows).map(|row| self.vectors[(row, number)]).collect()
    }
}

/// The turn that makes an entry zero; none when it is already negligible beside its diagonal.
fn turn([first, last]: [f64; 2], entry: f64) -> Option<Turn> {
    let size = (first.abs() * last.abs()).sqrt();
    let floor = f64::EPSILON * (first.abs() + last.abs()) * 1e-3;
    if !(entry.abs() > 0.25 * f64::EPSILON * size + floor) {
        return None;
    }
    let theta = 0.5 * (last - first) / entry;
    let root = libm::hypot(theta, 1.0);
    let tangent = if theta < 0.0 { 1.0 / (theta - root) } else { 1.0 / (theta + root) };
    Some(Turn::of_tangent(tangent, libm::hypot(tangent, 1.0)))
}

/// Number of entries of a symmetric matrix on and above its diagonal.
pub(super) fn packed_len(size: usize) -> usize {
    size * (size + 1) / 2
}

/// Entries on and above the diagonal, row after row, those above times √2: the length of the vector is
/// the norm of the matrix.
pub(super) fn pack(matrix: &Dense) -> Vec<f64> {
    let mut packed = Vec::with_capacity(packed_len(matrix.rows));
    for row in 0..matrix.rows {
        packed.push(matrix[(row, row)]);
        for column in row + 1..matrix.columns {
            packed.push(FRAC_1_SQRT_2 * (matrix[(row, column)] + matrix[(column, row)]));
        }
    }
    packed
}

/// The symmetric matrix that [`pack`] packed.
pub(super) fn unpack(packed: &[f64], size: usize) -> Dense {
    let mut matrix = Dense::zeros(size, size);
    let mut entries = packed.iter();
    for row in 0..size {
        for column in row..size {
            let value = entries.next().copied().unwrap_or(f64::NAN);
            let value = if row == column { value } else { value / SQRT_2 };
            matrix[(row, column)] = value;
            matrix[(column, row)] = value;
        }
    }
    matrix
}

/// Solution of A x = b for a symmetric positive definite A of which only the upper triangle is read.
///
/// A is overwritten. Rows are eliminated one after the other, so that all sums run along rows.
/// `None` when a pivot is not above zero.
pub(super) fn solve_definite(a: &mut Dense, b: &[f64]) -> Option<Vec<f64>> {
    let size = a.rows;
    let mut x = b.to_vec();
    for k in 0..size {
        let pivot = a[(k, k)];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        let (upper, lower) = a.data.split_at_mut((k + 1) * size);
        let pivot_row = &upper[k * size..];
        for row in k + 1..size {
            let factor = -pivot_row[row] / pivot;
            let start = (row - k - 1) * size;
            add_scaled(&mut lower[start + row..start + size], factor, &pivot_row[row..]);
            x[row] += factor * x[k];
        }
    }
    for row in (0..size).rev() {
        let known = (row + 1..size).fold(0.0, |sum, k| sum + a[(row, k)] * x[k]);
        x[row] = (x[row] - known) / a[(row, row)];
    }
    x.iter().all(|value| value.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hilbert(size: usize) -> Dense {
        Dense::from_function(size, size, |i, j| 1.0 / (i + j + 1) as f64)
    }

    #[test]
    fn eigenvalues_of_a_hilbert_matrix_are_those_of_the_tables() {
        // Order 3: the roots of x³ - 23/15 x² + 127/720 x - 1/2160.
        let spectrum = Spectrum::of(&hilbert(3));
        for (value, expected) in spectrum.values.iter().zip([
            0.002_687_340_355_773_53,
            0.122_327_065_853_906,
            1.408_318_927_123_654,
        ]) {
            assert!((value - expected).abs() < 1e-14, "{value}");
        }
    }

    #[test]
    fn eigenvectors_are_orthogonal_and_multiply_back() {
        let matrix = hilbert(9).plus(0.3, &Dense::identity(9));
        let spectrum = Spectrum::of(&matrix);
        let q = &spectrum.vectors;
        assert!(q.transpose_times(q).plus(-1.0, &Dense::identity(9)).norm() < 1e-13);
        let diagonal = matrix.congruence(q);
        for i in 0..9 {
            assert!((diagonal[(i, i)] - spectrum.values[i]).abs() < 1e-13);
        }
        assert!(spectrum.smallest() <= spectrum.largest());
    }

    #[test]
    fn packing_keeps_the_norm_and_is_undone() {
        let matrix = hilbert(4);
        let packed = pack(&matrix);
        let length = packed.iter().fold(0.0, |sum, value| sum + value * value).sqrt();
        assert!((length - matrix.norm()).abs() < 1e-14);
        assert!(unpack(&packed, 4).plus(-1.0, &matrix).norm() < 1e-15);
    }

    #[test]
    fn a_definite_system_is_solved_and_an_indefinite_one_refused() {
        let x =
            solve_definite(&mut hilbert(5), &hilbert(5).times_vector(&[1.0, -2.0, 3.0, -4.0, 5.0]));
        for (value, expected) in x.unwrap().iter().zip([1.0, -2.0, 3.0, -4.0, 5.0]) {
            assert!((value - expected).abs() < 1e-9, "{value}");
        }
        assert_eq!(solve_definite(&mut Dense::identity(2).scaled(-1.0), &[1.0, 1.0]), None);
    }
}
