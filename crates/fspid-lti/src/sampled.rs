//! Sampled loops with negative feedback.

use crate::error::LtiError;
use crate::matrix::Matrix;

/// An open loop $L(z) = c (z I - A)^{-1} b$ with negative feedback.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledLoop {
    a: Matrix,
    b: Vec<f64>,
    c: Vec<f64>,
    dt_s: f64,
}

impl SampledLoop {
    /// A loop of matrices whose shapes agree.
    ///
    /// # Errors
    /// Shapes that do not agree.
    pub fn new(a: Matrix, b: Vec<f64>, c: Vec<f64>, dt_s: f64) -> Result<Self, LtiError> {
        a.require_square_and_finite("state matrix")?;
        Ok(Self { a, b, c, dt_s })
    }

    /// The matrix of the closed loop, $A - b c$.
    #[must_use]
    pub fn closed_matrix(&self) -> Matrix {
        Matrix::from_function(self.a.rows(), self.a.rows(), |row, column| {
            self.a.at(row, column) - self.b[row] * self.c[column]
        })
    }

    /// Sample period, s.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }
}
