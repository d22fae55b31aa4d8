//! Why there is no measurement.

use thiserror::Error;

use crate::error::CampaignError;

/// Why a machine could not be measured.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BenchError {
    /// The built-in scenario cannot be flown, or there are no threads.
    #[error("{0}")]
    Campaign(#[from] CampaignError),
    /// The same work gave another answer: the machine or its memory is broken, or this program is.
    #[error("{what}: the same work gave another answer, {found} where it had been {expected}")]
    Differs {
        /// What was done.
        what: &'static str,
        /// The answer that was first.
        expected: String,
        /// The other one.
        found: String,
    },
}

impl From<crate::table::TableError> for BenchError {
    fn from(error: crate::table::TableError) -> Self {
        Self::Campaign(error.into())
    }
}
