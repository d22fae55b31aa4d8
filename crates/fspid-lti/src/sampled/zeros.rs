//! Zeros of a sampled loop.

use super::SampledLoop;
use crate::complex::{Complex, sort};
use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// A coefficient this small against its neighbours is one that rounding has left of a zero, for each state.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

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
        let (h, b) = (self.reduced.closed(0.0), self.reduced.b());
        let size = b.iter().fold(0.0, |size, &value| libm::hypot(size, value));
        let least = ROUNDING * self.order() as f64 * size;
        let Some(order) = (0..self.order()).rev().find(|&row| b[row].abs() > least) else {
            return Ok(Vec::new());
        };
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
}
