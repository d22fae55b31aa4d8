//! What can be wrong with a linear system, as one enum whose variants hold the values found and allowed.

use thiserror::Error;

use crate::in_words::InWords;

/// Why a linear system could not be built or a question about it not be answered.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum LtiError {
    /// A list of coefficients without any.
    #[error("the {what} has no coefficients; it needs at least one")]
    Empty {
        /// Which polynomial.
        what: &'static str,
    },
    /// An entry that is NaN or infinite.
    #[error("entry {index} of the {what} is {}; every entry must be a finite number", InWords(*value))]
    NotFinite {
        /// Which polynomial or matrix.
        what: &'static str,
        /// Position in the list, or in the matrix row after row, counted from 0.
        index: usize,
        /// What was found there.
        value: f64,
    },
    /// A polynomial that vanishes everywhere.
    #[error("the {what} is zero everywhere; at least one coefficient must differ from zero")]
    ZeroPolynomial {
        /// Which polynomial.
        what: &'static str,
    },
    /// Zeros in front of the first coefficient that counts.
    #[error(
        "the {what} begins with zeros ({zeros} of them); its first coefficient belongs to the highest power and must differ from zero"
    )]
    LeadingZero {
        /// Which polynomial.
        what: &'static str,
        /// How many coefficients in front are zero.
        zeros: usize,
    },
    /// A degree beyond [`DEGREE_LIMIT`](crate::DEGREE_LIMIT).
    #[error("the {what} has degree {degree}; at most {limit} is supported")]
    DegreeTooHigh {
        /// Which polynomial.
        what: &'static str,
        /// The degree found.
        degree: usize,
        /// The highest degree allowed.
        limit: usize,
    },
    /// A transfer function that differentiates its input.
    #[error(
        "the numerator has degree {numerator_degree} and the denominator {denominator_degree}; the numerator's degree must not be the higher one"
    )]
    Improper {
        /// Degree of the numerator.
        numerator_degree: usize,
        /// Degree of the denominator.
        denominator_degree: usize,
    },
    /// The gain at rest of a system that integrates.
    #[error(
        "the system has {integrators} more poles than zeros at the origin, so its gain at rest is infinite; a finite one needs none"
    )]
    InfiniteDcGain {
        /// Poles less zeros at the origin.
        integrators: usize,
    },
    /// A result beyond the range of 64-bit floating point numbers.
    #[error(
        "the {what} lies beyond the range of 64-bit floating point numbers; rescale the time or the units"
    )]
    OutOfRange {
        /// Which result.
        what: &'static str,
    },
    /// A row that is longer or shorter than the first one.
    #[error(
        "row {row} of the matrix has {found} entries; the first row has {allowed}, and all rows must agree"
    )]
    RaggedRows {
        /// Which row, counted from 0.
        row: usize,
        /// Its length.
        found: usize,
        /// The length of the first row.
        allowed: usize,
    },
    /// A matrix or vector whose shape does not fit its partner.
    #[error("the {what} is {} by {}; it must be {} by {} here", found.0, found.1, allowed.0, allowed.1)]
    Shape {
        /// Which operand.
        what: &'static str,
        /// Its rows and columns.
        found: (usize, usize),
        /// The rows and columns that fit.
        allowed: (usize, usize),
    },
    /// An entry outside a matrix.
    #[error(
        "entry ({row}, {column}) was asked for; the matrix has {rows} rows and {columns} columns, counted from 0"
    )]
    OutOfBounds {
        /// Row asked for.
        row: usize,
        /// Column asked for.
        column: usize,
        /// Rows that exist.
        rows: usize,
        /// Columns that exist.
        columns: usize,
    },
    /// A system of equations without a unique solution, to working precision.
    #[error(
        "the matrix is singular to working precision: the pivot of column {column} is {pivot:e} after its rows were scaled to 1"
    )]
    Singular {
        /// Column at which the elimination stopped, counted from 0.
        column: usize,
        /// Size of the largest pivot left there.
        pivot: f64,
    },
    /// Two forms of a state matrix that belong to different loops.
    #[error(
        "entry {index} of the change of the states is {given}; that of the state matrix is {expected}, and they must agree to rounding"
    )]
    OtherLoop {
        /// Position, row after row, counted from 0.
        index: usize,
        /// What was given.
        given: f64,
        /// What the state matrix has.
        expected: f64,
    },
    /// A quantity that must be positive and finite.
    #[error("the {what} is {value}; it must be a finite number above zero")]
    NotPositive {
        /// Which quantity, with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A quantity that must be finite and not negative.
    #[error("the {what} is {value}; it must be a finite number, zero or above")]
    Negative {
        /// Which quantity, with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A loop whose output follows its input at once.
    #[error("the loop passes its input on at once; it must have more poles than zeros")]
    Feedthrough,
    /// A loop with more integrators than are understood.
    #[error("the loop has {found} integrators; at most {allowed} are supported")]
    TooManyIntegrators {
        /// How many it has.
        found: usize,
        /// How many it may have.
        allowed: usize,
    },
    /// A control problem that no feedback solves.
    #[error(
        "no feedback makes this system stable at finite cost: a mode is out of reach, or is neutral and costs nothing"
    )]
    NotStabilisable,
    /// A question about the margins of a sampled loop that has none.
    #[error(
        "the closed loop is not stable: its spectral radius is {spectral_radius}; margins and peaks exist below 1 only"
    )]
    UnstableLoop {
        /// Largest modulus of a closed-loop pole in the z plane.
        spectral_radius: f64,
    },
    /// A sampled loop of which rounding hides whether it is stable.
    #[error(
        "the closed loop's spectral radius {spectral_radius} is not known well enough: rounding may move its outermost poles by {share} of their distance from the unit circle, at most {allowed} is accepted; choose other states"
    )]
    Blurred {
        /// Largest modulus of a closed-loop pole in the z plane, as computed.
        spectral_radius: f64,
        /// How far rounding may move the outermost poles, over their distance from the unit circle.
        share: f64,
        /// The largest share accepted.
        allowed: f64,
    },
    /// A sampled loop with a pole so near to the unit circle that eigenvalues do not tell on which side it is.
    #[error(
        "the closed loop's spectral radius {spectral_radius} cannot be told from 1, which eigenvalues do not know better than to 1e-9"
    )]
    AtEdge {
        /// Largest modulus of a closed-loop pole in the z plane, as computed.
        spectral_radius: f64,
    },
    /// Peaks that nothing bounds from above.
    #[error(
        "no bound of the peaks is proved for a loop of {order} states, samples of dead time included; a longer sample period or a shorter dead time has fewer"
    )]
    Unproved {
        /// Number of states.
        order: usize,
    },
    /// A question about the peaks of a continuous loop that has none.
    #[error(
        "the closed loop has {unstable_poles} unstable poles; peaks and disks exist for stable loops only"
    )]
    UnstablePoles {
        /// Closed-loop poles on the right.
        unstable_poles: usize,
    },
    /// A question that only a loop without dead time can answer.
    #[error(
        "the loop has a dead time of {delay_s} s; its peaks are only found without one, or sampled with whole samples of it"
    )]
    DeadTime {
        /// The dead time in seconds.
        delay_s: f64,
    },
    /// An iteration that used up its limit.
    #[error("the {what} had not converged after {iterations} iterations, the most allowed")]
    NotConverged {
        /// What was sought.
        what: &'static str,
        /// Iterations spent.
        iterations: usize,
    },
    /// A pole for which frequency and damping mean nothing.
    #[error(
        "the pole {real} {imaginary:+}j has no natural frequency and damping; it must be finite and away from the origin of the s plane"
    )]
    NoMode {
        /// Real part of the pole as given.
        real: f64,
        /// Imaginary part of the pole as given.
        imaginary: f64,
    },
}

impl LtiError {
    /// The spectral radius as computed, of a loop that is neither called stable nor unstable.
    #[must_use]
    pub fn undecided_radius(&self) -> Option<f64> {
        match *self {
            Self::Blurred { spectral_radius, .. } | Self::AtEdge { spectral_radius } => {
                Some(spectral_radius)
            }
            _ => None,
        }
    }

    /// `Ok` when every value is finite; otherwise the first that is not, with its position.
    pub(crate) fn unless_finite(what: &'static str, values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(Self::NotFinite { what, index, value: values[index] }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_says_what_was_found_and_what_is_allowed() {
        let improper = LtiError::Improper { numerator_degree: 3, denominator_degree: 2 };
        assert_eq!(
            improper.to_string(),
            "the numerator has degree 3 and the denominator 2; the numerator's degree must not be the higher one"
        );
        let shape = LtiError::Shape { what: "input matrix", found: (2, 1), allowed: (3, 1) };
        assert_eq!(shape.to_string(), "the input matrix is 2 by 1; it must be 3 by 1 here");
        let no_mode = LtiError::NoMode { real: 0.0, imaginary: -1.5 };
        assert!(no_mode.to_string().starts_with("the pole 0 -1.5j has no natural frequency"));
    }

    #[test]
    fn the_first_entry_that_is_not_finite_is_named() {
        let found = LtiError::unless_finite("numerator", &[1.0, f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!(
            found,
            Err(LtiError::NotFinite { what: "numerator", index: 1, value: f64::INFINITY })
        );
        assert!(LtiError::unless_finite("numerator", &[f64::NAN]).is_err());
        assert!(LtiError::unless_finite("numerator", &[]).is_ok());
    }
}
