//! Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's cyclic rotations (Golub and Van
//! Loan, Matrix Computations, 4th edition, section 8.5), for the covariances of an optimiser.

/// Sweeps after which the rotations end in any case; ten are rarely needed.
const SWEEPS: usize = 60;

/// Eigenvalues, and the eigenvectors as columns, both in the order of the axes they grew from.
///
/// `matrix` is symmetric, row after row, `n` by `n`.
pub(super) fn symmetric(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix.to_vec();
    let mut vectors = identity(n);
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                rotated |= rotate(&mut a, &mut vectors, n, (p, q));
            }
        }
        if !rotated {
            break;
        }
    }
    ((0..n).map(|i| a[i * n + i]).collect(), vectors)
}

pub(super) fn identity(n: usize) -> Vec<f64> {
    (0..n * n).map(|at| if at % (n + 1) == 0 { 1.0 } else { 0.0 }).collect()
}

/// Makes the entry (p, q) zero; false when it is nothing beside the diagonal already.
fn rotate(a: &mut [f64], vectors: &mut [f64], n: usize, (p, q): (usize, usize)) -> bool {
    let (app, aqq, apq) = (a[p * n + p], a[q * n + q], a[p * n + q]);
    let negligible = 1e-17 * (app * aqq).abs().sqrt();
    if !(apq.abs() > negligible) {
        return false;
    }
    let theta = (aqq - app) / (2.0 * apq);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..n {
        let (akp, akq) = (a[k * n + p], a[k * n + q]);
        a[k * n + p] = c * akp - s * akq;
        a[k * n + q] = s * akp + c * akq;
    }
    for k in 0..n {
        let (apk, aqk) = (a[p * n + k], a[q * n + k]);
        a[p * n + k] = c * apk - s * aqk;
        a[q * n + k] = s * apk + c * aqk;
        let (vkp, vkq) = (vectors[k * n + p], vectors[k * n + q]);
        vectors[k * n + p] = c * vkp - s * vkq;
        vectors[k * n + q] = s * vkp + c * vkq;
    }
    (a[p * n + q], a[q * n + p]) = (0.0, 0.0);
    true
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
