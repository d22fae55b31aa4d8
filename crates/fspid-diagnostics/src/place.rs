//! Places in a text: as people count them and as bytes.

use std::fmt;

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Place {
    /// The byte of `text` that lies there; its end where it has no such place.
    #[must_use]
    pub fn byte_in(self, text: &str) -> usize {
        let lines = text.split_inclusive('\n').take(self.line.saturating_sub(1));
        let begin: usize = lines.map(str::len).sum();
        let rest = text.get(begin..).unwrap_or_default();
        let within = rest.char_indices().nth(self.column.saturating_sub(1));
        begin + within.map_or(rest.len(), |(at, _)| at)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Where the lines of a text begin, in bytes.
#[derive(Clone, Debug)]
pub struct LineStarts(Vec<usize>);

impl LineStarts {
    /// The lines of a text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Self(std::iter::once(0).chain(after_breaks).collect())
    }

    /// The place of a byte in the text that the lines are of.
    #[must_use]
    pub fn place(&self, text: &str, byte: usize) -> Place {
        let line = self.0.partition_point(|&start| start <= byte);
        let begin = line.checked_sub(1).and_then(|index| self.0.get(index)).copied().unwrap_or(0);
        let before = text.get(begin..byte).unwrap_or_default();
        Place { line, column: before.chars().count() + 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_becomes_a_line_and_a_column_in_characters_and_back() {
        let text = "α b\nsecond";
        let lines = LineStarts::of(text);
        assert_eq!(lines.place(text, 3), Place { line: 1, column: 3 });
        assert_eq!(lines.place(text, 5), Place { line: 2, column: 1 });
        for (byte, _) in text.char_indices() {
            assert_eq!(lines.place(text, byte).byte_in(text), byte);
        }
        assert_eq!(Place { line: 9, column: 9 }.byte_in(text), text.len());
    }
}
