//! Zeros of a sampled loop.

use super::SampledLoop;
use crate::complex::{Complex, sort};
use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// Rounding of one product and sum, with room.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl SampledLoop {
    /// Finite zeros in the z plane, sorted as [`eigenvalues`](crate::eigenvalues()) does; none where L is 0 everywhere.
    ///
    /// With the output the last state alone, that state is 0 where the output is, and its equation is an output of the
    /// others: one state less each time, until the input appears in it.
    ///
    /// # Source
    /// A. Emami-Naeini, P. Van Dooren, Computation of zeros of linear multivariable systems, Automatica 18 (1982) 415.
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues()).
    pub fn zeros(&self) -> Result<Vec<Complex>, LtiError> {
        let Some(delay) = self.relative_degree() else {
            return Ok(Vec::new());
        };
        let (h, b, order) = (self.reduced.closed(0.0), self.reduced.b(), self.order() - delay);
        // In Hessenberg form the last equation has one output coefficient of the states before it, so that all steps
        // are of the same kind and the matrix stays as it is; a coefficient of 0 would cut off what lies before it.
        let feedback = h.at(order, order.saturating_sub(1)) / b[order];
        let rest = Matrix::from_function(order, order, |row, column| {
            let open = h.at(row, column);
            if column + 1 == order { open - b[row] * feedback } else { open }
        });
        let mut zeros = eigenvalues(&rest)?;
        for zero in &mut zeros {
            zero.re += 1.0;
        }
        sort(&mut zeros);
        Ok(zeros)
    }

    /// Poles less zeros: the samples after which an input is first seen in the output; `None` if it never is.
    ///
    /// The first $c A^{k-1} b$ that is more than the rounding of its own terms could be. States of a dead time hold
    /// exact zeros, and these survive here while a change of coordinates blurs them.
    fn relative_degree(&self) -> Option<usize> {
        let order = self.order();
        let (mut state, mut size) =
            (self.b.clone(), self.b.iter().map(|b| b.abs()).collect::<Vec<f64>>());
        for k in 1..=order {
            let terms = self.c.iter().zip(&state).zip(&size);
            let (value, bound) = terms.fold((0.0, 0.0), |(value, bound), ((c, state), size)| {
                (value + c * state, bound + c.abs() * size)
            });
            if f64::abs(value) > ROUNDING * (k * order) as f64 * bound {
                return Some(k);
            }
            let next = |row: usize| {
                let terms = self.a.row(row).iter().zip(&state).zip(&size);
                terms.fold((0.0, 0.0), |(next, bound), ((a, state), size)| {
                    (next + a * state, bound + a.abs() * size)
                })
            };
            (state, size) = (0..order).map(next).unzip();
        }
        None
    }
}
