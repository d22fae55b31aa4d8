//! Stability of loops with long dead times: unstable poles are counted by winding number, at a cost linear in the number of
//! delay samples.
//!
//! A dead time is no state here but a power of z. What it multiplies is a small system, so that the closed loop's
//! poles are the zeros of
//!
//! $$ F(z) = \det(z I - A) - \sum_i z^{-n_i} c_i \operatorname{adj}(z I - A) b $$
//!
//! and how many of them lie outside a circle is how often F turns around 0 along it (`winding`). The coefficients are
//! proved, and so is every step along the circle: what is counted is counted, and what rounding hides is refused.
//!
//! Not here: margins and the poles themselves, but for the outermost one of a loop that grows.

mod characteristic;
mod outermost;
mod winding;

use crate::error::LtiError;
use crate::matrix::Matrix;
use characteristic::Characteristic;

/// As for eigenvalues: a pole this near to the unit circle is on neither side.
const EDGE: f64 = 1e-9;

/// A way from the states to what arrives at the input of a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct DelayedPath {
    /// Row from the states to what arrives.
    pub row: Vec<f64>,
    /// By how many samples later.
    pub samples: usize,
}

/// A sampled loop whose dead times are no states:
///
/// $$ x_{k+1} = A x_k + b \sum_i c_i x_{k - n_i} $$
///
/// # Example
/// A lag that is fed back a hundred seconds later holds for every gain below that of the lag, and for none above:
/// ```
/// use fspid_lti::{DelayedLoop, DelayedPath, LtiError, Matrix};
///
/// # fn main() -> Result<(), LtiError> {
/// let lag = Matrix::from_rows(&[[0.5]])?;
/// let behind = |gain: f64| {
///     let path = DelayedPath { row: vec![-0.5 * gain], samples: 10_000 };
///     DelayedLoop::new(&lag, &[1.0], &[path])
/// };
/// assert_eq!(behind(0.99)?.unstable_radius()?, None);
/// assert!(behind(1.01)?.unstable_radius()?.is_some_and(|radius| radius > 1.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct DelayedLoop {
    characteristic: Characteristic,
}

impl DelayedLoop {
    /// Most states beside the dead times: the coefficients take the fourth power of their number.
    pub const MOST_STATES: usize = 64;

    /// Loop of a state matrix, an input vector and the ways back.
    ///
    /// # Errors
    /// No states or more than [`Self::MOST_STATES`], a matrix that is not square, vectors of another length, an entry
    /// that is not finite.
    pub fn new(a: &Matrix, b: &[f64], paths: &[DelayedPath]) -> Result<Self, LtiError> {
        a.require_square_and_finite("state matrix")?;
        let order = a.rows();
        if order == 0 {
            return Err(LtiError::Empty { what: "state matrix" });
        }
        if order > Self::MOST_STATES {
            let (degree, limit) = (order, Self::MOST_STATES);
            return Err(LtiError::DegreeTooHigh {
                what: "loop beside its dead times",
                degree,
                limit,
            });
        }
        let rows = paths.iter().map(|path| ("output vector", path.row.as_slice()));
        for (what, vector) in rows.chain([("input vector", b)]) {
            if vector.len() != order {
                let found = (vector.len(), 1);
                return Err(LtiError::Shape { what, found, allowed: (order, 1) });
            }
            LtiError::unless_finite(what, vector)?;
        }
        Ok(Self { characteristic: Characteristic::new(a, b, paths)? })
    }

    /// How many poles of the closed loop lie outside the circle of a radius above 0, each as often as it is one.
    ///
    /// # Errors
    /// [`LtiError::undecided_radius`] where a pole lies so near to that circle that rounding hides its side, and
    /// [`LtiError::NotConverged`] where the circle takes too many steps.
    pub fn poles_outside(&self, radius: f64) -> Result<usize, LtiError> {
        Ok(self.characteristic.turns(radius)?.outside)
    }

    /// Spectral radius of a loop that is unstable, `None` for a stable one: as that of
    /// [`SampledLoop`](crate::SampledLoop::unstable_radius), whose dead times are states.
    ///
    /// # Errors
    /// A loop that is undecided ([`LtiError::undecided_radius`]), because a pole lies within 10⁻⁹ of the unit circle or
    /// because rounding hides on which side; a circle that takes too many steps.
    pub fn unstable_radius(&self) -> Result<Option<f64>, LtiError> {
        if self.poles_outside(1.0 + EDGE)? > 0 {
            return Ok(Some(self.characteristic.outermost(EDGE)));
        }
        match self.poles_outside(1.0 - EDGE)? {
            0 => Ok(None),
            _ => Err(LtiError::AtEdge { spectral_radius: 1.0 }),
        }
    }
}

#[cfg(test)]
mod tests;
