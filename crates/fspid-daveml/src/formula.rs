//! Formulas as text: `plus(CL0, times(k, CL, CL))`.

use core::fmt;

use crate::MAX_DEPTH;
use crate::expression::{Expression, Function};
use crate::finding::Origin;

/// Formulas as TOML strings.
pub(crate) mod text_of_formula {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    use super::parse;
    use crate::expression::Expression;

    #[allow(clippy::ref_option, reason = "the signature is serde's")]
    pub(crate) fn serialize<S: Serializer>(
        formula: &Option<Expression>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match formula {
            Some(formula) => serializer.collect_str(formula),
            None => serializer.serialize_none(),
        }
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Expression>, D::Error> {
        let text = String::deserialize(deserializer)?;
        parse(&text).map(Some).map_err(D::Error::custom)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value:?}"),
            Self::Variable { id, .. } => f.write_str(id),
            Self::Apply(function, operands) => {
                write!(f, "{}(", function.name())?;
                for (index, operand) in operands.iter().enumerate() {
                    let separator = if index == 0 { "" } else { ", " };
                    write!(f, "{separator}{operand}")?;
                }
                f.write_str(")")
            }
        }
    }
}

/// Reads a formula.
pub(crate) fn parse(text: &str) -> Result<Expression, FormulaError> {
    let mut parser = Parser { text, at: 0 };
    let formula = parser.expression(0)?;
    if parser.rest().is_empty() { Ok(formula) } else { Err(parser.unexpected("the end")) }
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FormulaError {
    Unexpected { found: String, expected: &'static str },
    Number { found: String },
    Function { found: String },
    Operands { function: &'static str, found: usize, expected: &'static str },
    TooDeep,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unexpected { found, expected } if found.is_empty() => {
                write!(f, "the formula ends; expected {expected}")
            }
            Self::Unexpected { found, expected } => {
                write!(f, "`{found}` in the formula; expected {expected}")
            }
            Self::Number { found } => write!(f, "`{found}` is not a number"),
            Self::Function { found } => {
                write!(f, "unknown function `{found}`; known are {}", Function::names())
            }
            Self::Operands { function, found, expected } => {
                write!(f, "`{function}` has {found} operands; expected {expected}")
            }
            Self::TooDeep => write!(f, "nested too deeply; allowed are {MAX_DEPTH} levels"),
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Parser<'a> {
    /// What is left, without white space before it.
    fn rest(&mut self) -> &'a str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    fn unexpected(&mut self, expected: &'static str) -> FormulaError {
        FormulaError::Unexpected { found: self.rest().chars().take(20).collect(), expected }
    }

    /// Takes a character if it comes next.
    fn takes(&mut self, character: char) -> bool {
        let comes = self.rest().starts_with(character);
        if comes {
            self.at += character.len_utf8();
        }
        comes
    }

    /// A name or number: everything up to a bracket, comma or white space.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        let ends = |character: char| character.is_whitespace() || "(),".contains(character);
        let word = rest.get(..rest.find(ends).unwrap_or(rest.len())).unwrap_or_default();
        self.at += word.len();
        word
    }

    fn expression(&mut self, depth: usize) -> Result<Expression, FormulaError> {
        if depth > MAX_DEPTH {
            return Err(FormulaError::TooDeep);
        }
        let word = self.word();
        if word.is_empty() {
            return Err(self.unexpected("a number, a variable or a function"));
        }
        if self.takes('(') {
            return self.application(word, depth);
        }
        if is_name(word) {
            return Ok(Expression::Variable { id: word.to_owned(), origin: Origin::default() });
        }
        let number = word.parse().map(Expression::Number);
        number.map_err(|_| FormulaError::Number { found: word.to_owned() })
    }

    fn application(&mut self, name: &str, depth: usize) -> Result<Expression, FormulaError> {
        let function = Function::named(name)
            .ok_or_else(|| FormulaError::Function { found: name.to_owned() })?;
        let mut operands = vec![self.expression(depth + 1)?];
        while self.takes(',') {
            operands.push(self.expression(depth + 1)?);
        }
        if !self.takes(')') {
            return Err(self.unexpected("`,` or `)`"));
        }
        match function.refuses(operands.len()) {
            None => Ok(Expression::Apply(function, operands)),
            Some(expected) => {
                let (function, found) = (function.name(), operands.len());
                Err(FormulaError::Operands { function, found, expected })
            }
        }
    }
}

/// Whether a word can be the identifier of a variable in a formula: no number begins like it, and no sign ends it.
pub(crate) fn is_name(word: &str) -> bool {
    let starts = word.chars().next().is_some_and(|first| first.is_alphabetic() || first == '_');
    starts
        && !word.contains(|character: char| character.is_whitespace() || "(),".contains(character))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_is_read_as_it_is_written() {
        for text in [
            "-0.0",
            "1e-300",
            "plus(a.b-c, times(2.0, minus(_x)))",
            "piecewise(1.0, lt(inf, nan), α)",
        ] {
            assert_eq!(parse(text).map(|formula| formula.to_string()), Ok(text.to_owned()));
        }
        assert_eq!(
            parse(" plus ( a ,b )").map(|formula| formula.to_string()),
            Ok("plus(a, b)".into())
        );
    }

    #[test]
    fn what_is_wrong_with_a_formula_is_said() {
        let sentence = |text: &str| parse(text).map_err(|error| error.to_string()).unwrap_err();
        assert_eq!(sentence(""), "the formula ends; expected a number, a variable or a function");
        assert_eq!(sentence("a b"), "`b` in the formula; expected the end");
        assert_eq!(sentence("plus(a"), "the formula ends; expected `,` or `)`");
        assert_eq!(sentence("1.0.0"), "`1.0.0` is not a number");
        assert_eq!(sentence("divide(a)"), "`divide` has 1 operands; expected 2 operands");
        assert!(
            sentence("faculty(a)").starts_with("unknown function `faculty`; known are abs, and,")
        );
        assert!(sentence(&"minus(".repeat(100_000)).starts_with("nested too deeply"));
    }
}
