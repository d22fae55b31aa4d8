//! Words, numbers and signs of a text, one at a time.

use crate::cursor::Cursor;
use fspid_diagnostics::Place;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A name or keyword.
    Word,
    /// Something that begins like a number and goes on like one.
    Number,
    /// A sign: `:=`, `..`, or one character.
    Sign,
    /// The end of the text.
    End,
}

/// A piece of text with its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    pub(crate) kind: Kind,
    /// As it stands in the text; empty at the end.
    pub(crate) text: &'a str,
    /// The rest of the text, from this token on.
    pub(crate) start: Cursor<'a>,
}

impl Token<'_> {
    /// Where it begins.
    pub(crate) fn place(&self) -> Place {
        self.start.place()
    }

    /// True for this keyword or sign, in any case.
    pub(crate) fn is(&self, word: &str) -> bool {
        self.text.eq_ignore_ascii_case(word)
    }

    /// True for one of these keywords or signs, in any case.
    pub(crate) fn is_any(&self, words: &[&str]) -> bool {
        words.iter().any(|word| self.is(word))
    }
}

/// Which characters belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alphabet {
    /// Names of letters, digits and `_`; comments of every dialect of FCL.
    Fcl,
    /// Everything between blanks is a word, but for brackets and commas.
    Blanks,
}

/// Where the first comment of each kind begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Comments {
    /// `# …`
    pub(crate) hash: Option<Place>,
    /// `// …`
    pub(crate) slashes: Option<Place>,
    /// `/* … */`
    pub(crate) stars: Option<Place>,
    /// A comment without an end.
    pub(crate) open: Option<Place>,
}

/// Reads tokens; a copy of it remembers a place to come back to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lexer<'a> {
    /// Where it stands.
    pub(crate) cursor: Cursor<'a>,
    alphabet: Alphabet,
    /// The comments so far.
    pub(crate) comments: Comments,
}

impl<'a> Lexer<'a> {
    /// For a text in FCL.
    pub(crate) fn fcl(cursor: Cursor<'a>) -> Self {
        Self { cursor, alphabet: Alphabet::Fcl, comments: Comments::default() }
    }

    /// For a line of words between blanks.
    pub(crate) fn words(cursor: Cursor<'a>) -> Self {
        Self { cursor, alphabet: Alphabet::Blanks, comments: Comments::default() }
    }

    /// The next token.
    pub(crate) fn next(&mut self) -> Token<'a> {
        self.skip();
        let start = self.cursor;
        let kind = match self.alphabet {
            Alphabet::Fcl => self.fcl_token(),
            Alphabet::Blanks => self.blank_token(),
        };
        let length = start.rest().len() - self.cursor.rest().len();
        let text = start.rest().get(..length).unwrap_or_default();
        Token { kind, text, start }
    }

    fn blank_token(&mut self) -> Kind {
        let Some(first) = self.cursor.bump() else { return Kind::End };
        if is_separator(first) {
            return Kind::Sign;
        }
        self.cursor.take_while(|next| !next.is_whitespace() && !is_separator(next));
        if first.is_ascii_digit() || "+-.".contains(first) { Kind::Number } else { Kind::Word }
    }

    fn fcl_token(&mut self) -> Kind {
        let Some(first) = self.cursor.peek() else { return Kind::End };
        if self.begins_number(first) {
            return self.fcl_number();
        }
        if is_name(first) {
            self.fcl_name();
            return Kind::Word;
        }
        if !self.cursor.eat_text(":=") && !self.cursor.eat_text("..") {
            self.cursor.bump();
        }
        Kind::Sign
    }

    fn fcl_name(&mut self) {
        self.cursor.take_while(is_name);
        while self.cursor.peek() == Some('.') && self.second().is_some_and(is_name) {
            self.cursor.bump();
            self.cursor.take_while(is_name);
        }
    }

    /// True at a digit, a point before one, or a sign before a number.
    fn begins_number(&self, first: char) -> bool {
        let second = self.second();
        let digit = |found: Option<char>| found.is_some_and(|found| found.is_ascii_digit());
        match first {
            '+' | '-' => digit(second) || second.is_some_and(|found| ".iI".contains(found)),
            '.' => digit(second),
            _ => first.is_ascii_digit(),
        }
    }

    /// Two points in a row end a number, for `0..1` is a range.
    fn fcl_number(&mut self) -> Kind {
        let signed = matches!(self.cursor.bump(), Some('+' | '-'));
        let signed_word = signed && self.cursor.peek().is_some_and(char::is_alphabetic);
        self.digits();
        if self.cursor.peek() == Some('.') && self.second() != Some('.') {
            self.cursor.bump();
            self.digits();
        }
        let exponent = matches!(self.cursor.peek(), Some('e' | 'E'));
        if exponent && matches!(self.second(), Some('+' | '-')) {
            self.cursor.bump();
            self.cursor.bump();
        }
        let rest = self.cursor.take_while(is_name);
        let digits_only = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let tail = if exponent { rest.trim_start_matches(['e', 'E']) } else { rest };
        if signed_word || digits_only(tail) { Kind::Number } else { Kind::Word }
    }

    fn digits(&mut self) {
        self.cursor.take_while(|next| next.is_ascii_digit());
    }

    /// The character after the next.
    fn second(&self) -> Option<char> {
        self.cursor.rest().chars().nth(1)
    }

    /// Passes blanks and comments.
    fn skip(&mut self) {
        self.cursor.take_while(char::is_whitespace);
        while self.alphabet == Alphabet::Fcl && self.skip_comment() {
            self.cursor.take_while(char::is_whitespace);
        }
    }

    fn skip_comment(&mut self) -> bool {
        let (rest, place) = (self.cursor.rest(), self.cursor.place());
        let comments = &mut self.comments;
        let end = if rest.starts_with("(*") {
            "*)"
        } else if rest.starts_with("/*") {
            comments.stars.get_or_insert(place);
            "*/"
        } else if rest.starts_with("//") {
            comments.slashes.get_or_insert(place);
            ""
        } else if rest.starts_with('#') {
            comments.hash.get_or_insert(place);
            ""
        } else {
            return false;
        };
        self.pass_comment(end, place);
        true
    }

    /// Passes a comment up to its end, which is the line's if it is empty.
    fn pass_comment(&mut self, end: &str, place: Place) {
        if end.is_empty() {
            self.cursor.take_while(|next| next != '\n');
            return;
        }
        self.cursor.bump();
        self.cursor.bump();
        while !self.cursor.eat_text(end) {
            if self.cursor.bump().is_none() {
                self.comments.open.get_or_insert(place);
                return;
            }
        }
    }
}

fn is_name(found: char) -> bool {
    found.is_alphanumeric() || found == '_'
}

fn is_separator(found: char) -> bool {
    matches!(found, '(' | ')' | ',')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<(Kind, &str)> {
        let mut lexer = Lexer::fcl(Cursor::new(text).unwrap());
        let all = std::iter::from_fn(|| Some(lexer.next()));
        all.take_while(|token| token.kind != Kind::End).map(|t| (t.kind, t.text)).collect()
    }

    #[test]
    fn two_points_after_digits_are_a_range_not_a_number() {
        let (number, sign) = (Kind::Number, Kind::Sign);
        for text in ["0..30", "0 .. 30"] {
            assert_eq!(texts(text), [(number, "0"), (sign, ".."), (number, "30")], "{text}");
        }
        assert_eq!(texts("-5..+.5"), [(number, "-5"), (sign, ".."), (number, "+.5")]);
        assert_eq!(texts("1.5..2."), [(number, "1.5"), (sign, ".."), (number, "2.")]);
    }

    #[test]
    fn numbers_names_and_signs_need_no_blanks_between_them() {
        let (number, sign, word) = (Kind::Number, Kind::Sign, Kind::Word);
        assert_eq!(
            texts("a:=(1e-3,-Inf);1st x.y"),
            [
                (word, "a"),
                (sign, ":="),
                (sign, "("),
                (number, "1e-3"),
                (sign, ","),
                (number, "-Inf"),
                (sign, ")"),
                (sign, ";"),
                (word, "1st"),
                (word, "x.y"),
            ]
        );
    }

    #[test]
    fn comments_of_every_dialect_are_passed_over() {
        let text = "a (* b\n * c *) d // e\nf # g\n/* h */ i";
        assert_eq!(texts(text).iter().map(|t| t.1).collect::<Vec<_>>(), ["a", "d", "f", "i"]);
    }

    #[test]
    fn a_comment_without_an_end_is_remembered_with_its_place() {
        let mut lexer = Lexer::fcl(Cursor::new("a\n (* b").unwrap());
        while lexer.next().kind != Kind::End {}
        assert_eq!(lexer.comments.open, Some(Place { line: 2, column: 2 }));
    }

    #[test]
    fn words_between_blanks_may_hold_any_sign_but_brackets_and_commas() {
        let mut lexer = Lexer::words(Cursor::new("if (x+y is very-low)").unwrap());
        let found: Vec<_> = std::iter::from_fn(|| Some(lexer.next().text)).take(6).collect();
        assert_eq!(found, ["if", "(", "x+y", "is", "very-low", ")"]);
    }
}
