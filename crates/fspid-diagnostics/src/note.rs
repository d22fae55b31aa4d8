//! What is worth knowing and no problem.

use std::fmt;

use crate::place::Place;

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
