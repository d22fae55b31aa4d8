//! What every file of an export says of itself.

use super::wrapped;
use crate::compose::Angles;
use crate::program::Precision;

/// Most characters of a line of what is said of the elevator.
const WIDTH: usize = 100;

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
    /// For which elevator a controller was designed, in a sentence; none of a fuzzy system, or where nobody knows.
    pub elevator: Option<&'a str>,
}

impl Heading<'_> {
    /// The lines, without the marks of a comment.
    pub(super) fn lines(&self) -> Vec<String> {
        let bits = match self.precision {
            Precision::Single => "32",
            Precision::Double => "64",
        };
        let name = self.plain_name();
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
        let mut lines = Self::with(&first, source, self.digest);
        lines.extend(self.elevator.iter().flat_map(|it| wrapped(it, WIDTH)));
        lines
    }

    /// The lines of a table, which has digits of its own and no angles.
    pub(super) fn of_table(&self) -> Vec<String> {
        let first = format!(
            "The supervisor of controller {}, numbers of 32 and 16 bits, in its own units.",
            self.plain_name()
        );
        Self::with(&first, "scenario", self.digest)
    }

    /// The name without what ends a comment, moves a terminal's cursor or turns the text around.
    pub(crate) fn plain_name(&self) -> String {
        let is_odd = |c: char| "*/\\".contains(c) || is_unseen(c);
        self.name.replace(is_odd, " ")
    }

    fn with(first: &str, source: &str, digest: &str) -> Vec<String> {
        let version = env!("CARGO_PKG_VERSION");
        vec![
            first.to_owned(),
            format!("Written by fspid {version} from the {source} {digest}."),
            "Licence: MIT or Apache-2.0, at your choice; the design is yours.".to_owned(),
        ]
    }
}

/// True for what is not seen and changes how a text is: control characters, and marks of the direction of writing, which
/// compilers refuse in a comment.
pub(super) fn is_unseen(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{061c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_is_wrapped_has_nothing_unseen() {
        let text = "an \u{202e}input\u{2066} of \u{7}two";
        assert_eq!(super::super::wrapped(text, 80), ["an input of two"]);
    }

    /// rustc refuses a mark of the direction of writing in a comment.
    #[test]
    fn a_name_puts_nothing_unseen_into_a_comment() {
        let name = "a\u{202e}b\u{1}c\u{7f}d*/e\\\nf";
        let heading = Heading {
            name,
            digest: "0",
            precision: Precision::Single,
            angles: None,
            elevator: None,
        };
        assert!(heading.lines()[0].contains(" a b c d  e  f,"), "{:?}", heading.lines());
        assert!(heading.of_table()[0].starts_with("The supervisor of controller a b"));
    }
}
