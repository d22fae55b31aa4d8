//! Error bounds of computed poles: can a loop be called stable or unstable in spite of rounding?

use super::reduced::Reduced;
use crate::complex::{Complex, modulus, quotient};

impl Reduced {
    /// How far rounding may move so many of the outermost closed-loop poles, as a share of their distance from the unit circle.
    ///
    /// $$ \varepsilon \lVert E \rVert \max_\theta \lVert ((e^{j \theta} - 1) I - E)^{-1} \rVert $$
    ///
    /// with Frobenius' norms, at the angles θ of these poles. Eigenvalues are those of a matrix that differs by about
    /// $\varepsilon \lVert E \rVert$, and a pole can only cross the circle where that much makes the inverse infinite.
    ///
    /// # Source
    /// L. N. Trefethen, M. Embree, Spectra and Pseudospectra, Princeton 2005, section 2.
    pub(super) fn rounding_share(&self, poles: &[Complex], asked: usize) -> f64 {
        let mut outer: Vec<Complex> = poles.iter().copied().filter(|pole| pole.im >= 0.0).collect();
        outer.sort_by(|left, right| modulus(*right).total_cmp(&modulus(*left)));
        let norm =
            self.closed(1.0).data().iter().fold(0.0, |norm, &entry| libm::hypot(norm, entry));
        let shares = outer.iter().take(asked).filter(|pole| modulus(**pole) > 0.0).map(|&pole| {
            let zeta = pole / modulus(pole) - 1.0;
            f64::EPSILON * norm * self.inverse_norm(zeta)
        });
        // A NaN is no share that anybody could rely on.
        shares.fold(0.0, |largest, share| if share <= largest { largest } else { share })
    }

    /// Frobenius' norm of $(\zeta I - E)^{-1}$.
    fn inverse_norm(&self, zeta: Complex) -> f64 {
        let (n, zero) = (self.order(), Complex::new(0.0, 0.0));
        let width = 2 * n;
        let closed = self.closed(1.0);
        let mut rows: Vec<Complex> = Vec::with_capacity(n * width);
        for row in 0..n {
            let own = (0..n).map(|column| {
                let diagonal = if row == column { zeta } else { zero };
                diagonal - closed.at(row, column)
            });
            rows.extend(own);
            rows.extend(
                (0..n).map(|column| Complex::new(if row == column { 1.0 } else { 0.0 }, 0.0)),
            );
        }
        for k in 0..n - 1 {
            let (above, below) = rows.split_at_mut((k + 1) * width);
            let (upper, lower) = (&mut above[k * width..], &mut below[..width]);
            if lower[k].norm_sqr() > upper[k].norm_sqr() {
                upper.swap_with_slice(lower);
            }
            if lower[k] != zero {
                let factor = quotient(lower[k], upper[k]);
                for (lower, upper) in lower[k..].iter_mut().zip(&upper[k..]) {
                    *lower -= factor * upper;
                }
            }
        }
        let mut sum = 0.0;
        for column in n..width {
            let mut solution = vec![zero; n];
            for row in (0..n).rev() {
                let known = (row + 1..n).fold(rows[row * width + column], |sum, k| {
                    sum - rows[row * width + k] * solution[k]
                });
                solution[row] = quotient(known, rows[row * width + row]);
            }
            sum += solution.iter().map(|value| value.norm_sqr()).sum::<f64>();
        }
        sum.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use crate::complex::Complex;
    use crate::error::LtiError;
    use crate::matrix::Matrix;
    use crate::sampled::{SampledLoop, Stability};

    const STATES: usize = 5;

    /// A reflection mixes entries of 1 with one of 2e-16, which rounding then takes away.
    fn mirror() -> Matrix {
        Matrix::from_function(STATES, STATES, |row, column| {
            (if row == column { 1.0 } else { 0.0 }) - 2.0 / STATES as f64
        })
    }

    /// Five lags of a thousand samples in a chain, $L = g / (z - 1 - d)^5$, in states that a matrix turns.
    fn chain(turn: &Matrix, distance: f64) -> SampledLoop {
        let a =
            Matrix::from_function(STATES, STATES, |row, column| match column.checked_sub(row) {
                Some(0) => 1.0 + distance,
                Some(1) => 1.0,
                _ => 0.0,
            });
        let back = turn.transpose();
        let turned = back.product(&a).and_then(|a| a.product(turn)).expect("fits");
        let b = (0..STATES).map(|row| back.at(row, STATES - 1)).collect();
        let c = (0..STATES).map(|column| 2e-16 * turn.at(0, column)).collect();
        SampledLoop::new(turned, b, c, 0.01).expect("a loop")
    }

    #[test]
    fn poles_that_rounding_may_carry_across_the_circle_make_no_stable_loop() {
        let natural = chain(&Matrix::identity(STATES), -1e-3);
        assert!(matches!(natural.margins(), Ok(Stability::Stable(_))), "{natural:?}");
        let mixed = chain(&mirror(), -1e-3);

        assert!(matches!(mixed.margins(), Err(LtiError::Blurred { .. })), "{:?}", mixed.margins());
        assert!(mixed.peak_sensitivity().is_err() && mixed.bandwidth_rad_s().is_none());
    }

    /// An integrator with a gain: its pole is 1 - k.
    #[test]
    fn what_is_at_the_edge_is_neither_stable_nor_unstable() {
        let asked = |gain: f64| {
            let open = SampledLoop::new(Matrix::identity(1), vec![1.0], vec![gain], 1.0);
            open.expect("a loop").unstable_radius()
        };
        assert_eq!(asked(1e-6), Ok(None));
        assert!(matches!(asked(-1e-6), Ok(Some(radius)) if radius > 1.0));
        for gain in [0.0, 5e-10, -5e-10] {
            let error = asked(gain).expect_err("at the edge");
            assert!(matches!(error, LtiError::AtEdge { .. }), "{error}");
            assert!(error.undecided_radius().is_some_and(|radius| (radius - 1.0).abs() < 1e-9));
        }
    }

    /// Unstable by less than rounding moves its poles.
    #[test]
    fn poles_that_rounding_may_carry_back_make_no_unstable_loop() {
        let mixed = chain(&mirror(), 1e-3).unstable_radius();
        assert!(matches!(mixed, Err(LtiError::Blurred { .. })), "{mixed:?}");
        assert!(matches!(chain(&Matrix::identity(STATES), 1e-3).unstable_radius(), Ok(Some(_))));
    }

    #[test]
    fn a_refusal_says_how_far_rounding_reaches() {
        let poles = |share: f64| LtiError::Blurred { spectral_radius: 0.99, share, allowed: 0.1 };
        assert!(poles(0.5).to_string().contains("by 0.5 of their distance"));
    }

    /// The same norm by the real system of twice the order.
    fn inverse_norm(matrix: &Matrix, zeta: Complex) -> f64 {
        let n = matrix.rows();
        let doubled = Matrix::from_function(2 * n, 2 * n, |row, column| {
            let own = if row % n == column % n { 1.0 } else { 0.0 };
            match (row < n, column < n) {
                (true, false) => -own * zeta.im,
                (false, true) => own * zeta.im,
                _ => own * zeta.re - matrix.at(row % n, column % n),
            }
        });
        let inverse = doubled.solve(&Matrix::identity(2 * n)).expect("regular");
        (0.5 * inverse.data().iter().map(|entry| entry * entry).sum::<f64>()).sqrt()
    }

    #[test]
    fn the_norm_of_an_inverse_is_that_of_another_elimination() {
        // Entries of the last rows are larger, so that rows change places.
        for (order, zeta) in [(1, (0.5, 0.2)), (2, (-0.1, 0.3)), (4, (0.3, -0.7)), (6, (2.0, 0.0))]
        {
            let a = Matrix::from_function(order, order, |row, column| {
                libm::sin((3 * row * row + 7 * column + row * column) as f64) * (1 + row) as f64
            });
            let (b, c) = (vec![1.0; order], vec![0.5; order]);
            let open = SampledLoop::new(a, b, c, 1.0).expect("a loop");
            let zeta = Complex::new(zeta.0, zeta.1);
            let found = open.reduced.inverse_norm(zeta);
            let expected = inverse_norm(&open.reduced.closed(1.0), zeta);
            assert!((found / expected - 1.0).abs() < 1e-12, "{order}: {found} {expected}");
        }
    }

    #[test]
    fn the_share_is_that_of_the_distance_for_a_single_pole() {
        // One state: ε |δ| / |distance|, with δ = p − 1.
        let open =
            SampledLoop::new(Matrix::identity(1), vec![1.0], vec![0.25], 1.0).expect("a loop");
        let poles = open.closed_poles().expect("a pole");
        let share = open.reduced.rounding_share(&poles, 1);
        assert!((share / f64::EPSILON - 1.0).abs() < 1e-14, "{share}");
    }
}
