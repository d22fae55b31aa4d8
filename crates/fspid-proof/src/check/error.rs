//! Why something was not proved.

use fspid_lti::LtiError;
use fspid_sim::SimError;

/// Why a statement could not be proved. It may be false, or true by less than rounding can tell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotProved {
    /// An entry without bounds: NaN, infinite, or beyond the range of floats.
    #[error(
        "entry ({row}, {column}) of the {what} has no bounds; every entry must be a finite number"
    )]
    Unbounded {
        /// Which matrix.
        what: &'static str,
        /// Row, counted from 0.
        row: usize,
        /// Column, counted from 0.
        column: usize,
    },
    /// A matrix that differs from its transpose.
    #[error("the {what} is not symmetric: entries ({row}, {column}) and ({column}, {row}) differ")]
    NotSymmetric {
        /// Which matrix.
        what: &'static str,
        /// Row, counted from 0.
        row: usize,
        /// Column, counted from 0.
        column: usize,
    },
    /// A matrix that has no Cholesky factor in ordinary arithmetic.
    #[error(
        "the {what} is not positive definite to working precision: its Cholesky factor ends at row {row} with the pivot {pivot:e}"
    )]
    NoFactor {
        /// Which matrix.
        what: &'static str,
        /// Row, counted from 0.
        row: usize,
        /// What should be above zero there.
        pivot: f64,
    },
    /// A matrix that no bound shows to be positive definite.
    #[error(
        "the {what} could not be shown to be positive definite: in row {row} of its scaled form the diagonal is at least {diagonal:e}, the others add up to {others:e}"
    )]
    NotDominant {
        /// Which matrix.
        what: &'static str,
        /// Row of the scaled matrix, counted from 0.
        row: usize,
        /// Least diagonal entry there.
        diagonal: f64,
        /// Largest sum of the absolute values of the other entries there.
        others: f64,
    },
    /// A direction along which a form is not above zero.
    #[error("the form is at least {found:e} along the direction given; it must be above zero")]
    NoDirection {
        /// Lower bound of the form.
        found: f64,
    },
    /// A quantity that may be beyond its limit.
    #[error("limit {row} on the ellipsoid: up to {found:e} is reached, allowed is {limit:e}")]
    BeyondLimit {
        /// Number of the limit, counted from 0.
        row: usize,
        /// Largest value that could not be excluded.
        found: f64,
        /// The limit.
        limit: f64,
    },
    /// Gains that remember, which may leave the box that is claimed near rest.
    #[error(
        "gains that remember are not shown to stay in the box that is claimed near rest, or it is not within their limits"
    )]
    NotKept,
    /// A number that is not allowed.
    #[error("{what} is {found:?}; allowed is {allowed}")]
    Number {
        /// Which number.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// Shapes that do not fit.
    #[error(transparent)]
    Shape(#[from] LtiError),
    /// A plant that is refused.
    #[error(transparent)]
    Plant(#[from] SimError),
}

/// `value` if it is finite and above zero.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, NotProved> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(NotProved::Number { what, found: value, allowed: "a finite number above 0" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_says_what_was_found_and_what_is_allowed() {
        let number = positive("limit", f64::NAN).expect_err("refused");
        assert_eq!(number.to_string(), "limit is NaN; allowed is a finite number above 0");
        let shape = NotProved::from(LtiError::Shape {
            what: "right factor",
            found: (1, 2),
            allowed: (2, 2),
        });
        assert!(shape.to_string().starts_with("the right factor is 1 by 2"));
    }
}
