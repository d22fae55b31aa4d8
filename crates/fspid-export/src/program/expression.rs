//! What a program computes.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A group of named values that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// What does not change while it flies.
    Configuration,
    /// What is remembered from sample to sample.
    State,
    /// What goes into a step.
    Sample,
    /// What comes out of it.
    Answer,
}

/// Where a value stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A value of the function, or one of its parameters.
    Local(String),
    /// A value of an array of the function, or of a parameter that is one.
    Element(String, Box<Expression>),
    /// A member of a part.
    Member(Part, String),
    /// A value of a member that is an array.
    MemberElement(Part, String, Box<Expression>),
}

/// What two values are joined by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Sum.
    Add,
    /// Difference.
    Subtract,
    /// Product.
    Multiply,
    /// Quotient.
    Divide,
    /// True if the first is less.
    Less,
    /// True if the first is not greater; false for NaN.
    LessOrEqual,
    /// True if both are the same number.
    Equal,
    /// True if they are not.
    NotEqual,
    /// True if both are.
    And,
    /// True if one is.
    Or,
    /// The bits of both bytes.
    BitOr,
}

/// What a function is called with.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// A value.
    Value(Expression),
    /// An array of the caller.
    Array(String),
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A real; finite.
    Number(f64),
    /// A whole number.
    Whole(i32),
    /// A byte.
    Byte(u8),
    /// True or false.
    Truth(bool),
    /// What stands somewhere.
    Read(Place),
    /// The number with the other sign.
    Negative(Box<Self>),
    /// Its magnitude.
    Magnitude(Box<Self>),
    /// The other truth.
    Not(Box<Self>),
    /// Two values joined.
    Binary(Operator, Box<Self>, Box<Self>),
    /// The second where the first is true, else the third; all three may be computed.
    Select(Box<Self>, Box<Self>, Box<Self>),
    /// A whole number as a real.
    ToReal(Box<Self>),
    /// 2 to the power of a real that is a whole number of a normal exponent.
    PowerOfTwo(Box<Self>),
    /// What a function answers; the parts that it takes are those of the caller.
    Call(&'static str, Vec<Argument>),
}

/// A value of the function.
#[must_use]
pub fn local(name: &str) -> Expression {
    Expression::Read(Place::Local(name.to_owned()))
}

/// A value of an array of the function.
#[must_use]
pub fn element(name: &str, index: Expression) -> Expression {
    Expression::Read(Place::Element(name.to_owned(), Box::new(index)))
}

/// A member of a part.
#[must_use]
pub fn member(part: Part, name: &str) -> Expression {
    Expression::Read(Place::Member(part, name.to_owned()))
}

/// A value of a member that is an array.
#[must_use]
pub fn member_element(part: Part, name: &str, index: Expression) -> Expression {
    Expression::Read(Place::MemberElement(part, name.to_owned(), Box::new(index)))
}

/// A real.
#[must_use]
pub const fn number(value: f64) -> Expression {
    Expression::Number(value)
}

/// A whole number.
#[must_use]
pub const fn whole(value: i32) -> Expression {
    Expression::Whole(value)
}

impl Expression {
    /// Joins two values.
    #[must_use]
    pub fn binary(operator: Operator, left: Self, right: Self) -> Self {
        Self::Binary(operator, Box::new(left), Box::new(right))
    }

    /// True if this is less.
    #[must_use]
    pub fn less(self, other: Self) -> Self {
        Self::binary(Operator::Less, self, other)
    }

    /// True if this is not greater; false for NaN.
    #[must_use]
    pub fn at_most(self, other: Self) -> Self {
        Self::binary(Operator::LessOrEqual, self, other)
    }

    /// True if both are.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self::binary(Operator::And, self, other)
    }

    /// True if one is.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self::binary(Operator::Or, self, other)
    }

    /// The other truth.
    #[must_use]
    pub fn negated(self) -> Self {
        Self::Not(Box::new(self))
    }

    /// The magnitude of a real.
    #[must_use]
    pub fn magnitude(self) -> Self {
        Self::Magnitude(Box::new(self))
    }

    /// `then` where this is true, else `otherwise`.
    #[must_use]
    pub fn select(self, then: Self, otherwise: Self) -> Self {
        Self::Select(Box::new(self), Box::new(then), Box::new(otherwise))
    }

    /// The smaller of two numbers.
    #[must_use]
    pub fn smaller(self, other: Self) -> Self {
        self.clone().less(other.clone()).select(self, other)
    }

    /// The larger of two numbers.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        other.clone().less(self.clone()).select(self, other)
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $operator:ident) => {
        impl $trait for Expression {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self::binary(Operator::$operator, self, other)
            }
        }
    };
}

operator!(Add, add, Add);
operator!(Sub, sub, Subtract);
operator!(Mul, mul, Multiply);
operator!(Div, div, Divide);

impl Neg for Expression {
    type Output = Self;

    fn neg(self) -> Self {
        Self::Negative(Box::new(self))
    }
}
