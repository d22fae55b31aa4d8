//! Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's cyclic rotations.

/// A rotation of two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Cosine of the angle.
    pub cosine: f64,
    /// Sine of the angle.
    pub sine: f64,
}

impl Turn {
    /// The turn by an angle of this tangent, with the root of one plus its square.
    #[must_use]
    pub fn of_tangent(tangent: f64, root: f64) -> Self {
        let cosine = 1.0 / root;
        Self { cosine, sine: tangent * cosine }
    }

    fn apply(self, first: &mut f64, second: &mut f64) {
        let (a, b) = (*first, *second);
        *first = self.cosine * a - self.sine * b;
        *second = self.sine * a + self.cosine * b;
    }

    /// Turns two columns of a square matrix.
    fn columns(self, matrix: &mut [f64], size: usize, (p, q): (usize, usize)) {
        for row in matrix.chunks_exact_mut(size) {
            if let Ok([first, second]) = row.get_disjoint_mut([p, q]) {
                self.apply(first, second);
            }
        }
    }

    /// Turns two rows of a square matrix, p above q.
    fn rows(self, matrix: &mut [f64], size: usize, (p, q): (usize, usize)) {
        let Some((above, below)) = matrix.split_at_mut_checked(q * size) else { return };
        let first = above.iter_mut().skip(p * size).take(size);
        first.zip(below).for_each(|(first, second)| self.apply(first, second));
    }
}

/// How a symmetric matrix is made diagonal.
#[derive(Clone, Copy, Debug)]
pub struct Jacobi {
    /// Sweeps after which the rotations end in any case; the error squares with each one.
    pub sweeps: usize,
    /// The turn that makes an entry zero, from the two diagonal entries and itself; none where it is negligible.
    pub turn: fn([f64; 2], f64) -> Option<Turn>,
    /// Whether the entry is then set to zero, or what rounding leaves of it stays.
    pub clears: bool,
}

impl Jacobi {
    /// Turns `matrix` into a diagonal one, and the columns of `vectors` with it: from the identity, its eigenvectors.
    ///
    /// # Source
    /// C. G. J. Jacobi, 1846; G. H. Golub and C. F. Van Loan, *Matrix Computations*, 4th edition, section 8.5.
    pub fn diagonalise(&self, matrix: &mut [f64], vectors: &mut [f64], size: usize) {
        for _ in 0..self.sweeps {
            let mut turned = false;
            for p in 0..size {
                for q in p + 1..size {
                    turned |= self.rotate(matrix, vectors, size, (p, q));
                }
            }
            if !turned {
                break;
            }
        }
    }

    fn rotate(
        &self,
        matrix: &mut [f64],
        vectors: &mut [f64],
        size: usize,
        (p, q): (usize, usize),
    ) -> bool {
        let at = |row: usize, column: usize| row * size + column;
        let places = [at(p, p), at(q, q), at(p, q)];
        let [Some(first), Some(last), Some(beside)] = places.map(|at| matrix.get(at).copied())
        else {
            return false;
        };
        let Some(turn) = (self.turn)([first, last], beside) else { return false };
        turn.columns(matrix, size, (p, q));
        turn.columns(vectors, size, (p, q));
        turn.rows(matrix, size, (p, q));
        if self.clears {
            for place in [at(p, q), at(q, p)] {
                if let Some(entry) = matrix.get_mut(place) {
                    *entry = 0.0;
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::identity;
    use super::*;
    use std::vec::Vec;

    fn turn([first, last]: [f64; 2], beside: f64) -> Option<Turn> {
        if beside.abs() <= 1e-17 * libm::sqrt((first * last).abs()) {
            return None;
        }
        let theta = (last - first) / (2.0 * beside);
        let tangent = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
        Some(Turn::of_tangent(tangent, libm::hypot(tangent, 1.0)))
    }

    #[test]
    fn the_eigenvectors_put_the_matrix_together_again() {
        let n = 6;
        let hilbert: Vec<f64> = (0..n * n).map(|at| 1.0 / (1 + at / n + at % n) as f64).collect();
        for clears in [false, true] {
            let (mut values, mut vectors) = (hilbert.clone(), identity(n).collect::<Vec<_>>());
            Jacobi { sweeps: 40, turn, clears }.diagonalise(&mut values, &mut vectors, n);
            for (i, j) in (0..n * n).map(|at| (at / n, at % n)) {
                let part = |k: usize| values[k * n + k] * vectors[i * n + k] * vectors[j * n + k];
                let again: f64 = (0..n).map(part).sum();
                // A few roundings of numbers of at most 1.7.
                assert!((again - hilbert[i * n + j]).abs() < 1e-14, "{i} {j}");
            }
        }
    }
}
