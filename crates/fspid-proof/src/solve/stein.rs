//! The discrete Lyapunov equation, named after Stein.

use fspid_lti::Matrix;

use super::dense::Dense;
use super::symmetric::{pack, packed_len, unpack};

/// Squarings: 2^60 samples are more than any flight has.
const SQUARINGS_MAX: usize = 60;

/// Sum of all that a stable matrix leaves of a form: the P of $P - A^T P A = W$.
///
/// $$ P = \sum_{k=0}^{\infty} (A^T)^k W A^k, \quad P_{j+1} = P_j + (A^{2^j})^T P_j A^{2^j} $$
///
/// `None` where the sum does not converge.
///
/// # Source
/// R. A. Smith, Matrix equation XA + BX = C, SIAM J. Applied Mathematics 16 (1968) 198.
pub(super) fn stable_sum(a: &Dense, w: &Dense) -> Option<Dense> {
    let (mut sum, mut power) = (w.symmetric(), a.clone());
    for _ in 0..SQUARINGS_MAX {
        let more = sum.congruence(&power);
        sum.add(1.0, &more);
        if !sum.is_finite() {
            return None;
        }
        if more.norm() <= f64::EPSILON * sum.norm() {
            return Some(sum);
        }
        power = power.times(&power);
    }
    None
}

/// $\sum_k (A^T)^k W A^k$ in floats; `None` where the sum has no end.
#[must_use]
pub fn summed(a: &Matrix, w: &Matrix) -> Option<Matrix> {
    stable_sum(&Dense::from(a), &Dense::from(w))?.to_matrix()
}

/// The symmetric P of $A^T P A - s P = W$, by elimination on its entries; `None` when there is none or many.
pub(super) fn solution(a: &Dense, s: f64, w: &Dense) -> Option<Dense> {
    let (size, unknowns) = (a.rows, packed_len(a.rows));
    let columns: Vec<Vec<f64>> = (0..unknowns)
        .map(|unknown| {
            let mut unit = vec![0.0; unknowns];
            unit[unknown] = 1.0;
            let form = unpack(&unit, size);
            pack(&form.congruence(a).plus(-s, &form))
        })
        .collect();
    let left = Matrix::from_rows(&columns).ok()?.transpose();
    let right = Matrix::from_rows(&[pack(w)]).ok()?.transpose();
    Some(unpack(left.solve(&right).ok()?.data(), size))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangular() -> Dense {
        Dense::from_function(3, 3, |i, j| {
            if j > i {
                0.7
            } else if i == j {
                0.9 - 0.2 * i as f64
            } else {
                0.0
            }
        })
    }

    #[test]
    fn a_scalar_sum_is_the_geometric_series() {
        let one = Dense::identity(1);
        let sum = stable_sum(&one.scaled(0.5), &one).unwrap();
        assert!((sum[(0, 0)] - 4.0 / 3.0).abs() < 1e-15);
        assert_eq!(stable_sum(&one, &one), None);
    }

    #[test]
    fn both_ways_solve_the_equation() {
        let (a, w) = (triangular(), Dense::identity(3));
        let sum = stable_sum(&a, &w).unwrap();
        assert!(sum.plus(-1.0, &sum.congruence(&a)).plus(-1.0, &w).norm() < 1e-12);
        let same = solution(&a, 1.0, &w.scaled(-1.0)).unwrap();
        assert!(sum.plus(-1.0, &same).norm() < 1e-11 * sum.norm());
    }

    #[test]
    fn reciprocal_eigenvalues_leave_no_single_solution() {
        let a = Dense::from_function(2, 2, |i, j| [[2.0, 0.0], [0.0, 0.5]][i][j]);
        assert_eq!(solution(&a, 1.0, &Dense::identity(2)), None);
    }
}
