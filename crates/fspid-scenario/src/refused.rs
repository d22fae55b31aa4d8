//! Why a question has no answer.

use std::fmt;

/// Why there is no answer: every problem, in sentences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(Vec<String>);

impl Refused {
    /// One reason.
    #[must_use]
    pub fn one(reason: impl Into<String>) -> Self {
        Self(vec![reason.into()])
    }

    /// All reasons.
    #[must_use]
    pub fn all(reasons: Vec<String>) -> Self {
        Self(reasons)
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl std::error::Error for Refused {}
