//! How sure the numbers of a requirement are.

use std::fmt;

/// How far the numbers of a requirement can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// The text of the source itself was read.
    Read,
    /// Read in another document or tool that quotes the source.
    Quoted,
    /// Public transcriptions of the source agree; the source itself was not at hand.
    Transcribed,
    /// Public transcriptions differ; the note says in what and which was taken.
    Disputed,
    /// Recalled from general knowledge and not read again: check the source before relying on it.
    Recalled,
    /// A number of the project itself, of no standard.
    Own,
}

impl Confidence {
    /// All of them, the surest first.
    pub const ALL: [Self; 6] =
        [Self::Read, Self::Quoted, Self::Transcribed, Self::Disputed, Self::Recalled, Self::Own];

    /// The words in files.
    pub(crate) const NAMES: [&'static str; 6] =
        ["read", "quoted", "transcribed", "disputed", "recalled", "own"];

    /// The word in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// The confidence with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|confidence| confidence.name() == name)
    }
}

impl fmt::Display for Confidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_confidence_is_read_back_from_its_name() {
        for confidence in Confidence::ALL {
            assert_eq!(Confidence::from_name(confidence.name()), Some(confidence));
        }
        assert_eq!(Confidence::from_name("sure"), None);
    }
}
