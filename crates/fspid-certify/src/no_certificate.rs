//! Why a file is no certificate.

use std::fmt;

use super::shape::Wrong;

/// Why a text is no certificate: everything that is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoCertificate {
    /// Each with its place; never empty.
    pub problems: Vec<Wrong>,
}

impl std::error::Error for NoCertificate {}

impl fmt::Display for NoCertificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, problem) in self.problems.iter().enumerate() {
            write!(f, "{}{problem}", if place == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl NoCertificate {
    pub(super) fn of(problem: Wrong) -> Self {
        Self { problems: vec![problem] }
    }
}
