//! Systems of linear equations, by elimination with row scaling and partial pivoting.

use crate::error::LtiError;
use crate::matrix::Matrix;

impl Matrix {
    /// Matrix X with A X = B, where A is this matrix.
    ///
    /// Rows are first scaled by powers of two, which is exact and makes the pivots comparable. A pivot below
    /// $n \varepsilon$ times its column counts as zero.
    ///
    /// # Source
    /// G. H. Golub and C. F. Van Loan, Matrix Computations, 4th edition, algorithm 3.4.1 and section 3.5.2.
    ///
    /// # Errors
    /// A matrix that is not square, a right side with another number of rows, an entry that is not finite, a matrix
    /// that is singular to working precision, a solution that overflows.
    pub fn solve(&self, right: &Self) -> Result<Self, LtiError> {
        self.require_square_and_finite("matrix of the equations")?;
        right.require_shape("right side", self.rows(), right.columns())?;
        LtiError::unless_finite("right side", right.data())?;
        let (mut left, mut right) = (self.clone(), right.clone());
        scale_rows(&mut left, &mut right);
        let columns: Vec<f64> =
            (0..left.columns()).map(|column| left.column_norm(column)).collect();
        for (column, &size) in columns.iter().enumerate() {
            bring_pivot(&mut left, &mut right, column, size)?;
            eliminate_below(&mut left, &mut right, column);
        }
        substitute_back(&left, &mut right);
        LtiError::unless_finite("solution of the equations", right.data())?;
        Ok(right)
    }
}

/// Multiplies each row of both sides by the power of two that brings its largest entry on the left to [1/2, 1).
fn scale_rows(left: &mut Matrix, right: &mut Matrix) {
    for row in 0..left.rows() {
        let largest =
            left.row(row).iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let (_, exponent) = libm::frexp(largest);
        scale_row(left, row, -exponent);
        scale_row(right, row, -exponent);
    }
}

fn scale_row(matrix: &mut Matrix, row: usize, exponent: i32) {
    for column in 0..matrix.columns() {
        *matrix.at_mut(row, column) = libm::scalbn(matrix.at(row, column), exponent);
    }
}

fn bring_pivot(
    left: &mut Matrix,
    right: &mut Matrix,
    column: usize,
    size: f64,
) -> Result<(), LtiError> {
    let mut best = column;
    for row in column + 1..left.rows() {
        if left.at(row, column).abs() > left.at(best, column).abs() {
            best = row;
        }
    }
    let pivot = left.at(best, column).abs();
    if pivot > left.rows() as f64 * f64::EPSILON * size {
        left.swap_rows(column, best);
        right.swap_rows(column, best);
        Ok(())
    } else {
        Err(LtiError::Singular { column, pivot })
    }
}

fn eliminate_below(left: &mut Matrix, right: &mut Matrix, pivot: usize) {
    for row in pivot + 1..left.rows() {
        let factor = left.at(row, pivot) / left.at(pivot, pivot);
        if factor != 0.0 {
            subtract_row(left, row, factor, pivot);
            subtract_row(right, row, factor, pivot);
        }
    }
}

fn subtract_row(matrix: &mut Matrix, row: usize, factor: f64, source: usize) {
    for column in 0..matrix.columns() {
        *matrix.at_mut(row, column) -= factor * matrix.at(source, column);
    }
}

fn substitute_back(left: &Matrix, right: &mut Matrix) {
    for row in (0..left.rows()).rev() {
        for column in 0..right.columns() {
            let known = (row + 1..left.rows())
                .fold(0.0, |sum, k| sum + left.at(row, k) * right.at(k, column));
            *right.at_mut(row, column) = (right.at(row, column) - known) / left.at(row, row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<const N: usize>(rows: &[[f64; N]]) -> Matrix {
        Matrix::from_rows(rows).expect("a test matrix is well formed")
    }

    #[test]
    fn a_system_that_needs_a_row_exchange_is_solved() {
        let left = matrix(&[[0.0, 2.0], [4.0, 1.0]]);
        assert_eq!(left.solve(&matrix(&[[6.0], [7.0]])), Matrix::from_rows(&[[1.0], [3.0]]));
    }

    #[test]
    fn rows_and_columns_of_very_different_size_are_no_reason_to_refuse() {
        let left = matrix(&[[1e150, 1e150], [1e-150, 2e-150]]);
        let x = left.solve(&matrix(&[[3e150], [5e-150]])).expect("the rows are independent");
        assert!((x.at(0, 0) - 1.0).abs() < 1e-14 && (x.at(1, 0) - 2.0).abs() < 1e-14);
        let left = matrix(&[[1.0, 0.0], [0.0, 1e-200]]);
        assert!(left.solve(&Matrix::identity(2)).is_ok());
    }

    #[test]
    fn dependent_rows_are_refused_even_when_rounding_hides_the_zero() {
        let exact = matrix(&[[1.0, 2.0], [2.0, 4.0]]).solve(&Matrix::identity(2));
        assert!(matches!(exact, Err(LtiError::Singular { column: 1, .. })));
        let rounded = matrix(&[[0.1, 0.2, 0.3], [0.3, 1.3, 0.7], [0.4, 1.5, 1.0]])
            .solve(&Matrix::identity(3));
        assert!(matches!(rounded, Err(LtiError::Singular { .. })));
        assert!(Matrix::zeros(2, 2).solve(&Matrix::identity(2)).is_err());
    }

    #[test]
    fn shapes_and_values_that_do_not_fit_are_refused() {
        assert!(Matrix::zeros(2, 3).solve(&Matrix::zeros(2, 1)).is_err());
        assert!(Matrix::identity(2).solve(&Matrix::zeros(3, 1)).is_err());
        let broken = Matrix::identity(2).scaled(f64::NAN);
        assert!(matches!(broken.solve(&Matrix::identity(2)), Err(LtiError::NotFinite { .. })));
        assert!(matches!(Matrix::identity(2).solve(&broken), Err(LtiError::NotFinite { .. })));
    }

    #[test]
    fn the_inverse_of_a_hilbert_matrix_is_the_integer_matrix_of_the_textbooks() {
        let hilbert = Matrix::from_function(4, 4, |i, j| 1.0 / (i + j + 1) as f64);
        let inverse =
            hilbert.solve(&Matrix::identity(4)).expect("a Hilbert matrix of order 4 is regular");
        let corner = inverse.at(3, 3);
        assert!((corner - 2800.0).abs() < 1e-9 * 2800.0, "{corner}");
    }
}
