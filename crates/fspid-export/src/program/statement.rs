//! What a program does.

use super::{Argument, Expression, Part, Place};

/// What a value of a function is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A real.
    Real,
    /// Reals side by side.
    Reals(usize),
    /// A whole number.
    Whole,
    /// A byte.
    Byte,
    /// True or false.
    Truth,
}

/// One thing to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// A remark for who reads the code: what follows and why.
    Remark(String),
    /// Declares a value of the function and gives it its first one.
    Let(String, Kind, Expression),
    /// Declares an array of reals, all zero.
    Array(String, usize),
    /// Puts a value somewhere.
    Set(Place, Expression),
    /// Does the first where the truth holds, else the second.
    If(Expression, Vec<Self>, Vec<Self>),
    /// Does something with a whole number from the first to the last.
    For(String, i32, i32, Vec<Self>),
    /// Calls a function for what it does to the parts.
    Call(&'static str, Vec<Argument>),
    /// Ends the function.
    Return(Option<Expression>),
}

impl Statement {
    /// Declares a real.
    #[must_use]
    pub fn real(name: &str, value: Expression) -> Self {
        Self::Let(name.to_owned(), Kind::Real, value)
    }

    /// Puts a value into a value of the function.
    #[must_use]
    pub fn set(name: &str, value: Expression) -> Self {
        Self::Set(Place::Local(name.to_owned()), value)
    }

    /// Puts a value into an array of the function.
    #[must_use]
    pub fn set_element(name: &str, index: Expression, value: Expression) -> Self {
        Self::Set(Place::Element(name.to_owned(), Box::new(index)), value)
    }

    /// Puts a value into a member of a part.
    #[must_use]
    pub fn set_member(part: Part, name: &str, value: Expression) -> Self {
        Self::Set(Place::Member(part, name.to_owned()), value)
    }

    /// Does something where a truth holds.
    #[must_use]
    pub fn when(condition: Expression, then: Vec<Self>) -> Self {
        Self::If(condition, then, Vec::new())
    }

    /// A loop over whole numbers from 0, `count` of them.
    #[must_use]
    pub fn repeat(name: &str, count: i32, body: Vec<Self>) -> Self {
        Self::For(name.to_owned(), 0, count - 1, body)
    }
}
