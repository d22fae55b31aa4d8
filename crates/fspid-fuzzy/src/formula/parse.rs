//! From text to postfix order: Dijkstra's shunting yard, without recursion.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::error::{FormulaError, FormulaErrorKind};
use super::operation::{CONSTANTS, FUNCTIONS, Function, One, Operation, Two};
use super::token::{Token, TokenKind, Tokens};
use super::{MAX_BYTES, MAX_DEPTH, MAX_PARTS};

const OPERAND: &str = "a number, a name, a function or a bracket";
const OPERATOR: &str = "an operator or the end";

/// How tightly an operator holds its sides.
type Strength = u8;

const OR: Strength = 1;
const AND: Strength = 2;
const SUM: Strength = 3;
const PRODUCT: Strength = 4;
const MINUS: Strength = 5;
const POWER: Strength = 6;
const NOT: Strength = 7;

/// What waits for its right side.
#[derive(Clone, Copy)]
enum Waiting {
    Operator { operation: Option<Operation>, strength: Strength },
    Bracket,
    Call { name: &'static str, function: Function, arguments: usize },
}

struct Parser<'a, 'n> {
    tokens: Tokens<'a>,
    names: &'n [&'n str],
    code: Vec<Operation>,
    /// With the byte at which each begins.
    waiting: Vec<(usize, Waiting)>,
    operands: usize,
}

/// The postfix code of a text.
pub(super) fn parse(text: &str, names: &[&str]) -> Result<Vec<Operation>, FormulaError> {
    if text.len() > MAX_BYTES {
        return Err(FormulaErrorKind::TooLong { found: text.len() }.at(MAX_BYTES));
    }
    let tokens = Tokens::of(text);
    let mut parser = Parser { tokens, names, code: Vec::new(), waiting: Vec::new(), operands: 0 };
    loop {
        parser.operand()?;
        if parser.operators()? {
            return Ok(parser.code);
        }
    }
}

impl Parser<'_, '_> {
    /// Reads signs and brackets up to and with the next number or variable.
    fn operand(&mut self) -> Result<(), FormulaError> {
        loop {
            let token = self.tokens.next()?;
            match (token.kind, token.text) {
                (TokenKind::Number(value), _) => {
                    return self.emit(token.position, Operation::Number(value));
                }
                (TokenKind::Sign('('), _) => self.wait(token.position, Waiting::Bracket)?,
                (TokenKind::Sign('+'), _) => self.prefix(&token, None, MINUS)?,
                (TokenKind::Sign('-'), _) => self.prefix(&token, Some(One::Negate), MINUS)?,
                (TokenKind::Sign('~'), _) => self.prefix(&token, Some(One::Negate), NOT)?,
                (TokenKind::Sign('!'), _) | (TokenKind::Word, "not") => {
                    self.prefix(&token, Some(One::Not), NOT)?;
                }
                (TokenKind::Word, word) if !matches!(word, "and" | "or") => {
                    if self.name(&token)? {
                        return Ok(());
                    }
                }
                _ => return Err(unexpected(&token, OPERAND)),
            }
        }
    }

    /// Reads closing brackets up to and with the next operator between two numbers, or a comma.
    /// True at the end.
    fn operators(&mut self) -> Result<bool, FormulaError> {
        loop {
            let token = self.tokens.next()?;
            match (token.kind, token.text) {
                (TokenKind::End, _) => return self.end().map(|()| true),
                (TokenKind::Sign(')'), _) => self.close(&token)?,
                (TokenKind::Sign(','), _) => return self.comma(&token).map(|()| false),
                _ => return self.between(&token).map(|()| false),
            }
        }
    }

    /// A variable or constant: true. A function with its opening bracket: false.
    fn name(&mut self, token: &Token<'_>) -> Result<bool, FormulaError> {
        if let Some(index) = self.names.iter().position(|&name| name == token.text) {
            return self.emit(token.position, Operation::Variable(index)).map(|()| true);
        }
        if let Some(&(_, value)) =
            CONSTANTS.iter().find(|(name, _)| name.eq_ignore_ascii_case(token.text))
        {
            return self.emit(token.position, Operation::Number(value)).map(|()| true);
        }
        // jFuzzyLogic writes functions in upper case.
        let is = |(name, _): &&(&str, Function)| name.eq_ignore_ascii_case(token.text);
        let Some(&(name, function)) = FUNCTIONS.iter().find(is) else {
            let (found, known) = (token.text.to_string(), known(self.names));
            return Err(FormulaErrorKind::Name { found, known }.at(token.position));
        };
        let bracket = self.tokens.next()?;
        if bracket.kind != TokenKind::Sign('(') {
            return Err(unexpected(&bracket, "\"(\" after the name of a function"));
        }
        let call = Waiting::Call { name, function, arguments: 1 };
        self.wait(token.position, call).map(|()| false)
    }

    fn prefix(
        &mut self,
        token: &Token<'_>,
        function: Option<One>,
        strength: Strength,
    ) -> Result<(), FormulaError> {
        let operation = function.map(Operation::One);
        self.wait(token.position, Waiting::Operator { operation, strength })
    }

    fn between(&mut self, token: &Token<'_>) -> Result<(), FormulaError> {
        let Some((function, strength)) = infix(token) else {
            return Err(unexpected(token, OPERATOR));
        };
        // Powers go from right to left: one waits for the other.
        let at_least = if strength == POWER { POWER + 1 } else { strength };
        self.release(at_least)?;
        let operation = Some(Operation::Two(function));
        self.wait(token.position, Waiting::Operator { operation, strength })
    }

    fn comma(&mut self, token: &Token<'_>) -> Result<(), FormulaError> {
        self.release(0)?;
        match self.waiting.last_mut() {
            Some((_, Waiting::Call { arguments, .. })) => {
                *arguments += 1;
                Ok(())
            }
            _ => Err(unexpected(token, OPERATOR)),
        }
    }

    fn close(&mut self, token: &Token<'_>) -> Result<(), FormulaError> {
        self.release(0)?;
        match self.waiting.pop() {
            Some((_, Waiting::Bracket)) => Ok(()),
            Some((position, Waiting::Call { name, function, arguments: found })) => {
                let expected = function.arguments();
                if found == expected {
                    return self.emit(position, function.operation());
                }
                let kind = FormulaErrorKind::Arguments { function: name, found, expected };
                Err(kind.at(position))
            }
            _ => Err(unexpected(token, OPERATOR)),
        }
    }

    fn end(&mut self) -> Result<(), FormulaError> {
        self.release(0)?;
        match self.waiting.last() {
            Some(&(position, _)) => Err(FormulaErrorKind::Unclosed.at(position)),
            None => Ok(()),
        }
    }

    /// Emits the operators that hold at least that tightly, back to the last open bracket.
    fn release(&mut self, at_least: Strength) -> Result<(), FormulaError> {
        while let Some(&(position, Waiting::Operator { operation, strength })) = self.waiting.last()
            && strength >= at_least
        {
            self.waiting.pop();
            if let Some(operation) = operation {
                self.emit(position, operation)?;
            }
        }
        Ok(())
    }

    fn wait(&mut self, position: usize, waiting: Waiting) -> Result<(), FormulaError> {
        if self.waiting.len() == MAX_DEPTH {
            return Err(FormulaErrorKind::TooDeep.at(position));
        }
        self.waiting.push((position, waiting));
        Ok(())
    }

    fn emit(&mut self, position: usize, operation: Operation) -> Result<(), FormulaError> {
        match operation {
            Operation::Number(_) | Operation::Variable(_) => self.operands += 1,
            Operation::One(_) => {}
            Operation::Two(_) => self.operands -= 1,
        }
        if self.operands > MAX_DEPTH {
            return Err(FormulaErrorKind::TooDeep.at(position));
        }
        let operation = self.simpler(operation);
        if self.code.len() == MAX_PARTS {
            return Err(FormulaErrorKind::TooManyParts.at(position));
        }
        self.code.push(operation);
        Ok(())
    }

    /// Squares and cubes as products, so that they exist, exactly, for numbers below 0 too,
    /// whatever kind of number the formula is asked with.
    fn simpler(&mut self, operation: Operation) -> Operation {
        let product = match (operation, self.code.last()) {
            (Operation::Two(Two::Power), Some(Operation::Number(2.0))) => One::Square,
            (Operation::Two(Two::Power), Some(Operation::Number(3.0))) => One::Cube,
            _ => return operation,
        };
        self.code.pop();
        Operation::One(product)
    }
}

fn infix(token: &Token<'_>) -> Option<(Two, Strength)> {
    match (token.kind, token.text) {
        (TokenKind::Sign(_), "+") => Some((Two::Add, SUM)),
        (TokenKind::Sign(_), "-") => Some((Two::Subtract, SUM)),
        (TokenKind::Sign(_), "*") => Some((Two::Multiply, PRODUCT)),
        (TokenKind::Sign(_), "/") => Some((Two::Divide, PRODUCT)),
        (TokenKind::Sign(_), "%") => Some((Two::Remainder, PRODUCT)),
        (TokenKind::Sign(_), "^") => Some((Two::Power, POWER)),
        (TokenKind::Word, "and") => Some((Two::And, AND)),
        (TokenKind::Word, "or") => Some((Two::Or, OR)),
        _ => None,
    }
}

fn unexpected(token: &Token<'_>, expected: &'static str) -> FormulaError {
    FormulaErrorKind::Unexpected { found: token.text.to_string(), expected }.at(token.position)
}

/// Variables, constants and functions, with commas.
fn known(names: &[&str]) -> String {
    let constants = CONSTANTS.iter().map(|&(name, _)| name);
    let functions = FUNCTIONS.iter().map(|&(name, _)| name);
    let all: Vec<&str> = names.iter().copied().chain(constants).chain(functions).collect();
    all.join(", ")
}
