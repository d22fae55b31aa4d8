//! Positive definite matrices.

use fspid_lti::Matrix;

use fspid_numeric::rounding::sum_up;

use super::error::NotProved;
use super::exponential::{require_bounded, require_finite};
use super::factor::{cholesky, inverse};
use super::matrix::IntervalMatrix;

/// Proves that every symmetric matrix inside a square one is positive definite.
///
/// With the Cholesky factor R of the middle, computed in ordinary arithmetic, and $X \approx R^{-1}$,
/// the matrix $C = X^T S X$ is near the identity. If every such C, enclosed, has diagonal entries above
/// the sum of the absolute values of the others in their rows, all C are positive definite
/// (Gershgorin); then X is regular, because $X v = 0$ would make $v^T C v = 0$, and S is positive
/// definite as well. Nothing is assumed of R.
///
/// Units do not matter: a change of them by powers of two scales R and X exactly and leaves C as it is.
/// A condition number (in the best units) of some $10^{12}$ can still be told from singular.
///
/// # Source
/// S. M. Rump, *Verification of positive definiteness*, BIT 46 (2006) 433, for the idea to let a factor
/// in floating point carry a proof.
///
/// # Errors
/// [`NotProved`] for a matrix that is not square, has an entry without bounds, or could not be shown to
/// be positive definite.
pub fn prove_positive_definite(matrix: &IntervalMatrix) -> Result<(), NotProved> {
    prove_named("matrix", matrix)
}

/// As [`prove_positive_definite`], with the name of the matrix for errors.
pub(super) fn prove_named(what: &'static str, matrix: &IntervalMatrix) -> Result<(), NotProved> {
    matrix.require_shape(what, matrix.rows(), matrix.rows())?;
    require_bounded(what, matrix)?;
    let basis = basis(what, &matrix.middle, matrix.rows())?;
    dominant(what, &form(matrix, &basis)?)
}

/// $R^{-1}$ for the Cholesky factor R of a matrix, both in ordinary arithmetic. The matrix is, in this
/// basis, about the identity.
pub(super) fn basis(
    what: &'static str,
    middle: &[f64],
    size: usize,
) -> Result<IntervalMatrix, NotProved> {
    let factor = cholesky(middle, size).map_err(|stopped| NotProved::NoFactor {
        what,
        row: stopped.row,
        pivot: stopped.pivot,
    })?;
    let mut basis = IntervalMatrix::zeros(size, size);
    basis.middle = inverse(&factor, size);
    let finite = basis.middle.iter().all(|value| value.is_finite());
    if finite { Ok(basis) } else { Err(NotProved::NoFactor { what, row: 0, pivot: 0.0 }) }
}

/// $X^T S X$, as $X^T (S X)$.
pub(super) fn form(
    matrix: &IntervalMatrix,
    x: &IntervalMatrix,
) -> Result<IntervalMatrix, NotProved> {
    Ok(x.transpose().product(&matrix.product(x)?)?)
}

/// Proves that every diagonal entry is above the sum of the absolute values beside it.
pub(super) fn dominant(what: &'static str, matrix: &IntervalMatrix) -> Result<(), NotProved> {
    let size = matrix.columns.max(1);
    let magnitudes = matrix.magnitudes();
    for (row, sizes) in magnitudes.chunks(size).enumerate() {
        let diagonal = matrix.get(row, row).map_or(f64::NAN, |entry| entry.lower());
        let beside = sizes.iter().enumerate().filter(|&(column, _)| column != row);
        let others = beside.fold(0.0, |sum, (_, &size)| sum_up(sum, size));
        if !(diagonal > others) {
            return Err(NotProved::NotDominant { what, row, diagonal, others });
        }
    }
    Ok(())
}

/// A matrix as it is, if it is square, finite and symmetric to the bit.
pub(super) fn symmetric(what: &'static str, matrix: &Matrix) -> Result<IntervalMatrix, NotProved> {
    let size = matrix.rows();
    let exact = IntervalMatrix::from(matrix);
    exact.require_shape(what, size, size)?;
    require_finite(what, matrix)?;
    let places = (0..size).flat_map(|row| (0..row).map(move |column| (row, column)));
    for (row, column) in places {
        if exact.get(row, column) != exact.get(column, row) {
            return Err(NotProved::NotSymmetric { what, row, column });
        }
    }
    Ok(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagonal_that_is_as_large_as_what_stands_beside_it_shows_nothing() {
        let with = |beside: f64| {
            let rows = [[1.0, -beside], [beside, 1.0]];
            dominant("matrix", &IntervalMatrix::from(&Matrix::from_rows(&rows).expect("finite")))
        };
        assert_eq!(with(1.0_f64.next_down()), Ok(()));
        let expected =
            NotProved::NotDominant { what: "matrix", row: 0, diagonal: 1.0, others: 1.0 };
        assert_eq!(with(1.0), Err(expected));
    }
}
