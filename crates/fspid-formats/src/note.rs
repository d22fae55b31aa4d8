//! What reading and writing answer.

use fspid_diagnostics::Note;
use fspid_fuzzy::system::Parts;

/// Longest text that is read, bytes.
pub const MAX_INPUT_BYTES: usize = 10 << 20;

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
