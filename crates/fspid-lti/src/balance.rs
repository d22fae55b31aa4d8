//! Balancing: a diagonal change of units, by powers of two, after which rows and columns are of similar size.

use fspid_numeric::matrix::{balance as sweep, is_worthwhile};

use crate::matrix::Matrix;

/// Sweeps after which the matrix is taken as it is; two or three are usual.
const SWEEPS: usize = 100;

/// Replaces a square matrix A by $D^{-1} A D$ and returns the binary exponents of the diagonal D.
///
/// Exact, because every factor is a power of two. Rows or columns of zeros are left alone.
///
/// # Source
/// As [`fspid_numeric::matrix::balance`], with the Euclidean norms of R. James, J. Langou and B. R. Lowery,
/// arXiv 1401.5766.
pub(crate) fn balance(matrix: &mut Matrix) -> Vec<i32> {
    let mut exponents = vec![0; matrix.rows()];
    sweep(matrix.rows(), SWEEPS, |i| {
        let change = worthwhile_exponent(matrix, i);
        if change != 0 {
            rescale(matrix, i, change);
            exponents[i] += change;
        }
        change != 0
    });
    exponents
}

/// Exponent of the power of two nearest to the root of row over column, or 0 when it gains little.
fn worthwhile_exponent(matrix: &Matrix, i: usize) -> i32 {
    let size = matrix.rows();
    let column = (0..size).fold(0.0, |norm, row| libm::hypot(norm, matrix.at(row, i)));
    let row = (0..size).fold(0.0, |norm, column| libm::hypot(norm, matrix.at(i, column)));
    if !(column > 0.0 && row > 0.0 && column.is_finite() && row.is_finite()) {
        return 0;
    }
    let exponent = (libm::frexp(row).1 - libm::frexp(column).1) / 2;
    if is_worthwhile(row, column, exponent) { exponent } else { 0 }
}

/// Column i times 2^exponent, row i divided by it.
fn rescale(matrix: &mut Matrix, i: usize, exponent: i32) {
    for k in 0..matrix.rows() {
        *matrix.at_mut(k, i) = libm::scalbn(matrix.at(k, i), exponent);
    }
    for k in 0..matrix.columns() {
        *matrix.at_mut(i, k) = libm::scalbn(matrix.at(i, k), -exponent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_badly_scaled_matrix_becomes_even_and_the_exponents_undo_it() {
        let original = Matrix::from_rows(&[[1.0, 1e8], [1e-8, 2.0]]).expect("a well formed matrix");
        let mut balanced = original.clone();
        let exponents = balance(&mut balanced);
        assert!(balanced.norm_one() < 5.5, "{balanced:?}");
        let restored = Matrix::from_function(2, 2, |row, column| {
            libm::scalbn(balanced.at(row, column), exponents[row] - exponents[column])
        });
        assert_eq!(restored, original);
    }

    #[test]
    fn rows_or_columns_of_zeros_are_left_alone() {
        let original = Matrix::from_rows(&[[0.0, 1e9], [0.0, 0.0]]).expect("a well formed matrix");
        let mut balanced = original.clone();
        assert_eq!(balance(&mut balanced), vec![0, 0]);
        assert_eq!(balanced, original);
    }
}
