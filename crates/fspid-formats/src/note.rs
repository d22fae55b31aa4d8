//! What reading and writing answer, and what they say about it.

use std::fmt;

use fspid_fuzzy::system::Parts;

/// Longest text that is read, bytes.
pub const MAX_INPUT_BYTES: usize = 10 << 20;

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Why a text cannot be read, or a system not be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where in the text; `None` when writing, or when the whole is meant.
    pub place: Option<Place>,
    /// The word in the text that is wrong; empty where something is missing.
    pub word: String,
    /// What is wrong with it.
    pub message: String,
    /// What would be right; empty where the message says so.
    pub expected: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        if !self.word.is_empty() {
            write!(f, "`{}`: ", self.word)?;
        }
        f.write_str(&self.message)?;
        if !self.expected.is_empty() {
            write!(f, "; expected {}", self.expected)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problem {}

/// Every problem of a text, in the order of their places.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems(pub Vec<Problem>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

/// Something worth knowing that is no problem: an assumption, a repair, a loss.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Where in the text, if it is about a place.
    pub place: Option<Place>,
    /// What.
    pub message: String,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Some(place) => write!(f, "{place}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

/// A system that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The system.
    pub parts: Parts,
    /// What was assumed and repaired, in the order of places.
    pub notes: Vec<Note>,
}

/// How a system is to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct WriteOptions {
    /// Whether what the format cannot say may be approximated or left out, with a note of the error.
    pub lossy: bool,
}

/// A system that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// The text of the file.
    pub text: String,
    /// What was lost, with the error that it makes.
    pub notes: Vec<Note>,
}
