//! What can be wrong with a question about many runs, as one enum whose variants hold the values found.

use thiserror::Error;

/// Why a statistic cannot be stated.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum StatisticsError {
    /// A confidence that is not strictly between 0 and 1.
    #[error("the confidence is {confidence}; it must be above 0 and below 1, such as 0.95")]
    Confidence {
        /// What was asked for.
        confidence: f64,
    },
    /// A share of the runs that is not between 0 and 1.
    #[error("the share is {share}; it must be from 0 to 1, such as 0.99")]
    Share {
        /// What was asked for.
        share: f64,
    },
    /// More failures than runs.
    #[error("{failures} failures of {runs} runs; there cannot be more failures than runs")]
    Failures {
        /// Runs that failed.
        failures: u64,
        /// All runs.
        runs: u64,
    },
}

/// The confidence, if it is one.
pub(super) fn confidence(confidence: f64) -> Result<f64, StatisticsError> {
    if confidence > 0.0 && confidence < 1.0 {
        Ok(confidence)
    } else {
        Err(StatisticsError::Confidence { confidence })
    }
}

/// The share, if it is one.
pub(super) fn share(share: f64) -> Result<f64, StatisticsError> {
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err(StatisticsError::Share { share }) }
}
