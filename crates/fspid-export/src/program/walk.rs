//! All expressions of a block.

use super::{Argument, Expression, Place, Statement};

impl Expression {
    /// What it is made of.
    pub(crate) fn children(&self) -> Vec<&Self> {
        match self {
            Self::Negative(inner)
            | Self::Magnitude(inner)
            | Self::Not(inner)
            | Self::ToReal(inner)
            | Self::PowerOfTwo(inner) => vec![inner],
            Self::Binary(_, left, right) => vec![left, right],
            Self::Select(condition, then, otherwise) => vec![condition, then, otherwise],
            Self::Call(_, given) => given_values(given),
            Self::Read(Place::Element(_, index) | Place::MemberElement(_, _, index)) => {
                vec![index]
            }
            _ => Vec::new(),
        }
    }
}

/// Every expression of a block, those within others too.
pub(crate) fn each_expression<'a>(body: &'a [Statement], visit: &mut impl FnMut(&'a Expression)) {
    for statement in body {
        match statement {
            Statement::Let(.., value)
            | Statement::Set(_, value)
            | Statement::Return(Some(value)) => within(value, visit),
            Statement::If(condition, then, otherwise) => {
                within(condition, visit);
                each_expression(then, visit);
                each_expression(otherwise, visit);
            }
            Statement::For(.., body) => each_expression(body, visit),
            Statement::Call(_, given) => {
                given_values(given).into_iter().for_each(|value| within(value, visit));
            }
            Statement::Remark(_) | Statement::Array(..) | Statement::Return(None) => {}
        }
    }
}

/// True where a block reads a value of the function.
pub(crate) fn reads(body: &[Statement], name: &str) -> bool {
    let mut found = false;
    each_expression(body, &mut |value| {
        found |= matches!(value, Expression::Read(Place::Local(read)) if read == name);
    });
    found
}

fn within<'a>(value: &'a Expression, visit: &mut impl FnMut(&'a Expression)) {
    visit(value);
    value.children().into_iter().for_each(|value| within(value, visit));
}

fn given_values(given: &[Argument]) -> Vec<&Expression> {
    let values = given.iter().filter_map(|it| match it {
        Argument::Value(value) => Some(value),
        Argument::Array(_) => None,
    });
    values.collect()
}
