//! From characters to words, literals and signs.

use crate::problem::{Mistake, Problem};
use crate::value::{Kind, Value};

/// What a text is made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    /// A keyword or a name, in capitals.
    Word(String),
    /// A literal with its type.
    Literal(Value),
    /// A whole number without a type, as bounds of lists are.
    Bound(usize),
    /// An operator or a mark.
    Sign(&'static str),
    /// The end of the text.
    End,
}

impl Token {
    /// As it is called in a message.
    pub(crate) fn told(&self) -> String {
        match self {
            Self::Word(word) => word.clone(),
            Self::Literal(value) => format!("a literal of type {}", value.kind()),
            Self::Bound(bound) => bound.to_string(),
            Self::Sign(sign) => format!("`{sign}`"),
            Self::End => "the end".to_owned(),
        }
    }
}

/// The longer ones first.
const SIGNS: [&str; 20] = [
    ":=", "<=", ">=", "<>", "..", ":", ";", ",", ".", "(", ")", "[", "]", "+", "-", "*", "/", "<",
    ">", "=",
];

/// The tokens of a text, each with its line.
pub(crate) fn tokens(text: &str) -> Result<Vec<(usize, Token)>, Problem> {
    let mut lexer = Lexer { rest: text, line: 1 };
    let mut found = Vec::new();
    while lexer.skip_blanks()? {
        let line = lexer.line;
        found.push((line, lexer.token().map_err(|mistake| mistake.at(line))?));
    }
    found.push((lexer.line, Token::End));
    Ok(found)
}

struct Lexer<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Lexer<'a> {
    /// Steps over blanks and remarks; false at the end.
    fn skip_blanks(&mut self) -> Result<bool, Problem> {
        loop {
            let blanks = self.rest.len() - self.rest.trim_start().len();
            self.take(blanks);
            let Some(remark) = self.rest.strip_prefix("(*") else {
                return Ok(!self.rest.is_empty());
            };
            let end = remark.find("*)").filter(|end| !remark[..*end].contains("(*"));
            match end {
                Some(end) => self.take(end + 4),
                None => return Err(Mistake::Remark.at(self.line)),
            };
        }
    }

    fn take(&mut self, length: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(length);
        self.line += taken.matches('\n').count();
        self.rest = rest;
        taken
    }

    fn take_while(&mut self, is_part: impl Fn(char) -> bool) -> &'a str {
        let length = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        self.take(length)
    }

    fn token(&mut self) -> Result<Token, Mistake> {
        let first = self.rest.chars().next().unwrap_or(' ');
        if first.is_ascii_digit() {
            return self.bound();
        }
        if first.is_ascii_alphabetic() || first == '_' {
            return self.word();
        }
        let sign = SIGNS.into_iter().find(|sign| self.rest.starts_with(sign));
        let sign = sign.ok_or(Mistake::Character(first))?;
        self.take(sign.len());
        Ok(Token::Sign(sign))
    }

    /// Digits alone; with a point they are a real without a type.
    fn bound(&mut self) -> Result<Token, Mistake> {
        let digits = self.take_while(|c| c.is_ascii_alphanumeric() || c == '_' || c == '#');
        let is_real = self.rest.starts_with('.') && !self.rest.starts_with("..");
        match digits.parse() {
            Ok(bound) if !is_real => Ok(Token::Bound(bound)),
            _ => Err(Mistake::Untyped(digits.to_owned())),
        }
    }

    fn word(&mut self) -> Result<Token, Mistake> {
        let word = self.take_while(|c| c.is_ascii_alphanumeric() || c == '_').to_ascii_uppercase();
        if self.rest.starts_with('#') {
            return self.literal(&word);
        }
        match word.as_str() {
            "TRUE" => Ok(Token::Literal(Value::Bool(true))),
            "FALSE" => Ok(Token::Literal(Value::Bool(false))),
            word if word.contains("__") || word.ends_with('_') || word.starts_with('_') => {
                Err(Mistake::Name(word.to_owned()))
            }
            word => Ok(Token::Word(word.to_owned())),
        }
    }

    fn literal(&mut self, kind: &str) -> Result<Token, Mistake> {
        self.take(1);
        let bytes = self.rest.as_bytes();
        let mut length = 0;
        while let Some(byte) = bytes.get(length) {
            let is_sign = matches!(byte, b'+' | b'-') && (length == 0 || bytes[length - 1] == b'E');
            if !(byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'#') || is_sign) {
                break;
            }
            length += 1;
        }
        let text = self.take(length);
        let value = Kind::named(kind).and_then(|kind| Value::literal(kind, text));
        value.map(Token::Literal).ok_or_else(|| Mistake::Literal(format!("{kind}#{text}")))
    }
}
