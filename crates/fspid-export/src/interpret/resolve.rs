//! A program with places in place of names, so that running it looks nothing up.

use crate::program::{
    Argument, Expression, Function, Operator, Parameter, Part, Place, Program, Statement,
};

/// Values that a function may have.
pub(super) const MOST_LOCALS: usize = 256;
/// Most values that a function is given: the points of a set, each with its grade, and a value.
pub(super) const MOST_ARGUMENTS: usize = 25;

/// Where a value stands.
#[derive(Clone, Debug)]
pub(super) enum Slot {
    Local(usize),
    Element(usize, Box<Node>),
    Member(usize, usize),
    MemberElement(usize, usize, Box<Node>),
}

#[derive(Clone, Debug)]
pub(super) enum Given {
    Value(Node),
    Array(usize),
}

/// An expression; numbers of branches count which way it goes.
#[derive(Clone, Debug)]
pub(super) enum Node {
    Number(f64),
    Whole(i32),
    Byte(u8),
    Truth(bool),
    Read(Slot),
    Negative(Box<Self>),
    Magnitude(Box<Self>),
    Not(Box<Self>),
    And(Box<Self>, Box<Self>),
    Or(Box<Self>, Box<Self>),
    Binary(Operator, Box<Self>, Box<Self>),
    /// One side of `and` or `or`.
    Counted(usize, Box<Self>),
    Select(usize, Box<Self>, Box<Self>, Box<Self>),
    ToReal(Box<Self>),
    PowerOfTwo(Box<Self>),
    Call(usize, Vec<Given>),
}

/// A statement.
#[derive(Clone, Debug)]
pub(super) enum Action {
    Array(usize, usize),
    Set(Slot, Node),
    If(usize, Node, Vec<Self>, Vec<Self>),
    For(usize, i32, i32, Vec<Self>),
    Call(usize, Vec<Given>),
    Return(Option<Node>),
}

#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) body: Vec<Action>,
}

/// The functions of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Resolved {
    pub(super) functions: Vec<Body>,
    /// In which function what is asked.
    pub(super) branches: Vec<(&'static str, Expression)>,
}

impl Resolved {
    pub(super) fn new(program: &Program) -> Self {
        let mut resolved = Self::default();
        for function in &program.functions {
            let names = function.parameters.iter().map(|Parameter { name, .. }| (*name).to_owned());
            let mut scope = Scope {
                program,
                function,
                names: names.collect(),
                branches: &mut resolved.branches,
            };
            let body = scope.block(&function.body);
            resolved.functions.push(Body { body });
        }
        resolved
    }
}

/// The names of one function.
struct Scope<'a> {
    program: &'a Program,
    function: &'a Function,
    names: Vec<String>,
    branches: &'a mut Vec<(&'static str, Expression)>,
}

impl Scope<'_> {
    /// The place of a value; a name that is declared twice is one value.
    fn local(&mut self, name: &str) -> usize {
        let known = self.names.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            assert!(self.names.len() <= MOST_LOCALS, "{} has too many values", self.function.name);
            self.names.len() - 1
        })
    }

    fn member(&self, part: Part, name: &str) -> usize {
        let place = self.program.members(part).iter().position(|member| member.name == name);
        place.unwrap_or_else(|| panic!("{part:?} has no {name}"))
    }

    fn branch(&mut self, condition: &Expression) -> usize {
        self.branches.push((self.function.name, condition.clone()));
        self.branches.len() - 1
    }

    fn block(&mut self, body: &[Statement]) -> Vec<Action> {
        body.iter().filter_map(|statement| self.statement(statement)).collect()
    }

    fn statement(&mut self, statement: &Statement) -> Option<Action> {
        Some(match statement {
            Statement::Remark(_) => return None,
            Statement::Let(name, _, value) => {
                let value = self.node(value);
                Action::Set(Slot::Local(self.local(name)), value)
            }
            Statement::Array(name, count) => Action::Array(self.local(name), *count),
            Statement::Set(place, value) => {
                let value = self.node(value);
                Action::Set(self.slot(place), value)
            }
            Statement::If(condition, then, otherwise) => {
                let branch = self.branch(condition);
                let condition = self.node(condition);
                Action::If(branch, condition, self.block(then), self.block(otherwise))
            }
            Statement::For(name, first, last, body) => {
                Action::For(self.local(name), *first, *last, self.block(body))
            }
            Statement::Call(function, arguments) => {
                Action::Call(self.called(function), self.given(arguments))
            }
            Statement::Return(value) => {
                Action::Return(value.as_ref().map(|value| self.node(value)))
            }
        })
    }

    fn called(&self, name: &str) -> usize {
        let index = self.program.functions.iter().position(|function| function.name == name);
        index.unwrap_or_else(|| panic!("there is no function {name}"))
    }

    fn given(&mut self, arguments: &[Argument]) -> Vec<Given> {
        let given = |argument: &Argument| match argument {
            Argument::Value(value) => Given::Value(self.node(value)),
            Argument::Array(name) => Given::Array(self.local(name)),
        };
        arguments.iter().map(given).collect()
    }

    fn slot(&mut self, place: &Place) -> Slot {
        match place {
            Place::Local(name) => Slot::Local(self.local(name)),
            Place::Element(name, index) => {
                let index = Box::new(self.node(index));
                Slot::Element(self.local(name), index)
            }
            Place::Member(part, name) => Slot::Member(*part as usize, self.member(*part, name)),
            Place::MemberElement(part, name, index) => {
                let index = Box::new(self.node(index));
                Slot::MemberElement(*part as usize, self.member(*part, name), index)
            }
        }
    }

    fn boxed(&mut self, value: &Expression) -> Box<Node> {
        Box::new(self.node(value))
    }

    /// One side of what joins truths; a side that joins truths itself counts its own sides.
    fn side(&mut self, value: &Expression) -> Box<Node> {
        if matches!(value, Expression::Binary(Operator::And | Operator::Or, ..)) {
            return self.boxed(value);
        }
        let branch = self.branch(value);
        Box::new(Node::Counted(branch, self.boxed(value)))
    }

    fn node(&mut self, value: &Expression) -> Node {
        match value {
            Expression::Number(value) => Node::Number(*value),
            Expression::Whole(value) => Node::Whole(*value),
            Expression::Byte(value) => Node::Byte(*value),
            Expression::Truth(value) => Node::Truth(*value),
            Expression::Read(place) => Node::Read(self.slot(place)),
            Expression::Negative(value) => Node::Negative(self.boxed(value)),
            Expression::Magnitude(value) => Node::Magnitude(self.boxed(value)),
            Expression::Not(value) => Node::Not(self.boxed(value)),
            Expression::Binary(Operator::And, left, right) => {
                Node::And(self.side(left), self.side(right))
            }
            Expression::Binary(Operator::Or, left, right) => {
                Node::Or(self.side(left), self.side(right))
            }
            Expression::Binary(operator, left, right) => {
                Node::Binary(*operator, self.boxed(left), self.boxed(right))
            }
            Expression::Select(condition, then, otherwise) => {
                let branch = self.branch(condition);
                let condition = self.boxed(condition);
                Node::Select(branch, condition, self.boxed(then), self.boxed(otherwise))
            }
            Expression::ToReal(value) => Node::ToReal(self.boxed(value)),
            Expression::PowerOfTwo(value) => Node::PowerOfTwo(self.boxed(value)),
            Expression::Call(function, arguments) => {
                Node::Call(self.called(function), self.given(arguments))
            }
        }
    }
}
