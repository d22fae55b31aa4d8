//! Linear systems as first-order equations.

use crate::complex::Complex;
use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// A linear system with states x, inputs u and outputs y, continuous or sampled.
///
/// $$ \dot x = A x + B u, \quad y = C x + D u $$
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpace {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: Matrix,
}

impl StateSpace {
    /// System of four matrices whose shapes agree. A system without states is a gain.
    ///
    /// # Errors
    /// A state matrix that is not square, another matrix that does not fit it, an entry that is not finite.
    pub fn new(a: Matrix, b: Matrix, c: Matrix, d: Matrix) -> Result<Self, LtiError> {
        a.require_square_and_finite("state matrix")?;
        b.require_shape("input matrix", a.rows(), b.columns())?;
        c.require_shape("output matrix", c.rows(), a.rows())?;
        d.require_shape("feedthrough matrix", c.rows(), b.columns())?;
        LtiError::unless_finite("input matrix", b.data())?;
        LtiError::unless_finite("output matrix", c.data())?;
        LtiError::unless_finite("feedthrough matrix", d.data())?;
        Ok(Self { a, b, c, d })
    }

    /// System in the observability form: companion matrix of the monic denominator, Markov parameters as inputs.
    ///
    /// Both slices hold finite numbers: $a_{n-1} \dots a_0$ and $h_0 \dots h_n$.
    pub(crate) fn observability_form(denominator: &[f64], markov: &[f64]) -> Self {
        let states = denominator.len();
        let a = Matrix::from_function(states, states, |row, column| match row + 1 {
            next if next == states => -denominator[states - 1 - column],
            next if next == column => 1.0,
            _ => 0.0,
        });
        let b = Matrix::from_function(states, 1, |row, _| markov[row + 1]);
        let c = Matrix::from_function(1, states, |_, column| if column == 0 { 1.0 } else { 0.0 });
        let d = Matrix::from_function(1, 1, |_, _| markov[0]);
        Self { a, b, c, d }
    }

    /// The same form for numbers that are small parts of others: without its ones.
    pub(crate) fn observability_rest(denominator: &[f64], markov: &[f64]) -> Self {
        let mut rest = Self::observability_form(denominator, markov);
        let states = denominator.len();
        rest.a = Matrix::from_function(states, states, |row, column| {
            if row + 1 == states { -denominator[states - 1 - column] } else { 0.0 }
        });
        rest.c = Matrix::zeros(1, states);
        rest
    }

    /// State matrix: states by states.
    #[must_use]
    pub fn a(&self) -> &Matrix {
        &self.a
    }

    /// Input matrix: states by inputs.
    #[must_use]
    pub fn b(&self) -> &Matrix {
        &self.b
    }

    /// Output matrix: outputs by states.
    #[must_use]
    pub fn c(&self) -> &Matrix {
        &self.c
    }

    /// Feedthrough matrix: outputs by inputs.
    #[must_use]
    pub fn d(&self) -> &Matrix {
        &self.d
    }

    /// Number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.a.rows()
    }

    /// Number of inputs.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.b.columns()
    }

    /// Number of outputs.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.c.rows()
    }

    /// Eigenvalues of the state matrix, in rad/s for a continuous system; sorted as [`eigenvalues`] does.
    ///
    /// # Errors
    /// As [`eigenvalues`].
    pub fn poles(&self) -> Result<Vec<Complex>, LtiError> {
        eigenvalues(&self.a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_that_do_not_fit_are_refused_by_name() {
        let (two, column, row) = (Matrix::identity(2), Matrix::zeros(2, 1), Matrix::zeros(1, 2));
        let build = |a: &Matrix, b: &Matrix, c: &Matrix, d: &Matrix| {
            StateSpace::new(a.clone(), b.clone(), c.clone(), d.clone()).map_err(|error| match error
            {
                LtiError::Shape { what, .. } | LtiError::NotFinite { what, .. } => what,
                _ => "another error",
            })
        };
        let gain = Matrix::zeros(1, 1);
        assert!(build(&two, &column, &row, &gain).is_ok());
        assert_eq!(build(&column, &column, &row, &gain), Err("state matrix"));
        assert_eq!(build(&two, &row, &row, &gain), Err("input matrix"));
        assert_eq!(build(&two, &column, &column, &gain), Err("output matrix"));
        assert_eq!(build(&two, &column, &row, &row), Err("feedthrough matrix"));
        assert_eq!(build(&two, &column, &row, &gain.map(|_| f64::NAN)), Err("feedthrough matrix"));
        assert_eq!(build(&two, &column.map(|_| f64::INFINITY), &row, &gain), Err("input matrix"));
    }

    #[test]
    fn a_gain_is_a_system_without_states() {
        let gain = StateSpace::new(
            Matrix::zeros(0, 0),
            Matrix::zeros(0, 1),
            Matrix::zeros(1, 0),
            Matrix::identity(1),
        )
        .expect("a gain is a system");
        assert_eq!((gain.states(), gain.inputs(), gain.outputs()), (0, 1, 1));
        assert_eq!(gain.poles(), Ok(vec![]));
    }
}
