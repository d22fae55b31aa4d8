//! Tokens with one of them at hand.

use crate::lexer::{Comments, Lexer, Token};

/// A lexer with the next token at hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tokens<'a> {
    lexer: Lexer<'a>,
    /// The next token.
    pub(crate) next: Token<'a>,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(mut lexer: Lexer<'a>) -> Self {
        let next = lexer.next();
        Self { lexer, next }
    }

    /// Passes the next token and tells it.
    pub(crate) fn advance(&mut self) -> Token<'a> {
        let passed = self.next;
        self.next = self.lexer.next();
        passed
    }

    /// Passes the keyword or sign if it is next, and says whether it was.
    pub(crate) fn eat(&mut self, word: &str) -> bool {
        let next = self.next.is(word);
        if next {
            self.advance();
        }
        next
    }

    /// Takes the text from the next token up to `end`, which is not passed, or the end of the line.
    pub(crate) fn take_raw(&mut self, end: char) -> Token<'a> {
        let mut token = self.next;
        self.lexer.cursor = token.start;
        token.text = self.lexer.cursor.take_while(|next| next != end && next != '\n').trim_end();
        self.next = self.lexer.next();
        token
    }

    /// The comments so far.
    pub(crate) fn comments(&self) -> Comments {
        self.lexer.comments
    }
}
