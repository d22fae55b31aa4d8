//! Optimal state feedback: the algebraic equation of Riccati.

use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// Steps of the matrix sign function; ten are usual.
const STEPS_MAX: usize = 60;

/// Change of the sign function, relative to its size, at which it is done.
const CONVERGED: f64 = 1e-13;

/// State feedback $u = -K x$ that is optimal for a quadratic cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Regulator {
    /// Gain K, a row for each input.
    pub gain: Matrix,
    /// Cost from a state on: $x^T P x$.
    pub cost: Matrix,
}

/// Feedback that makes the least of states and inputs.
///
/// $$ \min_u \int_0^\infty x^T Q x + u^T R u \ dt, \quad \dot x = A x + B u, \quad K = R^{-1} B^T P, $$
/// $$ A^T P + P A - P B R^{-1} B^T P + Q = 0 $$
///
/// P comes from the stable half of the Hamiltonian matrix, which its matrix sign function S picks out:
///
/// $$ S = \operatorname{sgn} \begin{pmatrix} A & -B R^{-1} B^T \cr -Q & -A^T \end{pmatrix}, \quad
///    (S + I) \begin{pmatrix} I \cr P \end{pmatrix} = 0 $$
///
/// # Source
/// J. D. Roberts, Linear model reduction and solution of the algebraic Riccati equation by use of the sign function,
/// Int. J. Control 32 (1980) 677 (report of 1971).
///
/// # Errors
/// Shapes that do not fit, entries that are not finite, an R that is singular; a system that no feedback makes stable,
/// or with a neutral mode that costs nothing.
pub fn regulator(a: &Matrix, b: &Matrix, q: &Matrix, r: &Matrix) -> Result<Regulator, LtiError> {
    let states = a.rows();
    a.require_square_and_finite("state matrix")?;
    b.require_shape("input matrix", states, b.columns())?;
    q.require_shape("weight of the states", states, states)?;
    r.require_shape("weight of the inputs", b.columns(), b.columns())?;
    let feedback = r.solve(&b.transpose())?;
    let sign =
        sign(hamiltonian(a, &b.product(&feedback)?, q)).map_err(|_| LtiError::NotStabilisable)?;
    let cost = stable_half(&sign, states).map_err(|_| LtiError::NotStabilisable)?;
    let gain = feedback.product(&cost)?;
    let closed = a.sum(&b.product(&gain)?.scaled(-1.0))?;
    if eigenvalues(&closed)?.iter().all(|pole| pole.re < 0.0) {
        Ok(Regulator { gain, cost })
    } else {
        Err(LtiError::NotStabilisable)
    }
}

fn hamiltonian(a: &Matrix, reach: &Matrix, q: &Matrix) -> Matrix {
    let states = a.rows();
    Matrix::from_function(2 * states, 2 * states, |row, column| {
        match (row.checked_sub(states), column.checked_sub(states)) {
            (None, None) => a.at(row, column),
            (None, Some(right)) => -reach.at(row, right),
            (Some(below), None) => -q.at(below, column),
            (Some(below), Some(right)) => -a.at(right, below),
        }
    })
}

/// Newton's iteration $Z \leftarrow \tfrac12 (c Z + (c Z)^{-1})$ with $c^2 = \lVert Z^{-1} \rVert / \lVert Z \rVert$.
fn sign(mut value: Matrix) -> Result<Matrix, LtiError> {
    for _ in 0..STEPS_MAX {
        let inverse = value.solve(&Matrix::identity(value.rows()))?;
        let scale = (inverse.norm_one() / value.norm_one()).sqrt();
        // Near the end scaling would only stir the rounding.
        let scale = if (scale - 1.0).abs() < 1e-2 { 1.0 } else { scale };
        let next = value.scaled(0.5 * scale).sum(&inverse.scaled(0.5 / scale))?;
        let change = next.sum(&value.scaled(-1.0))?.norm_one();
        let done = change <= CONVERGED * next.norm_one();
        value = next;
        if done {
            return Ok(value);
        }
    }
    Err(LtiError::NotConverged { what: "matrix sign function", iterations: STEPS_MAX })
}

/// P of $(S + I)(I; P) = 0$, which is twice as many equations as needed: by least squares, made symmetric.
fn stable_half(sign: &Matrix, states: usize) -> Result<Matrix, LtiError> {
    let plus =
        |row: usize, column: usize| sign.at(row, column) + if row == column { 1.0 } else { 0.0 };
    let left = Matrix::from_function(2 * states, states, |row, column| plus(row, states + column));
    let right = Matrix::from_function(2 * states, states, |row, column| -plus(row, column));
    let normal = left.transpose().product(&left)?;
    let cost = normal.solve(&left.transpose().product(&right)?)?;
    Ok(cost.sum(&cost.transpose())?.scaled(0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<const N: usize>(rows: &[[f64; N]]) -> Matrix {
        Matrix::from_rows(rows).expect("a test matrix is well formed")
    }

    #[test]
    fn one_state_has_the_root_of_a_quadratic_equation() {
        // 2 a p − p² b²/r + q = 0 with a = 1, b = 2, q = 3, r = 4: p = 1 + 2.
        let one = |value: f64| matrix(&[[value]]);
        let found = regulator(&one(1.0), &one(2.0), &one(3.0), &one(4.0)).expect("a regulator");
        assert!((found.cost.at(0, 0) - 3.0).abs() < 1e-13);
        assert!((found.gain.at(0, 0) - 1.5).abs() < 1e-13);
    }

    #[test]
    fn a_double_integrator_gets_the_damping_of_butterworth() {
        let (a, b) = (matrix(&[[0.0, 1.0], [0.0, 0.0]]), matrix(&[[0.0], [1.0]]));
        let q = matrix(&[[1.0, 0.0], [0.0, 0.0]]);
        let found = regulator(&a, &b, &q, &Matrix::identity(1)).expect("a regulator");
        assert!((found.gain.at(0, 0) - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.gain.at(0, 1) - 2.0_f64.sqrt()).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn systems_that_cannot_be_held_are_refused() {
        let (a, b) = (matrix(&[[1.0, 0.0], [0.0, -1.0]]), matrix(&[[0.0], [1.0]]));
        let found = regulator(&a, &b, &Matrix::identity(2), &Matrix::identity(1));
        assert_eq!(found, Err(LtiError::NotStabilisable));
        // A neutral mode that costs nothing stays where it is.
        let found = regulator(
            &Matrix::zeros(1, 1),
            &Matrix::identity(1),
            &Matrix::zeros(1, 1),
            &Matrix::identity(1),
        );
        assert_eq!(found, Err(LtiError::NotStabilisable));
        let shapes = regulator(&a, &b, &Matrix::identity(1), &Matrix::identity(1));
        assert!(matches!(shapes, Err(LtiError::Shape { .. })));
    }
}
