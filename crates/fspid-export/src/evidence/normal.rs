//! A program without what it never does: two programs that are the same then answer the same bits.

use std::collections::BTreeSet;

use super::ranges::{Known, Range, Ranges};
use crate::program::{Argument, Expression, Operator, Place, Program, Statement};

/// The functions' bodies without ways that are never gone, values that are never read, and operations that answer what
/// they are given. Numbers of the configuration stand in them.
pub(super) fn normal(program: &Program, ranges: &Ranges<'_>) -> Vec<Vec<Statement>> {
    let body = |body: &[Statement]| {
        let mut body = block(body, ranges);
        // What reads a value may itself be read by nobody.
        for _ in 0..4 {
            body = live(body, &mut BTreeSet::new());
        }
        body
    };
    program.functions.iter().map(|function| body(&function.body)).collect()
}

fn block(body: &[Statement], ranges: &Ranges<'_>) -> Vec<Statement> {
    let mut out = Vec::new();
    for statement in body {
        add(statement, ranges, &mut out);
        if matches!(out.last(), Some(Statement::Return(_))) {
            break;
        }
    }
    out
}

fn add(statement: &Statement, ranges: &Ranges<'_>, out: &mut Vec<Statement>) {
    let of = |value: &Expression| simple(value, ranges);
    match statement {
        Statement::Remark(_) => {}
        Statement::Let(name, kind, value) => {
            out.push(Statement::Let(name.clone(), *kind, of(value)));
        }
        Statement::Array(..) => out.push(statement.clone()),
        Statement::Set(place, value) => {
            let (place, value) = (at(place, ranges), of(value));
            if value != Expression::Read(place.clone()) {
                out.push(Statement::Set(place, value));
            }
        }
        Statement::If(condition, then, otherwise) => match of(condition) {
            Expression::Truth(true) => out.extend(block(then, ranges)),
            Expression::Truth(false) => out.extend(block(otherwise, ranges)),
            condition => {
                let [then, otherwise] = [then, otherwise].map(|body| block(body, ranges));
                if !then.is_empty() || !otherwise.is_empty() {
                    out.push(Statement::If(condition, then, otherwise));
                }
            }
        },
        Statement::For(name, first, last, body) => {
            out.push(Statement::For(name.clone(), *first, *last, block(body, ranges)));
        }
        Statement::Call(name, given) => {
            out.push(Statement::Call(name, arguments(given, ranges)));
        }
        Statement::Return(value) => out.push(Statement::Return(value.as_ref().map(of))),
    }
}

fn at(place: &Place, ranges: &Ranges<'_>) -> Place {
    match place {
        Place::Local(_) | Place::Member(..) => place.clone(),
        Place::Element(name, index) => {
            Place::Element(name.clone(), Box::new(simple(index, ranges)))
        }
        Place::MemberElement(part, name, index) => {
            Place::MemberElement(*part, name.clone(), Box::new(simple(index, ranges)))
        }
    }
}

fn arguments(given: &[Argument], ranges: &Ranges<'_>) -> Vec<Argument> {
    let of = |it: &Argument| match it {
        Argument::Value(value) => Argument::Value(simple(value, ranges)),
        Argument::Array(name) => Argument::Array(name.clone()),
    };
    given.iter().map(of).collect()
}

fn range(value: &Expression, ranges: &Ranges<'_>) -> Option<Range> {
    match ranges.of(value) {
        Some(Known::Real(range)) => Some(*range),
        _ => None,
    }
}

fn simple(value: &Expression, ranges: &Ranges<'_>) -> Expression {
    let of = |value: &Expression| simple(value, ranges);
    let calls = format!("{value:?}").contains("Call(");
    match ranges.of(value) {
        Some(Known::Truth(truth)) if !calls => {
            if let Some(truth) = truth.constant() {
                return Expression::Truth(truth);
            }
        }
        Some(Known::Real(range)) if !calls => {
            if let Some(number) = range.constant() {
                return Expression::Number(number);
            }
        }
        Some(Known::Byte(Some(byte))) if !calls => return Expression::Byte(*byte),
        _ => {}
    }
    match value {
        Expression::Number(_)
        | Expression::Whole(_)
        | Expression::Byte(_)
        | Expression::Truth(_) => value.clone(),
        Expression::Read(place) => Expression::Read(at(place, ranges)),
        Expression::Negative(inner) => -of(inner),
        Expression::Magnitude(inner) => match range(inner, ranges) {
            Some(it) if it.low >= 0.0 && !it.minus_zero && !it.nan => of(inner),
            _ => of(inner).magnitude(),
        },
        Expression::Not(inner) => negated(of(inner)),
        Expression::ToReal(inner) => Expression::ToReal(Box::new(of(inner))),
        Expression::PowerOfTwo(inner) => Expression::PowerOfTwo(Box::new(of(inner))),
        Expression::Call(name, given) => Expression::Call(name, arguments(given, ranges)),
        Expression::Select(condition, then, otherwise) => match of(condition) {
            Expression::Truth(true) => of(then),
            Expression::Truth(false) => of(otherwise),
            condition => {
                let (then, otherwise) = (of(then), of(otherwise));
                if then == otherwise { then } else { condition.select(then, otherwise) }
            }
        },
        Expression::Binary(operator, left, right) => binary(*operator, [left, right], ranges),
    }
}

fn negated(value: Expression) -> Expression {
    match value {
        Expression::Truth(truth) => Expression::Truth(!truth),
        Expression::Not(inner) => *inner,
        other => other.negated(),
    }
}

fn binary(operator: Operator, sides: [&Expression; 2], ranges: &Ranges<'_>) -> Expression {
    // The sign of a zero does not show in a comparison.
    let compared = |side: &Expression| match side {
        Expression::Magnitude(inner) if range(inner, ranges).is_some_and(|it| it.low >= 0.0) => {
            simple(inner, ranges)
        }
        side => simple(side, ranges),
    };
    let compares = matches!(operator, Operator::Less | Operator::LessOrEqual);
    let [left, right] =
        sides.map(|side| if compares { compared(side) } else { simple(side, ranges) });
    let one = |it: &Expression| matches!(it, Expression::Number(number) if number.to_bits() == 1.0_f64.to_bits());
    match (operator, &left, &right) {
        (Operator::And, Expression::Truth(true), _)
        | (Operator::Or, Expression::Truth(false), _) => right,
        (Operator::And, _, Expression::Truth(true))
        | (Operator::Or, _, Expression::Truth(false)) => left,
        (Operator::And, Expression::Truth(false), _) => Expression::Truth(false),
        (Operator::Or, Expression::Truth(true), _) => Expression::Truth(true),
        (Operator::Multiply | Operator::Divide, _, right) if one(right) => left,
        (Operator::Multiply, left, _) if one(left) => right,
        (Operator::BitOr, _, Expression::Byte(0)) => left,
        (Operator::BitOr, Expression::Byte(0), _) => right,
        _ => Expression::binary(operator, left, right),
    }
}

type Names = BTreeSet<String>;

/// Without values that are written and not read again; `names` are those that are read behind the block, and then
/// those that are read from its beginning on.
fn live(body: Vec<Statement>, names: &mut Names) -> Vec<Statement> {
    let mut out = Vec::new();
    for statement in body.into_iter().rev() {
        if let Some(statement) = kept(statement, names) {
            out.push(statement);
        }
    }
    out.reverse();
    out
}

fn kept(statement: Statement, names: &mut Names) -> Option<Statement> {
    match statement {
        Statement::Let(ref name, _, ref value)
        | Statement::Set(Place::Local(ref name), ref value) => {
            let calls = format!("{value:?}").contains("Call(");
            if !names.remove(name) && !calls {
                return None;
            }
            read(value, names);
        }
        Statement::If(condition, then, otherwise) => {
            let mut behind = names.clone();
            let then = live(then, names);
            let otherwise = live(otherwise, &mut behind);
            names.extend(behind);
            if then.is_empty() && otherwise.is_empty() {
                return None;
            }
            read(&condition, names);
            return Some(Statement::If(condition, then, otherwise));
        }
        Statement::For(name, first, last, body) => {
            // A round may read what the one before has written.
            let behind = names.clone();
            words(&format!("{body:?}"), names);
            let body = live(body, names);
            names.extend(behind);
            return Some(Statement::For(name, first, last, body));
        }
        Statement::Return(ref value) => {
            names.clear();
            if let Some(value) = value {
                read(value, names);
            }
        }
        ref other => words(&format!("{other:?}"), names),
    }
    Some(statement)
}

fn read(value: &Expression, names: &mut Names) {
    words(&format!("{value:?}"), names);
}

/// Every name that stands in quotation marks: more than are read, never fewer.
fn words(text: &str, names: &mut Names) {
    names.extend(text.split('"').skip(1).step_by(2).map(str::to_owned));
}
