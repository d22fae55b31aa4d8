//! Cholesky factors in ordinary arithmetic. Nothing is proved here: what follows from a factor is
//! checked by whoever asked for it.

use fspid_numeric::matrix::{self, definite};

/// A symmetric matrix without a Cholesky factor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stopped {
    /// Row at which the factorisation ended.
    pub(super) row: usize,
    /// What should be above zero there.
    pub(super) pivot: f64,
    /// A direction x along which $x^T A x$ is about `pivot`.
    pub(super) direction: Vec<f64>,
}

/// The upper triangular R with $A = R^T R$, row after row; only the upper half of A is read.
pub(super) fn cholesky(matrix: &[f64], size: usize) -> Result<Vec<f64>, Stopped> {
    let mut lower = vec![0.0; size * size];
    let entry = |row: usize, column: usize| matrix[column * size + row];
    let done = matrix::cholesky(&mut lower, size, entry, definite);
    let upper: Vec<f64> = (0..size * size).map(|at| lower[at % size * size + at / size]).collect();
    done.map_err(|it| stopped(&upper, size, it.row, it.pivot))?;
    Ok(upper)
}

/// The direction $(-A_{11}^{-1} a, 1, 0)$, along which the form is the pivot $\alpha - a^T A_{11}^{-1} a$:
/// with $A_{11} = R^T R$ and column $r = R^{-T} a$ of the factor, its first part solves $R y = -r$.
fn stopped(factor: &[f64], size: usize, row: usize, pivot: f64) -> Stopped {
    let mut direction = vec![0.0; size];
    direction[row] = 1.0;
    for i in (0..row).rev() {
        let known: f64 = (i + 1..=row).map(|k| factor[i * size + k] * direction[k]).sum();
        direction[i] = -known / factor[i * size + i];
    }
    Stopped { row, pivot, direction }
}

/// The inverse of an upper triangular matrix with a diagonal that is not zero.
pub(super) fn inverse(upper: &[f64], size: usize) -> Vec<f64> {
    let mut inverse = vec![0.0; size * size];
    for j in 0..size {
        inverse[j * size + j] = 1.0 / upper[j * size + j];
        for i in (0..j).rev() {
            let known: f64 = (i + 1..=j).map(|k| upper[i * size + k] * inverse[k * size + j]).sum();
            inverse[i * size + j] = -known / upper[i * size + i];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_times_its_transpose_is_the_matrix_and_times_its_inverse_the_identity() {
        let matrix = [4.0, 2.0, -2.0, 2.0, 10.0, 2.0, -2.0, 2.0, 6.0];
        let factor = cholesky(&matrix, 3).expect("positive definite");
        assert_eq!(factor[..3], [2.0, 1.0, -1.0]);
        assert_eq!((factor[4], factor[5], factor[8]), (3.0, 1.0, 2.0));
        let inverse = inverse(&factor, 3);
        for (i, j) in (0..9).map(|place| (place / 3, place % 3)) {
            let entry: f64 = (0..3).map(|k| factor[i * 3 + k] * inverse[k * 3 + j]).sum();
            assert!((entry - if i == j { 1.0 } else { 0.0 }).abs() < 1e-15);
        }
    }

    #[test]
    fn an_indefinite_matrix_shows_a_direction_along_which_it_is_not_positive() {
        let matrix = [4.0, 2.0, 6.0, 2.0, 10.0, 2.0, 6.0, 2.0, 6.0];
        let stopped = cholesky(&matrix, 3).expect_err("indefinite");
        let x = &stopped.direction;
        let form: f64 = (0..9).map(|place| matrix[place] * x[place / 3] * x[place % 3]).sum();
        assert!(stopped.row == 2 && form < 0.0);
        assert!((form - stopped.pivot).abs() < 1e-14, "{form} {}", stopped.pivot);
        let broken = cholesky(&[f64::NAN], 1).expect_err("refused");
        assert!(broken.pivot.is_nan());
    }
}
