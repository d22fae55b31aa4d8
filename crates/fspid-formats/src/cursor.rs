//! A place in a text that moves forward: lines and columns are counted while reading, so that a
//! text is read in linear time however many places are told.

use crate::note::MAX_INPUT_BYTES;
use crate::work;
use fspid_diagnostics::{Place, Problem};

/// The rest of a text, and where it begins.
///
/// Columns count characters; a tab is one. Lines end with LF, CR LF or CR, whichever comes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cursor<'a> {
    rest: &'a str,
    place: Place,
}

impl<'a> Cursor<'a> {
    /// The beginning of a text; a byte order mark is passed over.
    ///
    /// # Errors
    /// A text of more than [`MAX_INPUT_BYTES`].
    pub(crate) fn new(text: &'a str) -> Result<Self, Problem> {
        if text.len() > MAX_INPUT_BYTES {
            let message = format!("the text has {} bytes", text.len());
            return Err(Problem::whole(message, format!("at most {MAX_INPUT_BYTES}")));
        }
        let rest = text.strip_prefix('\u{feff}').unwrap_or(text);
        Ok(Self { rest, place: Place { line: 1, column: 1 } })
    }

    /// Where it stands.
    pub(crate) fn place(&self) -> Place {
        self.place
    }

    /// What has not been read.
    pub(crate) fn rest(&self) -> &'a str {
        self.rest
    }

    /// True at the end of the text.
    pub(crate) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next character, which is not passed; a line end of any kind is `\n`.
    pub(crate) fn peek(&self) -> Option<char> {
        self.rest.chars().next().map(|found| if found == '\r' { '\n' } else { found })
    }

    /// Passes the next character and tells it; a line end of any kind is one `\n`.
    pub(crate) fn bump(&mut self) -> Option<char> {
        let found = self.rest.chars().next()?;
        work::add(1);
        let length = if self.rest.starts_with("\r\n") { 2 } else { found.len_utf8() };
        self.rest = self.rest.get(length..).unwrap_or_default();
        if matches!(found, '\r' | '\n') {
            self.place = Place { line: self.place.line + 1, column: 1 };
            return Some('\n');
        }
        self.place.column += 1;
        Some(found)
    }

    /// Passes `wanted` if it is next, and says whether it was.
    pub(crate) fn eat(&mut self, wanted: char) -> bool {
        let next = self.peek() == Some(wanted);
        if next {
            self.bump();
        }
        next
    }

    /// Passes `wanted` (without line ends) if it is next, and says whether it was.
    pub(crate) fn eat_text(&mut self, wanted: &str) -> bool {
        let next = self.rest.starts_with(wanted);
        if next {
            wanted.chars().for_each(|wanted| {
                self.eat(wanted);
            });
        }
        next
    }

    /// Passes characters as long as they are wanted, and tells them as they stand in the text.
    pub(crate) fn take_while(&mut self, mut wanted: impl FnMut(char) -> bool) -> &'a str {
        let before = self.rest;
        while self.peek().is_some_and(&mut wanted) {
            self.bump();
        }
        before.get(..before.len() - self.rest.len()).unwrap_or_default()
    }

    /// Passes blanks and tabs, but no line ends.
    pub(crate) fn skip_blanks(&mut self) {
        self.take_while(|found| found != '\n' && found.is_whitespace());
    }

    /// Takes the rest of the line as a cursor of its own and passes the line end; `None` at the end.
    pub(crate) fn take_line(&mut self) -> Option<Self> {
        if self.is_empty() {
            return None;
        }
        let place = self.place;
        let end = self.rest.find(['\r', '\n']).unwrap_or(self.rest.len());
        work::add(end + 1);
        let (rest, behind) = self.rest.split_at(end);
        self.rest = behind.strip_prefix("\r\n").or_else(|| behind.get(1..)).unwrap_or_default();
        self.place = Place { line: place.line + 1, column: 1 };
        Some(Self { rest, place })
    }

    /// Only what stands before the first `sign`, if there is one.
    pub(crate) fn before(mut self, sign: char) -> Self {
        self.rest = self.rest.split(sign).next().unwrap_or_default();
        work::add(self.rest.len());
        self
    }

    /// What stands before a cursor further on in the same text.
    pub(crate) fn up_to(mut self, after: Self) -> Self {
        let length = self.rest.len().saturating_sub(after.rest.len());
        self.rest = self.rest.get(..length).unwrap_or_default();
        self
    }

    /// Without blanks at the end.
    pub(crate) fn trimmed_end(mut self) -> Self {
        self.rest = self.rest.trim_end();
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<(usize, &str)> {
        let mut cursor = Cursor::new(text).unwrap();
        std::iter::from_fn(|| cursor.take_line()).map(|line| (line.place.line, line.rest)).collect()
    }

    #[test]
    fn lines_are_the_same_with_every_line_end_and_a_byte_order_mark() {
        let wanted = vec![(1, "a"), (2, ""), (3, "b")];
        for text in ["a\n\nb", "a\r\n\r\nb\r\n", "a\r\rb\r", "\u{feff}a\n\nb\n"] {
            assert_eq!(lines(text), wanted, "{text:?}");
        }
    }

    #[test]
    fn columns_count_characters_not_bytes() {
        let mut cursor = Cursor::new("\u{feff}äö\tx\r\ny").unwrap();
        assert_eq!(cursor.take_while(|found| found != 'x'), "äö\t");
        assert_eq!(cursor.place(), Place { line: 1, column: 4 });
        assert!(cursor.eat('x') && cursor.eat('\n') && !cursor.eat('x'));
        assert_eq!(cursor.place(), Place { line: 2, column: 1 });
        assert!(cursor.eat_text("y") && cursor.is_empty());
    }

    #[test]
    fn a_text_beyond_the_limit_is_refused_before_it_is_read() {
        let problem = Cursor::new(&" ".repeat(MAX_INPUT_BYTES + 1)).unwrap_err();
        assert_eq!(problem.to_string(), "the text has 10485761 bytes; expected at most 10485760");
    }
}
