//! What every file of an export says of itself.

use crate::compose::Angles;
use crate::program::Precision;

/// Where an export comes from.
#[derive(Clone, Copy, Debug)]
pub struct Heading<'a> {
    /// The controller's name in its scenario, or the fuzzy system's.
    pub name: &'a str,
    /// SHA-256 of the scenario or the system's file.
    pub digest: &'a str,
    /// The digits of its numbers.
    pub precision: Precision,
    /// The unit of a controller's angles; a fuzzy system has none.
    pub angles: Option<Angles>,
}

impl Heading<'_> {
    /// The lines, without the marks of a comment.
    pub(super) fn lines(&self) -> Vec<String> {
        let bits = match self.precision {
            Precision::Single => "32",
            Precision::Double => "64",
        };
        // A name may hold what ends a comment.
        let name = self.name.replace(['*', '/', '\n', '\r', '\\'], " ");
        let (first, source) = match self.angles {
            None => (format!("Fuzzy system {name}, numbers of {bits} bits."), "file"),
            Some(angles) => {
                let angles = match angles {
                    Angles::Radians => "radians",
                    Angles::Degrees => "degrees",
                };
                let first =
                    format!("Controller {name}, numbers of {bits} bits, angles in {angles}.");
                (first, "scenario")
            }
        };
        let version = env!("CARGO_PKG_VERSION");
        vec![
            first,
            format!("Written by fspid {version} from the {source} {}.", self.digest),
            "Licence: MIT or Apache-2.0, at your choice; the design is yours.".to_owned(),
        ]
    }
}
