//! From tokens to function blocks and programs.

use crate::lexer::{Token, tokens};
use crate::problem::{Mistake, Problem};
use crate::reserved::is_reserved;
use crate::syntax::{
    Expression, Function, Operator, Place, Section, Shape, Statement, Unit, Variable, What,
};
use crate::value::{Kind, Value};

/// The units of a text.
pub(crate) fn parse(text: &str) -> Result<Vec<Unit>, Problem> {
    let mut parser = Parser { tokens: tokens(text)?, next: 0 };
    let mut units = Vec::new();
    while *parser.peek() != Token::End {
        units.push(parser.unit()?);
    }
    Ok(units)
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    next: usize,
}

type Parsed<T> = Result<T, Problem>;

impl Parser {
    fn peek(&self) -> &Token {
        self.tokens.get(self.next).map_or(&Token::End, |(_, token)| token)
    }

    fn line(&self) -> usize {
        self.tokens.get(self.next).or(self.tokens.last()).map_or(0, |(line, _)| *line)
    }

    fn take(&mut self) -> Token {
        let token = self.peek().clone();
        self.next += 1;
        token
    }

    fn missing<T>(&self, expected: &str) -> Parsed<T> {
        let (expected, found) = (expected.to_owned(), self.peek().told());
        Err(Mistake::Missing { expected, found }.at(self.line()))
    }

    fn is(&mut self, token: &Token) -> bool {
        let is = self.peek() == token;
        self.next += usize::from(is);
        is
    }

    fn is_word(&mut self, word: &str) -> bool {
        let is = matches!(self.peek(), Token::Word(found) if found == word);
        self.next += usize::from(is);
        is
    }

    fn word(&mut self, word: &str) -> Parsed<()> {
        if self.is_word(word) { Ok(()) } else { self.missing(word) }
    }

    fn sign(&mut self, sign: &'static str) -> Parsed<()> {
        if self.is(&Token::Sign(sign)) { Ok(()) } else { self.missing(&format!("`{sign}`")) }
    }

    fn name(&mut self) -> Parsed<String> {
        let Token::Word(word) = self.peek().clone() else { return self.missing("a name") };
        if is_reserved(&word) {
            return Err(Mistake::Reserved(word).at(self.line()));
        }
        self.next += 1;
        Ok(word)
    }

    fn unit(&mut self) -> Parsed<Unit> {
        let kind = ["FUNCTION_BLOCK", "PROGRAM"].into_iter().find(|kind| self.is_word(kind));
        let Some(kind) = kind else { return self.missing("FUNCTION_BLOCK or PROGRAM") };
        let name = self.name()?;
        let mut variables = Vec::new();
        while let Some(section) = self.section() {
            while !self.is_word("END_VAR") {
                variables.push(self.variable(section)?);
            }
        }
        let body = self.statements(&[&format!("END_{kind}")])?;
        self.next += 1;
        Ok(Unit { name, variables, body })
    }

    fn section(&mut self) -> Option<Section> {
        let Token::Word(word) = self.peek() else { return None };
        let section = match word.as_str() {
            "VAR_INPUT" => Section::Input,
            "VAR_OUTPUT" => Section::Output,
            "VAR_TEMP" => Section::Temporary,
            "VAR" => Section::Kept,
            _ => return None,
        };
        self.next += 1;
        if section == Section::Kept && self.is_word("CONSTANT") {
            return Some(Section::Constant);
        }
        Some(section)
    }

    fn variable(&mut self, section: Section) -> Parsed<Variable> {
        let (line, name) = (self.line(), self.name()?);
        self.sign(":")?;
        let shape = self.shape()?;
        let first = if self.is(&Token::Sign(":=")) { self.first(&shape)? } else { Vec::new() };
        self.sign(";")?;
        Ok(Variable { line, name, section, shape, first })
    }

    fn shape(&mut self) -> Parsed<Shape> {
        if !self.is_word("ARRAY") {
            let Token::Word(word) = self.peek().clone() else { return self.missing("a type") };
            return match Kind::named(&word) {
                Some(kind) => {
                    self.next += 1;
                    Ok(Shape::One(kind))
                }
                None => self.name().map(Shape::Instance),
            };
        }
        self.sign("[")?;
        if self.take() != Token::Bound(0) {
            return self.missing("a list that begins at 0,");
        }
        self.sign("..")?;
        let Token::Bound(last) = self.take() else { return self.missing("the last index") };
        self.sign("]")?;
        self.word("OF")?;
        match self.take() {
            Token::Word(word) if Kind::named(&word).is_some() => {
                Ok(Shape::List(Kind::named(&word).unwrap_or(Kind::Bool), last + 1))
            }
            _ => self.missing("a type"),
        }
    }

    fn first(&mut self, shape: &Shape) -> Parsed<Vec<Value>> {
        if matches!(shape, Shape::One(_)) {
            return Ok(vec![self.literal()?]);
        }
        self.sign("[")?;
        let mut values = vec![self.literal()?];
        while self.is(&Token::Sign(",")) {
            values.push(self.literal()?);
        }
        self.sign("]")?;
        Ok(values)
    }

    fn literal(&mut self) -> Parsed<Value> {
        let line = self.line();
        match self.take() {
            Token::Literal(value) => Ok(value),
            Token::Bound(bound) => Err(Mistake::Untyped(bound.to_string()).at(line)),
            _ => {
                self.next -= 1;
                self.missing("a literal")
            }
        }
    }

    /// Statements up to one of these words, which is not taken.
    fn statements(&mut self, ends: &[&str]) -> Parsed<Vec<Statement>> {
        let mut statements = Vec::new();
        loop {
            match self.peek() {
                Token::Word(word) if ends.contains(&word.as_str()) => return Ok(statements),
                Token::End => return self.missing(ends.last().unwrap_or(&"")),
                _ => statements.push(self.statement()?),
            }
        }
    }

    fn statement(&mut self) -> Parsed<Statement> {
        let line = self.line();
        let what = if self.is_word("IF") {
            self.decision()?
        } else if self.is_word("FOR") {
            self.repetition()?
        } else if self.is_word("RETURN") {
            What::Return
        } else {
            self.assignment_or_call()?
        };
        self.sign(";")?;
        Ok(Statement { line, what })
    }

    fn decision(&mut self) -> Parsed<What> {
        let condition = self.expression()?;
        self.word("THEN")?;
        let then = self.statements(&["ELSE", "END_IF"])?;
        let otherwise =
            if self.is_word("ELSE") { self.statements(&["END_IF"])? } else { Vec::new() };
        self.word("END_IF")?;
        Ok(What::If(condition, then, otherwise))
    }

    fn repetition(&mut self) -> Parsed<What> {
        let name = self.name()?;
        self.sign(":=")?;
        let first = self.count()?;
        self.word("TO")?;
        let last = self.count()?;
        self.word("DO")?;
        let body = self.statements(&["END_FOR"])?;
        self.word("END_FOR")?;
        Ok(What::For(name, first, last, body))
    }

    fn count(&mut self) -> Parsed<i32> {
        let line = self.line();
        match self.literal()? {
            Value::Dint(count) => Ok(count),
            other => Err(Mistake::Type(Kind::Dint, other.kind()).at(line)),
        }
    }

    fn assignment_or_call(&mut self) -> Parsed<What> {
        let place = self.place()?;
        if let Place::One(name) = &place
            && self.is(&Token::Sign("("))
        {
            let mut inputs = Vec::new();
            while inputs.is_empty() || self.is(&Token::Sign(",")) {
                let input = self.name()?;
                self.sign(":=")?;
                inputs.push((input, self.expression()?));
            }
            self.sign(")")?;
            return Ok(What::Call(name.clone(), inputs));
        }
        self.sign(":=")?;
        Ok(What::Assign(place, self.expression()?))
    }

    fn place(&mut self) -> Parsed<Place> {
        let name = self.name()?;
        if self.is(&Token::Sign("[")) {
            let index = self.expression()?;
            self.sign("]")?;
            return Ok(Place::Element(name, Box::new(index)));
        }
        if self.is(&Token::Sign(".")) {
            return Ok(Place::Member(name, self.name()?));
        }
        Ok(Place::One(name))
    }

    /// At most one operator: which of two comes first is not known by heart alike.
    fn expression(&mut self) -> Parsed<Expression> {
        let left = self.operand()?;
        let Some(operator) = self.operator() else { return Ok(left) };
        let right = self.operand()?;
        let line = self.line();
        match self.operator() {
            Some(next) => Err(Mistake::Brackets(next.sign()).at(line)),
            None => Ok(Expression::Binary(operator, Box::new(left), Box::new(right))),
        }
    }

    fn operator(&mut self) -> Option<Operator> {
        let sign = match self.peek() {
            Token::Sign(sign) => *sign,
            Token::Word(word) => word.as_str(),
            _ => return None,
        };
        let operator = Operator::ALL.into_iter().find(|operator| operator.sign() == sign)?;
        self.next += 1;
        Some(operator)
    }

    fn operand(&mut self) -> Parsed<Expression> {
        match self.peek().clone() {
            Token::Literal(_) | Token::Bound(_) => self.literal().map(Expression::Literal),
            Token::Sign("-") => {
                self.next += 1;
                Ok(Expression::Negative(Box::new(self.operand()?)))
            }
            Token::Sign("(") => self.in_brackets(),
            _ if self.is_word("NOT") => Ok(Expression::Not(Box::new(self.in_brackets()?))),
            _ => {
                let known = Function::ALL.into_iter().find(|it| self.is_word(it.name()));
                match known {
                    Some(function) => {
                        Ok(Expression::Function(function, Box::new(self.in_brackets()?)))
                    }
                    None => self.place().map(Expression::Read),
                }
            }
        }
    }

    fn in_brackets(&mut self) -> Parsed<Expression> {
        self.sign("(")?;
        let inside = self.expression()?;
        self.sign(")")?;
        Ok(inside)
    }
}
