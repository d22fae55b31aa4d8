//! Runs side by side.

use std::fmt;

/// Runs from the first up to, and without, the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Range {
    /// The first run.
    pub first: u64,
    /// The run after the last.
    pub end: u64,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "runs {} to {}", self.first, self.end.saturating_sub(1))
    }
}
