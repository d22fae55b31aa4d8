//! What a controller or a fuzzy system does in a sample, as a small program that every language here can be written in.
//!
//! Numbers are reals of one precision, whole numbers that count, and truths; there are loops of a constant count, no
//! recursion, no pointer and no heap. A [`Program`] is what the writers and the interpreter share, so that a
//! language is a way of writing and knows no equation.

mod expression;
mod statement;
mod walk;

pub use expression::{
    Argument, Expression, Operator, Part, Place, element, local, member, member_element, number,
    whole,
};
pub use statement::{Kind, Statement};
pub(crate) use walk::{each_expression, reads};

/// How many digits a real has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits.
    Single,
    /// 64 bits.
    Double,
}

impl Precision {
    /// The largest finite number.
    #[must_use]
    pub const fn largest(self) -> f64 {
        match self {
            Self::Single => f32::MAX as f64,
            Self::Double => f64::MAX,
        }
    }
}

/// A function of the program.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name, without a prefix.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub doc: &'static str,
    /// Which parts it is given.
    pub parts: &'static [Part],
    /// What else it is given.
    pub parameters: Vec<Parameter>,
    /// What it answers.
    pub answers: Option<Kind>,
    /// What it does.
    pub body: Vec<Statement>,
}

/// What a function is given by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
    /// The function writes into it: an array of the caller.
    pub written: bool,
}

/// A named value of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Its name, the unit last.
    pub name: String,
    /// What it is, in a line.
    pub doc: String,
    /// What it holds, and what it begins with.
    pub value: Value,
}

impl Member {
    /// True for what the rules R1 to R49 conclude, in this order.
    #[must_use]
    pub fn is_rules(&self) -> bool {
        self.name.starts_with("rules_")
    }
}

/// What a member holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A real.
    Real(f64),
    /// Reals side by side.
    Reals(Vec<f64>),
    /// Small whole numbers side by side, 0 to 255.
    Bytes(Vec<u8>),
    /// A small whole number whose bits count.
    Byte(u8),
    /// True or false.
    Truth(bool),
}

/// A controller as a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// How many digits its reals have.
    pub precision: Precision,
    /// What does not change while it flies.
    pub configuration: Vec<Member>,
    /// What it remembers.
    pub state: Vec<Member>,
    /// What it is given at a sample.
    pub sample: Vec<Member>,
    /// What it answers at a sample.
    pub answer: Vec<Member>,
    /// Its functions; one is called only below where it stands.
    pub functions: Vec<Function>,
}

impl Program {
    /// The members of a part.
    #[must_use]
    pub fn members(&self, part: Part) -> &[Member] {
        match part {
            Part::Configuration => &self.configuration,
            Part::State => &self.state,
            Part::Sample => &self.sample,
            Part::Answer => &self.answer,
        }
    }

    /// The function that answers a sample: `step` of a controller, `infer` of a fuzzy system.
    #[must_use]
    pub fn entry(&self) -> &'static str {
        if self.function("step").is_some() { "step" } else { "infer" }
    }

    /// The names of the answer's members: reals, then truths and bytes, as they stand in vectors.
    #[must_use]
    pub fn answers(&self) -> [Vec<&str>; 2] {
        [true, false].map(|reals| {
            let of_kind = |it: &&Member| matches!(it.value, Value::Real(_)) == reals;
            self.answer.iter().filter(of_kind).map(|it| it.name.as_str()).collect()
        })
    }

    /// True if a function, or one that it calls, puts something into a part.
    #[must_use]
    pub fn writes(&self, function: &Function, part: Part) -> bool {
        self.writes_in(&function.body, part)
    }

    fn writes_in(&self, body: &[Statement], part: Part) -> bool {
        body.iter().any(|statement| match statement {
            Statement::Set(Place::Member(to, _) | Place::MemberElement(to, ..), _) => *to == part,
            Statement::If(_, then, otherwise) => {
                self.writes_in(then, part) || self.writes_in(otherwise, part)
            }
            Statement::For(.., body) => self.writes_in(body, part),
            Statement::Call(name, _) => {
                self.function(name).is_some_and(|called| self.writes(called, part))
            }
            // What answers a value writes into nothing but arrays of its caller.
            Statement::Set(..)
            | Statement::Remark(_)
            | Statement::Let(..)
            | Statement::Array(..)
            | Statement::Return(_) => false,
        })
    }

    /// The function of that name.
    #[must_use]
    pub fn function(&self, name: &str) -> Option<&Function> {
        self.functions.iter().find(|function| function.name == name)
    }
}
