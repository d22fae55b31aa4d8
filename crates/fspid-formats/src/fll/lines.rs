//! Lines of keys and values.

use crate::cursor::Cursor;
use crate::lexer::{Kind, Lexer, Token};
use crate::report::Report;
use crate::term::{self, Number};
use crate::tokens::Tokens;
use crate::vocabulary::known;

/// `key: value`
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// Where the key begins.
    pub(super) start: Cursor<'a>,
    pub(super) key: &'a str,
    pub(super) value: Cursor<'a>,
}

/// The next line that says something; one without a key is reported.
pub(super) fn next<'a>(text: &mut Cursor<'a>, report: &mut Report) -> Option<Line<'a>> {
    while let Some(line) = text.take_line() {
        let mut start = line.before('#').trimmed_end();
        start.skip_blanks();
        if start.is_empty() {
            continue;
        }
        let mut value = start;
        let key = value.take_while(|next| next != ':').trim_end();
        if value.eat(':') {
            value.skip_blanks();
            return Some(Line { start, key, value });
        }
        report.problem(start.place(), start.rest(), "not a line of this format", "`key: value`");
    }
    None
}

impl<'a> Line<'a> {
    pub(super) fn is(&self, key: &str) -> bool {
        self.key.eq_ignore_ascii_case(key)
    }

    /// The value, as it stands.
    pub(super) fn text(&self) -> &'a str {
        self.value.rest()
    }

    /// The words of the value.
    pub(super) fn tokens(&self) -> Tokens<'a> {
        Tokens::new(Lexer::words(self.value))
    }

    /// The only word of the value; anything else is reported.
    pub(super) fn word(&self, report: &mut Report) -> Option<Token<'a>> {
        let mut tokens = self.tokens();
        let word = tokens.advance();
        if word.kind != Kind::End && tokens.next.kind == Kind::End {
            return Some(word);
        }
        self.wrong("not a single word", "one word", report);
        None
    }

    /// A norm or another thing with a name; `none` and nothing are `None`.
    pub(super) fn choice<T>(
        &self,
        find: impl Fn(&str) -> Option<T>,
        words: impl Iterator<Item = &'static str> + Clone,
        report: &mut Report,
    ) -> Option<T> {
        if self.is_none() {
            return None;
        }
        let word = self.word(report)?;
        let found = find(word.text);
        if found.is_none() {
            let message = format!("not known as {}", self.key);
            let expected = known(words.chain(["none"]), word.text);
            report.problem(word.place(), word.text, message, expected);
        }
        found
    }

    pub(super) fn is_none(&self) -> bool {
        self.text().is_empty() || self.text().eq_ignore_ascii_case("none")
    }

    pub(super) fn boolean(&self, report: &mut Report) -> Option<bool> {
        let word = self.word(report)?;
        let found = [("true", true), ("false", false)].into_iter().find(|row| word.is(row.0));
        if found.is_none() {
            let expected = "one of `true`, `false`";
            report.problem(word.place(), word.text, format!("not known as {}", self.key), expected);
        }
        found.map(|row| row.1)
    }

    pub(super) fn wrong(&self, message: &str, expected: &str, report: &mut Report) {
        report.problem(self.value.place(), self.text(), message, expected);
    }
}

/// The numbers up to the end; `None` if one of them is none.
pub(super) fn numbers<'a>(mut tokens: Tokens<'a>, report: &mut Report) -> Option<Vec<Number<'a>>> {
    let mut found = Some(Vec::new());
    while tokens.next.kind != Kind::End {
        let number = term::number(tokens.advance(), report);
        found = found.zip(number).map(|(mut numbers, number)| {
            numbers.push(number);
            numbers
        });
    }
    found
}

/// A count.
pub(super) fn whole(number: f64) -> Option<u32> {
    let fits = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
    fits.then_some(number as u32)
}
