//! Loops that grow, with proof.

use fspid_lti::{LtiError, Matrix};

use super::definite::{basis, form, prove_named, symmetric};
use super::error::NotProved;
use super::exponential::require_bounded;
use super::factor::cholesky;
use super::matrix::IntervalMatrix;

/// Proves that $z_{k+1} = M z_k$ grows beyond all bounds from `x`, for every M inside `matrix`, whichever
/// is taken at each step.
///
/// Shown is that, for $V(z) = z^T P z$ with a symmetric P of any kind,
///
/// $$ M^T P M - P \succ 0, \qquad V(x) > 0 $$
///
/// By the first, V rises by at least $\varepsilon |z|^2$ at every step with some ε > 0. As V is above
/// zero at the start, it stays above, $|z|^2 \ge V / \lambda_{\max}(P)$, and so V grows at least by the
/// factor $1 + \varepsilon / \lambda_{\max}(P)$ each time. Give the product of a sequence of matrices to
/// prove that the sequence, repeated, makes the loop grow.
///
/// # Errors
/// [`NotProved`] where shapes do not fit, an entry is not finite, P is not symmetric, or one of the two
/// could not be shown.
pub fn prove_growth(matrix: &IntervalMatrix, p: &Matrix, x: &[f64]) -> Result<(), NotProved> {
    let own = symmetric("form", p)?;
    matrix.require_shape("matrix of the loop", own.rows(), own.rows())?;
    require_bounded("matrix of the loop", matrix)?;
    above_zero_along(&own, x)?;
    let difference = form(&own, matrix)?.difference(&own)?;
    require_bounded("difference of the forms", &difference)?;
    // First in the given basis and only to find a better one, in which less is lost to rounding.
    let basis = basis("difference of the forms", &difference.middle, own.rows())?;
    let after = form(&own, &matrix.product(&basis)?)?;
    prove_named("difference of the forms", &after.difference(&form(&own, &basis)?)?)
}

/// As [`prove_growth`], from a start that is looked for: a direction along which P is above zero.
/// Returned is the direction.
///
/// # Errors
/// As [`prove_growth`]; also where P has no such direction.
pub fn prove_unstable(matrix: &IntervalMatrix, p: &Matrix) -> Result<Vec<f64>, NotProved> {
    let negated: Vec<f64> = p.data().iter().map(|value| -value).collect();
    symmetric("form", p)?;
    // Where -P has no Cholesky factor, it is not positive along the direction that shows it.
    let Err(stopped) = cholesky(&negated, p.rows()) else {
        return Err(NotProved::NoDirection { found: f64::NEG_INFINITY });
    };
    prove_growth(matrix, p, &stopped.direction)?;
    Ok(stopped.direction)
}

fn above_zero_along(form: &IntervalMatrix, x: &[f64]) -> Result<(), NotProved> {
    if x.len() != form.rows() {
        let (found, allowed) = ((x.len(), 1), (form.rows(), 1));
        return Err(LtiError::Shape { what: "direction", found, allowed }.into());
    }
    let column: Vec<[f64; 1]> = x.iter().map(|&value| [value]).collect();
    let column = IntervalMatrix::from(&Matrix::from_rows(&column)?);
    let value = super::definite::form(form, &column)?.get(0, 0);
    let found = value.map_or(f64::NEG_INFINITY, |value| value.lower());
    if found > 0.0 { Ok(()) } else { Err(NotProved::NoDirection { found }) }
}
