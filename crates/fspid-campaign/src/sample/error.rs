//! What can be wrong with the size of a campaign.

use thiserror::Error;

/// Why points could not be prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SampleError {
    /// No runs, or more than can be numbered.
    #[error("{found} runs were asked for; allowed are 1 to {limit}")]
    Runs {
        /// Runs asked for.
        found: u64,
        /// Most runs allowed.
        limit: u64,
    },
    /// More dimensions than random points and Latin hypercubes have.
    #[error("{found} numbers differ from run to run; at most {limit} may")]
    Dimensions {
        /// Dimensions asked for.
        found: usize,
        /// Most dimensions allowed.
        limit: usize,
    },
    /// More dimensions than direction numbers are stored.
    #[error(
        "{found} numbers differ from run to run; the sampling \"sobol\" has at most {limit} dimensions, \"latin-hypercube\" has more"
    )]
    SobolDimensions {
        /// Dimensions asked for.
        found: usize,
        /// Most dimensions allowed.
        limit: usize,
    },
}
