//! How what flies differs from what is certified.

use serde::Serialize;

/// A certificate beside a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comparison {
    /// Name of the scenario.
    pub scenario: String,
    /// Everything in which what flies is not what is certified.
    pub differences: Vec<Difference>,
    /// What flies of what is certified up to a smaller size only; none where all of it is covered.
    pub partly: Option<String>,
    /// What was asked of members of a certified family as they fly, and is not proved between them; none where nothing was.
    pub members: Option<String>,
    /// Digests of the scenario's text, certified and now, where they differ. The text may have changed where
    /// nothing of the loop stands.
    pub other_text: Option<[String; 2]>,
}

/// A field that differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Its path in the certificate.
    pub path: String,
    /// What is certified.
    pub certified: String,
    /// What flies.
    pub flown: String,
}

impl Comparison {
    /// True if what flies is what is certified.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.differences.is_empty()
    }
}
