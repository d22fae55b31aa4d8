//! What languages have in common: expressions in brackets, statements in blocks.

use super::Page;
use crate::program::{Argument, Expression, Kind, Operator, Part, Place, Program, Statement};

/// What a block was opened by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Block {
    If,
    For,
}

/// How a language joins truths; sums and comparisons look alike everywhere.
pub(super) struct Truths {
    pub(super) not_equal: &'static str,
    pub(super) and: &'static str,
    pub(super) or: &'static str,
}

/// How a language says things.
pub(super) trait Dialect {
    fn number(&self, value: f64) -> String;
    fn byte(&self, value: u8) -> String;
    fn truth(&self, value: bool) -> String;
    fn truths(&self) -> Truths;
    fn member(&self, part: Part, name: &str) -> String;
    fn not(&self, value: &str) -> String;
    fn magnitude(&self, value: &str) -> String;
    /// The bits of two bytes together.
    fn bits(&self, left: &str, right: &str) -> String;
    fn select(&self, condition: &str, then: &str, otherwise: &str) -> String;
    fn to_real(&self, value: &str) -> String;
    fn power_of_two(&self, exponent: &str) -> String;
    fn call(&self, name: &str, given: Vec<String>) -> String;
    fn remark(&self, page: &mut Page, text: &str);
    fn declare(&self, page: &mut Page, name: &str, kind: Kind, value: &str);
    fn declare_array(&self, page: &mut Page, name: &str, count: usize);
    fn assign(&self, page: &mut Page, place: &str, value: &str);
    /// A call for what it does.
    fn run(&self, page: &mut Page, call: &str);
    fn when(&self, condition: &str) -> String;
    /// The line, or lines, that a condition stands in.
    fn open(&self, page: &mut Page, text: &str) {
        page.line(text);
    }
    fn otherwise(&self) -> &'static str;
    fn repeat(&self, name: &str, first: i32, last: i32) -> String;
    fn end(&self, block: Block) -> &'static str;
    /// The lines that end a function.
    fn answer(&self, value: Option<&str>) -> Vec<String>;

    /// A whole number.
    fn whole(&self, value: i32) -> String {
        value.to_string()
    }

    /// The sign between what is compared.
    fn equal(&self) -> &'static str {
        "=="
    }

    /// What stands somewhere, as a value.
    fn read(&self, _: &Place, text: String) -> String {
        text
    }

    /// A value of an array.
    fn element(&self, array: &str, index: &str) -> String {
        format!("{array}[{index}]")
    }

    /// Writes a statement that this language has a way of its own for; false if it has none.
    fn own(&self, _: &mut Page, _: &Statement) -> bool {
        false
    }

    /// True where a value, which is written twice, lies between the negative of a number and the number; `None` for a
    /// language that asks for the magnitude.
    fn within(&self, _value: &str, _most: &str) -> Option<String> {
        None
    }

    /// A value of the function, as it is called in this language.
    fn local(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// Writes statements.
pub(super) fn block(dialect: &impl Dialect, page: &mut Page, body: &[Statement]) {
    for statement in body {
        write(dialect, page, statement);
    }
}

fn write(dialect: &impl Dialect, page: &mut Page, statement: &Statement) {
    if dialect.own(page, statement) {
        return;
    }
    match statement {
        Statement::Remark(text) => dialect.remark(page, text),
        Statement::Let(name, kind, value) => {
            dialect.declare(page, &dialect.local(name), *kind, &outer(dialect, value));
        }
        Statement::Array(name, count) => dialect.declare_array(page, &dialect.local(name), *count),
        Statement::Set(at, value) => {
            dialect.assign(page, &place(dialect, at), &outer(dialect, value));
        }
        Statement::If(condition, then, otherwise) => {
            dialect.open(page, &dialect.when(&outer(dialect, condition)));
            page.inside(|page| block(dialect, page, then));
            if !otherwise.is_empty() {
                page.line(dialect.otherwise());
                page.inside(|page| block(dialect, page, otherwise));
            }
            page.line(dialect.end(Block::If));
        }
        Statement::For(name, first, last, body) => {
            page.line(&dialect.repeat(&dialect.local(name), *first, *last));
            page.inside(|page| block(dialect, page, body));
            page.line(dialect.end(Block::For));
        }
        Statement::Call(name, given) => {
            dialect.run(page, &dialect.call(name, arguments(dialect, given)));
        }
        Statement::Return(value) => {
            let value = value.as_ref().map(|value| outer(dialect, value));
            dialect.answer(value.as_deref()).iter().for_each(|line| page.line(line));
        }
    }
}

/// What a function is called with, as text.
pub(super) fn arguments(dialect: &impl Dialect, given: &[Argument]) -> Vec<String> {
    let text = |argument: &Argument| match argument {
        Argument::Value(value) => outer(dialect, value),
        Argument::Array(name) => dialect.local(name),
    };
    given.iter().map(text).collect()
}

pub(super) fn place(dialect: &impl Dialect, place: &Place) -> String {
    match place {
        Place::Local(name) => dialect.local(name),
        Place::Element(name, index) => {
            dialect.element(&dialect.local(name), &outer(dialect, index))
        }
        Place::Member(part, name) => dialect.member(*part, name),
        Place::MemberElement(part, name, index) => {
            dialect.element(&dialect.member(*part, name), &outer(dialect, index))
        }
    }
}

/// What parts are called in languages that have no prefix for a constant.
pub(super) fn part_name(part: Part) -> &'static str {
    match part {
        Part::Configuration => "design",
        Part::State => "state",
        Part::Sample => "sample",
        Part::Answer => "answer",
    }
}

/// What a function of the program is given: its parts by their names, then the rest.
pub(super) fn all_arguments(
    program: &Program,
    function: &str,
    given: Vec<String>,
    part_name: fn(Part) -> &'static str,
) -> String {
    let parts = program.function(function).map_or(&[] as &[Part], |function| function.parts);
    let parts = parts.iter().map(|part| part_name(*part).to_owned());
    parts.chain(given).collect::<Vec<_>>().join(", ")
}

/// An expression that needs no brackets around it.
pub(super) fn outer(dialect: &impl Dialect, value: &Expression) -> String {
    if let Some(text) = within(dialect, value) {
        return text;
    }
    match value {
        Expression::Binary(operator, left, right) if *operator != Operator::BitOr => {
            let (left, right) = (expression(dialect, left), expression(dialect, right));
            format!("{left} {} {right}", sign(dialect, *operator))
        }
        value => expression(dialect, value),
    }
}

/// A magnitude that is compared, where the language has a way of its own.
fn within(dialect: &impl Dialect, value: &Expression) -> Option<String> {
    let Expression::Binary(Operator::LessOrEqual, left, most) = value else { return None };
    let (Expression::Magnitude(value), Expression::Number(_) | Expression::Read(Place::Member(..))) =
        (&**left, &**most)
    else {
        return None;
    };
    match &**value {
        Expression::Read(Place::Local(name)) => {
            dialect.within(&dialect.local(name), &expression(dialect, most))
        }
        _ => None,
    }
}

fn sign(dialect: &impl Dialect, operator: Operator) -> &'static str {
    let truths = dialect.truths();
    match operator {
        Operator::Add => "+",
        Operator::Subtract => "-",
        Operator::Multiply => "*",
        Operator::Divide => "/",
        Operator::Less => "<",
        Operator::LessOrEqual => "<=",
        Operator::Equal => dialect.equal(),
        Operator::NotEqual => truths.not_equal,
        Operator::And => truths.and,
        Operator::Or => truths.or,
        Operator::BitOr => "|",
    }
}

fn expression(dialect: &impl Dialect, value: &Expression) -> String {
    let of = |value: &Expression| expression(dialect, value);
    match value {
        Expression::Number(value) => dialect.number(*value),
        Expression::Whole(value) => dialect.whole(*value),
        Expression::Byte(value) => dialect.byte(*value),
        Expression::Truth(value) => dialect.truth(*value),
        Expression::Read(at) => dialect.read(at, place(dialect, at)),
        Expression::Negative(value) => format!("-{}", of(value)),
        Expression::Magnitude(value) => dialect.magnitude(&outer(dialect, value)),
        Expression::Not(value) => dialect.not(&of(value)),
        Expression::Binary(Operator::BitOr, left, right) => dialect.bits(&of(left), &of(right)),
        Expression::Binary(..) => format!("({})", outer(dialect, value)),
        Expression::Select(condition, then, otherwise) => {
            dialect.select(&of(condition), &of(then), &of(otherwise))
        }
        Expression::ToReal(value) => dialect.to_real(&of(value)),
        Expression::PowerOfTwo(value) => dialect.power_of_two(&outer(dialect, value)),
        Expression::Call(name, given) => dialect.call(name, arguments(dialect, given)),
    }
}
