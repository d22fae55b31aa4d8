//! What a text says, before anybody asks whether it makes sense.

use crate::value::{Kind, Value};

/// A function block or a program.
#[derive(Clone, Debug)]
pub(crate) struct Unit {
    pub(crate) name: String,
    pub(crate) variables: Vec<Variable>,
    pub(crate) body: Vec<Statement>,
}

/// In which section a variable is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Input,
    Output,
    Kept,
    Constant,
    Temporary,
}

#[derive(Clone, Debug)]
pub(crate) struct Variable {
    pub(crate) line: usize,
    pub(crate) name: String,
    pub(crate) section: Section,
    pub(crate) shape: Shape,
    /// What it begins with; nothing where the type says it.
    pub(crate) first: Vec<Value>,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    One(Kind),
    List(Kind, usize),
    Instance(String),
}

#[derive(Clone, Debug)]
pub(crate) struct Statement {
    pub(crate) line: usize,
    pub(crate) what: What,
}

#[derive(Clone, Debug)]
pub(crate) enum What {
    Assign(Place, Expression),
    If(Expression, Vec<Statement>, Vec<Statement>),
    For(String, i32, i32, Vec<Statement>),
    Call(String, Vec<(String, Expression)>),
    Return,
}

#[derive(Clone, Debug)]
pub(crate) enum Place {
    One(String),
    Element(String, Box<Expression>),
    Member(String, String),
}

#[derive(Clone, Debug)]
pub(crate) enum Expression {
    Literal(Value),
    Read(Place),
    Negative(Box<Self>),
    Not(Box<Self>),
    Binary(Operator, Box<Self>, Box<Self>),
    Function(Function, Box<Self>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Less,
    LessOrEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl Operator {
    pub(crate) const ALL: [Self; 10] = [
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
        Self::Less,
        Self::LessOrEqual,
        Self::Equal,
        Self::NotEqual,
        Self::And,
        Self::Or,
    ];

    /// As it is written.
    pub(crate) const fn sign(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Less => "<",
            Self::LessOrEqual => "<=",
            Self::Equal => "=",
            Self::NotEqual => "<>",
            Self::And => "AND",
            Self::Or => "OR",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    UsintToDint,
    DintToReal,
    DintToLreal,
}

impl Function {
    pub(crate) const ALL: [Self; 4] =
        [Self::Abs, Self::UsintToDint, Self::DintToReal, Self::DintToLreal];

    /// As it is written.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Abs => "ABS",
            Self::UsintToDint => "USINT_TO_DINT",
            Self::DintToReal => "DINT_TO_REAL",
            Self::DintToLreal => "DINT_TO_LREAL",
        }
    }
}
