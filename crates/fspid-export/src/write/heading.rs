//! What every file of an export says of itself.

use crate::compose::Angles;
use crate::program::Precision;

/// Where an export comes from.
#[derive(Clone, Copy, Debug)]
pub struct Heading<'a> {
    /// The controller's name in its scenario.
    pub name: &'a str,
    /// SHA-256 of the scenario.
    pub digest: &'a str,
    /// The digits of its numbers.
    pub precision: Precision,
    /// The unit of its angles.
    pub angles: Angles,
}

impl Heading<'_> {
    /// The lines, without the marks of a comment.
    pub(super) fn lines(&self) -> Vec<String> {
        let bits = match self.precision {
            Precision::Single => "32",
            Precision::Double => "64",
        };
        let angles = match self.angles {
            Angles::Radians => "radians",
            Angles::Degrees => "degrees",
        };
        // A name may hold what ends a comment.
        let name = self.name.replace(['*', '/', '\n', '\r', '\\'], " ");
        vec![
            format!("Controller {name}, numbers of {bits} bits, angles in {angles}."),
            format!(
                "Written by fspid {} from the scenario {}.",
                env!("CARGO_PKG_VERSION"),
                self.digest
            ),
            "Licence: MIT or Apache-2.0, at your choice; the design is yours.".to_owned(),
        ]
    }
}
