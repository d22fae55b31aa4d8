//! Matrices with twice the working precision, for what is small beside 1 and must not be rounded.

use crate::error::LtiError;
use crate::matrix::Matrix;

/// A matrix as a sum of two, the second below the last digits of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct FineMatrix {
    high: Matrix,
    low: Matrix,
}

impl FineMatrix {
    /// The sum of two matrices of one shape.
    ///
    /// # Errors
    /// Shapes that differ; an entry that is not finite.
    pub fn new(high: Matrix, low: Matrix) -> Result<Self, LtiError> {
        low.require_shape("lower part of a matrix", high.rows(), high.columns())?;
        LtiError::unless_finite("upper part of a matrix", high.data())?;
        LtiError::unless_finite("lower part of a matrix", low.data())?;
        Ok(Self { high, low })
    }

    /// The matrix, rounded.
    #[must_use]
    pub fn high(&self) -> &Matrix {
        &self.high
    }

    /// What the rounding left out.
    #[must_use]
    pub fn low(&self) -> &Matrix {
        &self.low
    }

    /// Rows and columns by a function that answers both parts of an entry.
    pub(crate) fn from_function(
        (rows, columns): (usize, usize),
        entry: impl Fn(usize, usize) -> [f64; 2],
    ) -> Self {
        let high = Matrix::from_function(rows, columns, |row, column| entry(row, column)[0]);
        let low = Matrix::from_function(rows, columns, |row, column| entry(row, column)[1]);
        Self { high, low }
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> [f64; 2] {
        [self.high.at(row, column), self.low.at(row, column)]
    }
}

impl From<Matrix> for FineMatrix {
    fn from(high: Matrix) -> Self {
        let low = Matrix::zeros(high.rows(), high.columns());
        Self { high, low }
    }
}
