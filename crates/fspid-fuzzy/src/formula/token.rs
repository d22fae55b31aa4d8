//! Text cut into numbers, words and signs.

use alloc::string::ToString;

use super::error::{FormulaError, FormulaErrorKind};

/// A number, word or sign and the byte where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) position: usize,
    /// As written; empty at the end.
    pub(super) text: &'a str,
    pub(super) kind: TokenKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    Word,
    Sign(char),
    End,
}

/// Cuts off one token after the other; each byte is looked at a few times at most.
pub(super) struct Tokens<'a> {
    text: &'a str,
    position: usize,
}

impl<'a> Tokens<'a> {
    pub(super) const fn of(text: &'a str) -> Self {
        Self { text, position: 0 }
    }

    /// The next token; after the last one [`TokenKind::End`] for ever.
    pub(super) fn next(&mut self) -> Result<Token<'a>, FormulaError> {
        let rest = self.rest().trim_start();
        self.position = self.text.len() - rest.len();
        match rest.chars().next() {
            None => Ok(self.cut(0, TokenKind::End)),
            Some('0'..='9' | '.') => self.number(rest),
            Some(first) if first.is_alphabetic() || first == '_' => {
                Ok(self.cut(word_length(rest), TokenKind::Word))
            }
            Some(sign @ ('+' | '-' | '*' | '/' | '%' | '^' | '(' | ')' | ',' | '!' | '~')) => {
                Ok(self.cut(1, TokenKind::Sign(sign)))
            }
            Some(found) => Err(FormulaErrorKind::Character { found }.at(self.position)),
        }
    }

    fn number(&mut self, rest: &str) -> Result<Token<'a>, FormulaError> {
        let length = number_length(rest);
        let token = self.cut(length, TokenKind::End);
        match token.text.parse() {
            Ok(value) if f64::is_finite(value) => {
                Ok(Token { kind: TokenKind::Number(value), ..token })
            }
            _ => {
                let found = token.text.to_string();
                Err(FormulaErrorKind::Number { found }.at(token.position))
            }
        }
    }

    fn rest(&self) -> &'a str {
        self.text.get(self.position..).unwrap_or_default()
    }

    fn cut(&mut self, length: usize, kind: TokenKind) -> Token<'a> {
        let text = self.rest().get(..length).unwrap_or_default();
        let token = Token { position: self.position, text, kind };
        self.position += length;
        token
    }
}

/// Letters, digits and underscores; a point only between two of them.
fn word_length(text: &str) -> usize {
    let in_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let all = text.find(|c| !in_word(c)).unwrap_or(text.len());
    text.get(..all).unwrap_or_default().trim_end_matches('.').len()
}

/// Digits and points, then an exponent if there is a whole one.
fn number_length(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let mantissa = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let exponent = text.get(mantissa..).unwrap_or_default();
    let Some(signed) = exponent.strip_prefix(['e', 'E']) else { return mantissa };
    let unsigned = signed.strip_prefix(['+', '-']).unwrap_or(signed);
    match digits(unsigned) {
        0 => mantissa,
        count => mantissa + exponent.len() - unsigned.len() + count,
    }
}
