//! Small dense matrices for the inner loops of the solver: products, congruences, triangular factors.
//!
//! Products run along rows, so that the compiler may work on several entries at once without a change in
//! the order in which any one sum is added.

use core::ops::{Index, IndexMut};

use fspid_lti::Matrix;
use fspid_numeric::matrix::{cholesky, definite, identity};

/// A dense real matrix, row after row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dense {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) data: Vec<f64>,
}

impl Index<(usize, usize)> for Dense {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.data[row * self.columns + column]
    }
}

impl IndexMut<(usize, usize)> for Dense {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.data[row * self.columns + column]
    }
}

impl From<&Matrix> for Dense {
    fn from(matrix: &Matrix) -> Self {
        Self { rows: matrix.rows(), columns: matrix.columns(), data: matrix.data().to_vec() }
    }
}

impl Dense {
    pub(super) fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, data: vec![0.0; rows * columns] }
    }

    pub(super) fn identity(size: usize) -> Self {
        Self { rows: size, columns: size, data: identity(size).collect() }
    }

    pub(super) fn from_function(
        rows: usize,
        columns: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let mut matrix = Self::zeros(rows, columns);
        for row in 0..rows {
            for column in 0..columns {
                matrix[(row, column)] = entry(row, column);
            }
        }
        matrix
    }

    /// The matrix for the crate's neighbours; `None` when an entry is not finite.
    pub(super) fn to_matrix(&self) -> Option<Matrix> {
        let rows: Vec<&[f64]> = (0..self.rows).map(|row| self.row(row)).collect();
        Matrix::from_rows(&rows).ok()
    }

    pub(super) fn row(&self, row: usize) -> &[f64] {
        &self.data[row * self.columns..(row + 1) * self.columns]
    }

    pub(super) fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.data[row * self.columns..(row + 1) * self.columns]
    }

    pub(super) fn is_finite(&self) -> bool {
        self.data.iter().all(|value| value.is_finite())
    }

    pub(super) fn transpose(&self) -> Self {
        Self::from_function(self.columns, self.rows, |row, column| self[(column, row)])
    }

    /// This matrix times another.
    pub(super) fn times(&self, right: &Self) -> Self {
        let mut product = Self::zeros(self.rows, right.columns);
        for row in 0..self.rows {
            for (k, &factor) in self.row(row).iter().enumerate() {
                add_scaled(product.row_mut(row), factor, right.row(k));
            }
        }
        product
    }

    /// The transpose of this matrix times another.
    pub(super) fn transpose_times(&self, right: &Self) -> Self {
        let mut product = Self::zeros(self.columns, right.columns);
        for k in 0..self.rows {
            for (row, &factor) in self.row(k).iter().enumerate() {
                add_scaled(product.row_mut(row), factor, right.row(k));
            }
        }
        product
    }

    /// $T^T A T$ for this matrix A, made exactly symmetric.
    pub(super) fn congruence(&self, transform: &Self) -> Self {
        transform.transpose_times(&self.times(transform)).symmetric()
    }

    /// Mean of the matrix and its transpose.
    pub(super) fn symmetric(&self) -> Self {
        Self::from_function(self.rows, self.columns, |row, column| {
            0.5 * (self[(row, column)] + self[(column, row)])
        })
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        let data = self.data.iter().map(|value| factor * value).collect();
        Self { rows: self.rows, columns: self.columns, data }
    }

    /// Adds a multiple of another matrix of the same shape.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        add_scaled(&mut self.data, factor, &other.data);
    }

    /// This matrix plus a multiple of another.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.add(factor, other);
        sum
    }

    pub(super) fn times_vector(&self, x: &[f64]) -> Vec<f64> {
        (0..self.rows).map(|row| dot(self.row(row), x)).collect()
    }

    /// Sum of the products of the entries at the same places: the trace of $A^T B$.
    pub(super) fn inner(&self, other: &Self) -> f64 {
        dot(&self.data, &other.data)
    }

    /// Square root of the sum of the squares of the entries.
    pub(super) fn norm(&self) -> f64 {
        self.inner(self).sqrt()
    }

    pub(super) fn diagonal_max(&self) -> f64 {
        (0..self.rows).map(|i| self[(i, i)]).fold(0.0, f64::max)
    }

    /// Lower triangular L with $L L^T = A$; `None` unless every pivot is above zero.
    pub(super) fn cholesky(&self) -> Option<Self> {
        let mut lower = Self::zeros(self.rows, self.rows);
        let entry = |row, column| self[(row, column)];
        cholesky(&mut lower.data, self.rows, entry, definite).ok()?;
        Some(lower)
    }

    /// Inverse of a lower triangular matrix.
    pub(super) fn lower_inverse(&self) -> Self {
        let size = self.rows;
        let mut inverse = Self::zeros(size, size);
        for row in 0..size {
            let pivot = 1.0 / self[(row, row)];
            for k in 0..row {
                let (above, below) = inverse.data.split_at_mut(row * size);
                let factor = -self[(row, k)] * pivot;
                add_scaled(&mut below[..=k], factor, &above[k * size..k * size + k + 1]);
            }
            inverse[(row, row)] = pivot;
        }
        inverse
    }
}

pub(super) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).fold(0.0, |sum, (left, right)| sum + left * right)
}

/// Adds `factor * source` to `target`.
pub(super) fn add_scaled(target: &mut [f64], factor: f64, source: &[f64]) {
    for (target, source) in target.iter_mut().zip(source) {
        *target += factor * source;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[f64]]) -> Dense {
        Dense::from(&Matrix::from_rows(rows).unwrap())
    }

    fn near(left: &Dense, right: &Dense) -> bool {
        left.plus(-1.0, right).norm() < 1e-13
    }

    #[test]
    fn products_agree_with_hand_calculation() {
        let (left, right) =
            (matrix(&[&[1.0, 2.0], &[3.0, 4.0]]), matrix(&[&[1.0, -1.0], &[0.0, 2.0]]));
        assert!(near(&left.times(&right), &matrix(&[&[1.0, 3.0], &[3.0, 5.0]])));
        assert!(near(&left.transpose_times(&right), &left.transpose().times(&right)));
        assert!(near(&left.symmetric().congruence(&right), &matrix(&[&[1.0, 4.0], &[4.0, 7.0]])));
        assert!((left.inner(&right) - 7.0).abs() < 1e-15);
    }

    #[test]
    fn a_factor_multiplies_back_and_its_inverse_is_one() {
        let a = matrix(&[&[4.0, 2.0, -1.0], &[2.0, 5.0, 0.5], &[-1.0, 0.5, 3.0]]);
        let lower = a.cholesky().unwrap();
        assert!(near(&lower.times(&lower.transpose()), &a));
        assert!(near(&lower.lower_inverse().times(&lower), &Dense::identity(3)));
    }

    #[test]
    fn an_indefinite_or_broken_matrix_has_no_factor() {
        assert_eq!(matrix(&[&[1.0, 2.0], &[2.0, 1.0]]).cholesky(), None);
        assert_eq!(Dense::identity(2).scaled(f64::NAN).cholesky(), None);
        assert_eq!(Dense::zeros(2, 2).cholesky(), None);
        assert_eq!(Dense::identity(2).scaled(f64::INFINITY).to_matrix(), None);
    }
}
