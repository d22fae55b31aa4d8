//! Eigenvalues and eigenvectors of a symmetric matrix, for the covariances of an optimiser.

use fspid_numeric::matrix::{self, Jacobi, Turn};

/// Ten sweeps are rarely needed.
const ROTATIONS: Jacobi = Jacobi { sweeps: 60, turn, clears: true };

/// Eigenvalues, and the eigenvectors as columns, both in the order of the axes they grew from.
///
/// `matrix` is symmetric, row after row, `n` by `n`.
pub(super) fn symmetric(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut a, mut vectors) = (matrix.to_vec(), identity(n));
    ROTATIONS.diagonalise(&mut a, &mut vectors, n);
    ((0..n).map(|i| a[i * n + i]).collect(), vectors)
}

pub(super) fn identity(n: usize) -> Vec<f64> {
    matrix::identity(n).collect()
}

/// The turn that makes an entry zero; none when it is nothing beside the diagonal already.
fn turn([first, last]: [f64; 2], entry: f64) -> Option<Turn> {
    let negligible = 1e-17 * (first * last).abs().sqrt();
    if !(entry.abs() > negligible) {
        return None;
    }
    let theta = (last - first) / (2.0 * entry);
    let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    Some(Turn::of_tangent(tangent, (tangent * tangent + 1.0).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eigenvectors_put_the_matrix_together_again() {
        let n = 6;
        let entry = |i: usize, j: usize| 1.0 / (1.0 + i as f64 + j as f64);
        let hilbert: Vec<f64> = (0..n * n).map(|at| entry(at / n, at % n)).collect();
        let (values, vectors) = symmetric(&hilbert, n);
        for i in 0..n {
            for j in 0..n {
                let again: f64 =
                    (0..n).map(|k| values[k] * vectors[i * n + k] * vectors[j * n + k]).sum();
                // A few roundings of numbers of at most 1.7.
                assert!((again - hilbert[i * n + j]).abs() < 1e-14, "{i} {j}");
            }
        }
    }

    #[test]
    fn the_second_difference_has_its_known_eigenvalues() {
        let n: usize = 5;
        let entry = |at: usize| match (at / n).abs_diff(at % n) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let (mut values, _) = symmetric(&(0..n * n).map(entry).collect::<Vec<_>>(), n);
        values.sort_by(f64::total_cmp);
        for (k, value) in values.iter().enumerate() {
            let angle = std::f64::consts::PI * (k + 1) as f64 / (n + 1) as f64;
            assert!((value - (2.0 - 2.0 * libm::cos(angle))).abs() < 1e-14);
        }
    }
}
