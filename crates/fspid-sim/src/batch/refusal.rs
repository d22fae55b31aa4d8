//! Why flights cannot fly side by side.

use std::fmt;

/// Reason why flights cannot be simulated side by side: something that a group must share, or must not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refusal {
    /// More flights than lanes.
    TooMany {
        /// Flights given.
        found: usize,
        /// Lanes.
        most: usize,
    },
    /// A flight with a part that no lane can compute; [`fly`](crate::fly) can.
    Part {
        /// Place of the flight, from 0.
        flight: usize,
        /// Which part.
        what: &'static str,
    },
    /// A flight that is not as the first of its group where it must be.
    Differs {
        /// Place of the flight, from 0.
        flight: usize,
        /// In what.
        what: &'static str,
    },
}

impl Refusal {
    /// The same with the flight's place counted from that of the group's `first`.
    pub(super) fn counted_from(self, first: usize) -> Self {
        match self {
            Self::TooMany { .. } => self,
            Self::Part { flight, what } => Self::Part { flight: first + flight, what },
            Self::Differs { flight, what } => Self::Differs { flight: first + flight, what },
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany { found, most } => {
                write!(f, "{found} flights in a group; allowed are at most {most}")
            }
            Self::Part { flight, what } => {
                write!(f, "flight {flight} has {what}, which cannot fly side by side with others")
            }
            Self::Differs { flight, what } => {
                write!(f, "flight {flight} differs from the first of its group in {what}")
            }
        }
    }
}

impl std::error::Error for Refusal {}
