//! Runs a program: the meaning that every writer must keep.

use std::collections::BTreeMap;

use fspid_numeric::Real;

use crate::program::{
    Argument, Expression, Function, Operator, Parameter, Part, Place, Program, Statement, Value,
};

/// A value while the program runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell<R> {
    /// A real.
    Real(R),
    /// Reals side by side.
    Reals(Vec<R>),
    /// Bytes side by side.
    Bytes(Vec<u8>),
    /// A whole number.
    Whole(i32),
    /// A byte.
    Byte(u8),
    /// True or false.
    Truth(bool),
}

type Cells<R> = BTreeMap<String, Cell<R>>;

/// A program with its memory.
#[derive(Clone, Debug)]
pub struct Machine<'a, R> {
    program: &'a Program,
    parts: [Cells<R>; 4],
}

/// Why a statement ends the function.
enum Flow<R> {
    On,
    Ended(Option<Cell<R>>),
}

impl<'a, R: Real> Machine<'a, R> {
    /// A controller that has not flown yet.
    #[must_use]
    pub fn new(program: &'a Program) -> Self {
        let cells = |part| {
            let members = program.members(part).iter();
            members.map(|member| (member.name.clone(), begun(&member.value))).collect()
        };
        let parts = [Part::Configuration, Part::State, Part::Sample, Part::Answer].map(cells);
        Self { program, parts }
    }

    /// What a member holds.
    #[must_use]
    pub fn member(&self, part: Part, name: &str) -> Option<&Cell<R>> {
        self.parts[part as usize].get(name)
    }

    /// Puts something into a member.
    pub fn set(&mut self, part: Part, name: &str, cell: Cell<R>) {
        self.parts[part as usize].insert(name.to_owned(), cell);
    }

    /// Runs one function that is given nothing but parts.
    ///
    /// # Panics
    /// If the program asks for what it does not declare: a mistake of who composed it.
    pub fn run(&mut self, function: &str) {
        let function = self.program.function(function).expect("a function of the program");
        self.call(function, Vec::new());
    }

    /// What a function answers, and its arrays as it leaves them.
    fn call(&mut self, function: &Function, given: Vec<Cell<R>>) -> (Option<Cell<R>>, Cells<R>) {
        let names = function.parameters.iter().map(|Parameter { name, .. }| (*name).to_owned());
        let mut locals: Cells<R> = names.zip(given).collect();
        match self.block(&function.body, &mut locals) {
            Flow::On => (None, locals),
            Flow::Ended(answer) => (answer, locals),
        }
    }

    fn block(&mut self, body: &[Statement], locals: &mut Cells<R>) -> Flow<R> {
        for statement in body {
            if let Flow::Ended(answer) = self.statement(statement, locals) {
                return Flow::Ended(answer);
            }
        }
        Flow::On
    }

    fn statement(&mut self, statement: &Statement, locals: &mut Cells<R>) -> Flow<R> {
        match statement {
            Statement::Remark(_) => {}
            Statement::Let(name, _, value) => {
                let value = self.value(value, locals);
                locals.insert(name.clone(), value);
            }
            Statement::Array(name, count) => {
                locals.insert(name.clone(), Cell::Reals(vec![R::ZERO; *count]));
            }
            Statement::Set(place, value) => {
                let value = self.value(value, locals);
                self.put(place, value, locals);
            }
            Statement::If(condition, then, otherwise) => {
                let body = if self.truth(condition, locals) { then } else { otherwise };
                return self.block(body, locals);
            }
            Statement::For(name, first, last, body) => {
                for index in *first..=*last {
                    locals.insert(name.clone(), Cell::Whole(index));
                    if let Flow::Ended(answer) = self.block(body, locals) {
                        return Flow::Ended(answer);
                    }
                }
            }
            Statement::Call(function, arguments) => {
                self.called(function, arguments, locals);
            }
            Statement::Return(value) => {
                let answer = value.as_ref().map(|value| self.value(value, locals));
                return Flow::Ended(answer);
            }
        }
        Flow::On
    }

    fn called(
        &mut self,
        name: &str,
        arguments: &[Argument],
        locals: &mut Cells<R>,
    ) -> Option<Cell<R>> {
        let program = self.program;
        let function = program.function(name).expect("a function of the program");
        let given = arguments
            .iter()
            .map(|argument| match argument {
                Argument::Value(value) => self.value(value, locals),
                Argument::Array(name) => locals[name].clone(),
            })
            .collect();
        let (answer, mut left) = self.call(function, given);
        for (argument, parameter) in arguments.iter().zip(&function.parameters) {
            if let (Argument::Array(name), true) = (argument, parameter.written)
                && let Some(array) = left.remove(parameter.name)
            {
                locals.insert(name.clone(), array);
            }
        }
        answer
    }

    fn put(&mut self, place: &Place, value: Cell<R>, locals: &mut Cells<R>) {
        match place {
            Place::Local(name) => {
                locals.insert(name.clone(), value);
            }
            Place::Member(part, name) => self.set(*part, name, value),
            Place::Element(name, index) => {
                let index = self.index(index, locals);
                if let (Some(Cell::Reals(array)), Cell::Real(value)) = (locals.get_mut(name), value)
                {
                    array[index] = value;
                }
            }
            Place::MemberElement(part, name, index) => {
                let index = self.index(index, locals);
                let array = self.parts[*part as usize].get_mut(name);
                if let (Some(Cell::Reals(array)), Cell::Real(value)) = (array, value) {
                    array[index] = value;
                }
            }
        }
    }

    fn index(&mut self, index: &Expression, locals: &mut Cells<R>) -> usize {
        match self.value(index, locals) {
            Cell::Whole(index) => usize::try_from(index).expect("an index from 0"),
            other => panic!("{other:?} is no index"),
        }
    }

    fn truth(&mut self, value: &Expression, locals: &mut Cells<R>) -> bool {
        matches!(self.value(value, locals), Cell::Truth(true))
    }

    fn real(&mut self, value: &Expression, locals: &mut Cells<R>) -> R {
        match self.value(value, locals) {
            Cell::Real(value) => value,
            other => panic!("{other:?} is no real: {value:?}"),
        }
    }

    fn value(&mut self, value: &Expression, locals: &mut Cells<R>) -> Cell<R> {
        match value {
            Expression::Number(value) => Cell::Real(R::from_f64(*value)),
            Expression::Whole(value) => Cell::Whole(*value),
            Expression::Byte(value) => Cell::Byte(*value),
            Expression::Truth(value) => Cell::Truth(*value),
            Expression::Read(place) => self.read(place, locals),
            Expression::Negative(value) => Cell::Real(-self.real(value, locals)),
            Expression::Magnitude(value) => Cell::Real(self.real(value, locals).abs()),
            Expression::Not(value) => Cell::Truth(!self.truth(value, locals)),
            Expression::Binary(operator, left, right) => {
                let (left, right) = (self.value(left, locals), self.value(right, locals));
                joined(*operator, &left, &right)
            }
            Expression::Select(condition, then, otherwise) => {
                let chosen = if self.truth(condition, locals) { then } else { otherwise };
                self.value(chosen, locals)
            }
            Expression::ToReal(value) => match self.value(value, locals) {
                Cell::Whole(value) => Cell::Real(R::from_f64(f64::from(value))),
                other => panic!("{other:?} is no whole number"),
            },
            Expression::PowerOfTwo(value) => {
                let exponent = self.real(value, locals).to_f64();
                Cell::Real(R::from_f64(exponent.exp2()))
            }
            Expression::Call(function, arguments) => {
                self.called(function, arguments, locals).expect("a function that answers")
            }
        }
    }

    fn read(&mut self, place: &Place, locals: &mut Cells<R>) -> Cell<R> {
        let (array, index) = match place {
            Place::Local(name) => return locals[name].clone(),
            Place::Member(part, name) => return self.parts[*part as usize][name].clone(),
            Place::Element(name, index) => {
                let index = self.index(index, locals);
                (&locals[name], index)
            }
            Place::MemberElement(part, name, index) => {
                let index = self.index(index, locals);
                (&self.parts[*part as usize][name], index)
            }
        };
        match array {
            Cell::Reals(array) => Cell::Real(array[index]),
            Cell::Bytes(array) => Cell::Whole(i32::from(array[index])),
            other => panic!("{other:?} is no array"),
        }
    }
}

fn begun<R: Real>(value: &Value) -> Cell<R> {
    match value {
        Value::Real(value) => Cell::Real(R::from_f64(*value)),
        Value::Reals(values) => {
            Cell::Reals(values.iter().map(|value| R::from_f64(*value)).collect())
        }
        Value::Bytes(values) => Cell::Bytes(values.clone()),
        Value::Byte(value) => Cell::Byte(*value),
        Value::Truth(value) => Cell::Truth(*value),
    }
}

fn joined<R: Real>(operator: Operator, left: &Cell<R>, right: &Cell<R>) -> Cell<R> {
    match (left, right) {
        (Cell::Real(left), Cell::Real(right)) => reals(operator, *left, *right),
        (Cell::Whole(left), Cell::Whole(right)) => match operator {
            Operator::Add => Cell::Whole(left + right),
            Operator::Multiply => Cell::Whole(left * right),
            Operator::Equal => Cell::Truth(left == right),
            Operator::Less => Cell::Truth(left < right),
            other => panic!("{other:?} does not join whole numbers"),
        },
        (Cell::Byte(left), Cell::Byte(right)) => match operator {
            Operator::BitOr => Cell::Byte(left | right),
            Operator::Equal => Cell::Truth(left == right),
            other => panic!("{other:?} does not join bytes"),
        },
        (Cell::Truth(left), Cell::Truth(right)) => Cell::Truth(match operator {
            Operator::And => *left && *right,
            Operator::Or => *left || *right,
            other => panic!("{other:?} does not join truths"),
        }),
        other => panic!("{operator:?} does not join {other:?}"),
    }
}

fn reals<R: Real>(operator: Operator, left: R, right: R) -> Cell<R> {
    match operator {
        Operator::Add => Cell::Real(left + right),
        Operator::Subtract => Cell::Real(left - right),
        Operator::Multiply => Cell::Real(left * right),
        Operator::Divide => Cell::Real(left / right),
        Operator::Less => Cell::Truth(left < right),
        Operator::LessOrEqual => Cell::Truth(left <= right),
        Operator::Equal => Cell::Truth(left == right),
        Operator::NotEqual => Cell::Truth(left != right),
        Operator::And | Operator::Or | Operator::BitOr => {
            panic!("{operator:?} does not join reals")
        }
    }
}
