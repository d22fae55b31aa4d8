//! Runs a program: the meaning that every writer must keep, and a count of the ways that it has gone.

mod resolve;

use fspid_numeric::Real;

use crate::program::{Expression, Operator, Part, Program, Value};
use resolve::{Action, Given, Node, Resolved, Slot};

/// What a member holds.
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

/// A value while the program runs.
#[derive(Clone, Copy, Debug)]
enum Single<R> {
    Real(R),
    Whole(i32),
    Byte(u8),
    Truth(bool),
    /// Which of the machine's arrays.
    Array(usize),
}

/// A place where a program goes one of two ways, and how often it went which.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// The function that it is in.
    pub function: &'static str,
    /// What is asked.
    pub condition: Expression,
    /// How often it held.
    pub held: u64,
    /// How often it did not.
    pub failed: u64,
}

/// A program with its memory.
#[derive(Clone, Debug)]
pub struct Machine<'a, R> {
    program: &'a Program,
    code: Resolved,
    parts: [Vec<Cell<R>>; 4],
    /// Arrays of the functions that run.
    arrays: Vec<Vec<R>>,
    counts: Vec<[u64; 2]>,
}

/// Why a statement ends the function.
enum Flow<R> {
    On,
    Ended(Option<Single<R>>),
}

type Locals<R> = [Single<R>];

impl<'a, R: Real> Machine<'a, R> {
    /// A controller that has not flown yet.
    #[must_use]
    pub fn new(program: &'a Program) -> Self {
        let cells =
            |part| program.members(part).iter().map(|member| begun(&member.value)).collect();
        let parts = [Part::Configuration, Part::State, Part::Sample, Part::Answer].map(cells);
        let code = Resolved::new(program);
        let counts = vec![[0; 2]; code.branches.len()];
        Self { program, code, parts, arrays: Vec::new(), counts }
    }

    /// What a member holds.
    #[must_use]
    pub fn member(&self, part: Part, name: &str) -> Option<&Cell<R>> {
        let index = self.program.members(part).iter().position(|member| member.name == name)?;
        self.parts[part as usize].get(index)
    }

    /// Puts something into a member; one that the program does not have is left out.
    pub fn set(&mut self, part: Part, name: &str, cell: Cell<R>) {
        let index = self.program.members(part).iter().position(|member| member.name == name);
        if let Some(place) = index.and_then(|index| self.parts[part as usize].get_mut(index)) {
            *place = cell;
        }
    }

    /// Where the program could go two ways, and how often it went which since it was made.
    #[must_use]
    pub fn branches(&self) -> Vec<Branch> {
        let counted = self.code.branches.iter().zip(&self.counts);
        counted
            .map(|((function, condition), [failed, held])| Branch {
                function,
                condition: condition.clone(),
                held: *held,
                failed: *failed,
            })
            .collect()
    }

    /// Runs one function that is given nothing but parts.
    ///
    /// # Panics
    /// If the program asks for what it does not declare: a mistake of who composed it.
    pub fn run(&mut self, function: &str) {
        self.ask(function, &[]);
    }

    /// Runs one function that is given parts and values, and answers what it answers.
    ///
    /// # Panics
    /// As [`run`](Self::run), and where a value is an array.
    pub fn ask(&mut self, function: &str, given: &[Cell<R>]) -> Option<Cell<R>> {
        let index = self.program.functions.iter().position(|it| it.name == function);
        let given = given.iter().map(|cell| match cell {
            Cell::Real(value) => Single::Real(*value),
            Cell::Whole(value) => Single::Whole(*value),
            Cell::Byte(value) => Single::Byte(*value),
            Cell::Truth(value) => Single::Truth(*value),
            Cell::Reals(_) | Cell::Bytes(_) => panic!("an array is given by nobody outside"),
        });
        let given: Vec<Single<R>> = given.collect();
        let code = std::mem::take(&mut self.code);
        let answer = self.call(&code, index.expect("a function of the program"), &given);
        self.code = code;
        answer.map(|value| match value {
            Single::Real(value) => Cell::Real(value),
            Single::Whole(value) => Cell::Whole(value),
            Single::Byte(value) => Cell::Byte(value),
            Single::Truth(value) => Cell::Truth(value),
            Single::Array(_) => panic!("no function answers an array"),
        })
    }

    fn call(&mut self, code: &Resolved, index: usize, given: &[Single<R>]) -> Option<Single<R>> {
        let function = &code.functions[index];
        let (mut locals, arrays) = ([Single::Whole(0); resolve::MOST_LOCALS], self.arrays.len());
        locals[..given.len()].copy_from_slice(given);
        let ended = self.block(code, &function.body, &mut locals);
        self.arrays.truncate(arrays);
        match ended {
            Flow::On => None,
            Flow::Ended(answer) => answer,
        }
    }

    fn block(&mut self, code: &Resolved, body: &[Action], locals: &mut Locals<R>) -> Flow<R> {
        for action in body {
            if let Flow::Ended(answer) = self.action(code, action, locals) {
                return Flow::Ended(answer);
            }
        }
        Flow::On
    }

    fn action(&mut self, code: &Resolved, action: &Action, locals: &mut Locals<R>) -> Flow<R> {
        match action {
            Action::Array(local, count) => {
                locals[*local] = Single::Array(self.arrays.len());
                self.arrays.push(vec![R::ZERO; *count]);
            }
            Action::Set(slot, value) => {
                let value = self.value(code, value, locals);
                self.put(code, slot, value, locals);
            }
            Action::If(branch, condition, then, otherwise) => {
                let holds = self.branch(code, *branch, condition, locals);
                return self.block(code, if holds { then } else { otherwise }, locals);
            }
            Action::For(local, first, last, body) => {
                for index in *first..=*last {
                    locals[*local] = Single::Whole(index);
                    if let Flow::Ended(answer) = self.block(code, body, locals) {
                        return Flow::Ended(answer);
                    }
                }
            }
            Action::Call(function, given) => {
                self.called(code, *function, given, locals);
            }
            Action::Return(value) => {
                return Flow::Ended(value.as_ref().map(|value| self.value(code, value, locals)));
            }
        }
        Flow::On
    }

    fn called(
        &mut self,
        code: &Resolved,
        function: usize,
        given: &[Given],
        locals: &mut Locals<R>,
    ) -> Option<Single<R>> {
        let mut values = [Single::Whole(0); resolve::MOST_ARGUMENTS];
        for (place, given) in values.iter_mut().zip(given) {
            *place = match given {
                Given::Value(value) => self.value(code, value, locals),
                Given::Array(local) => locals[*local],
            };
        }
        self.call(code, function, &values[..given.len()])
    }

    fn branch(
        &mut self,
        code: &Resolved,
        branch: usize,
        condition: &Node,
        locals: &mut Locals<R>,
    ) -> bool {
        let holds = self.truth(code, condition, locals);
        self.counts[branch][usize::from(holds)] += 1;
        holds
    }

    fn put(&mut self, code: &Resolved, slot: &Slot, value: Single<R>, locals: &mut Locals<R>) {
        match slot {
            Slot::Local(local) => locals[*local] = value,
            Slot::Member(part, member) => {
                let cell = &mut self.parts[*part][*member];
                *cell = match value {
                    Single::Real(value) => Cell::Real(value),
                    Single::Byte(value) => Cell::Byte(value),
                    Single::Truth(value) => Cell::Truth(value),
                    other => panic!("{other:?} is remembered by nobody"),
                };
            }
            Slot::Element(local, index) => {
                let index = self.index(code, index, locals);
                if let (Single::Array(array), Single::Real(value)) = (locals[*local], value) {
                    self.arrays[array][index] = value;
                }
            }
            Slot::MemberElement(part, member, index) => {
                let index = self.index(code, index, locals);
                if let (Cell::Reals(array), Single::Real(value)) =
                    (&mut self.parts[*part][*member], value)
                {
                    array[index] = value;
                }
            }
        }
    }

    fn index(&mut self, code: &Resolved, index: &Node, locals: &mut Locals<R>) -> usize {
        match self.value(code, index, locals) {
            Single::Whole(index) => usize::try_from(index).expect("an index from 0"),
            other => panic!("{other:?} is no index"),
        }
    }

    fn truth(&mut self, code: &Resolved, value: &Node, locals: &mut Locals<R>) -> bool {
        matches!(self.value(code, value, locals), Single::Truth(true))
    }

    fn real(&mut self, code: &Resolved, value: &Node, locals: &mut Locals<R>) -> R {
        match self.value(code, value, locals) {
            Single::Real(value) => value,
            other => panic!("{other:?} is no real: {value:?}"),
        }
    }

    fn value(&mut self, code: &Resolved, value: &Node, locals: &mut Locals<R>) -> Single<R> {
        match value {
            Node::Number(value) => Single::Real(R::from_f64(*value)),
            Node::Whole(value) => Single::Whole(*value),
            Node::Byte(value) => Single::Byte(*value),
            Node::Truth(value) => Single::Truth(*value),
            Node::Read(slot) => self.read(code, slot, locals),
            Node::Negative(value) => Single::Real(-self.real(code, value, locals)),
            Node::Magnitude(value) => Single::Real(self.real(code, value, locals).abs()),
            Node::Not(value) => Single::Truth(!self.truth(code, value, locals)),
            // The second is asked only where it matters, as languages do.
            Node::And(left, right) => {
                Single::Truth(self.truth(code, left, locals) && self.truth(code, right, locals))
            }
            Node::Or(left, right) => {
                Single::Truth(self.truth(code, left, locals) || self.truth(code, right, locals))
            }
            Node::Binary(operator, left, right) => {
                let left = self.value(code, left, locals);
                joined(*operator, left, self.value(code, right, locals))
            }
            Node::Counted(branch, value) => {
                Single::Truth(self.branch(code, *branch, value, locals))
            }
            Node::Select(branch, condition, then, otherwise) => {
                let holds = self.branch(code, *branch, condition, locals);
                self.value(code, if holds { then } else { otherwise }, locals)
            }
            Node::ToReal(value) => match self.value(code, value, locals) {
                Single::Whole(value) => Single::Real(R::from_f64(f64::from(value))),
                other => panic!("{other:?} is no whole number"),
            },
            Node::PowerOfTwo(value) => {
                Single::Real(R::from_f64(self.real(code, value, locals).to_f64().exp2()))
            }
            Node::Call(function, given) => {
                self.called(code, *function, given, locals).expect("a function that answers")
            }
        }
    }

    fn read(&mut self, code: &Resolved, slot: &Slot, locals: &mut Locals<R>) -> Single<R> {
        match slot {
            Slot::Local(local) => locals[*local],
            Slot::Element(local, index) => {
                match (self.index(code, index, locals), locals[*local]) {
                    (index, Single::Array(array)) => Single::Real(self.arrays[array][index]),
                    (_, other) => panic!("{other:?} is no array"),
                }
            }
            Slot::Member(part, member) => match &self.parts[*part][*member] {
                Cell::Real(value) => Single::Real(*value),
                Cell::Byte(value) => Single::Byte(*value),
                Cell::Truth(value) => Single::Truth(*value),
                other => panic!("{other:?} is read by nobody"),
            },
            Slot::MemberElement(part, member, index) => {
                let index = self.index(code, index, locals);
                match &self.parts[*part][*member] {
                    Cell::Reals(array) => Single::Real(array[index]),
                    Cell::Bytes(array) => Single::Whole(i32::from(array[index])),
                    other => panic!("{other:?} is no array"),
                }
            }
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

fn joined<R: Real>(operator: Operator, left: Single<R>, right: Single<R>) -> Single<R> {
    match (left, right) {
        (Single::Real(left), Single::Real(right)) => reals(operator, left, right),
        (Single::Whole(left), Single::Whole(right)) => match operator {
            Operator::Add => Single::Whole(left + right),
            Operator::Subtract => Single::Whole(left - right),
            Operator::Multiply => Single::Whole(left * right),
            Operator::Equal => Single::Truth(left == right),
            Operator::NotEqual => Single::Truth(left != right),
            Operator::Less => Single::Truth(left < right),
            other => panic!("{other:?} does not join whole numbers"),
        },
        (Single::Byte(left), Single::Byte(right)) => match operator {
            Operator::BitOr => Single::Byte(left | right),
            Operator::Equal => Single::Truth(left == right),
            Operator::NotEqual => Single::Truth(left != right),
            other => panic!("{other:?} does not join bytes"),
        },
        other => panic!("{operator:?} does not join {other:?}"),
    }
}

fn reals<R: Real>(operator: Operator, left: R, right: R) -> Single<R> {
    match operator {
        Operator::Add => Single::Real(left + right),
        Operator::Subtract => Single::Real(left - right),
        Operator::Multiply => Single::Real(left * right),
        Operator::Divide => Single::Real(left / right),
        Operator::Less => Single::Truth(left < right),
        Operator::LessOrEqual => Single::Truth(left <= right),
        Operator::Equal => Single::Truth(left == right),
        Operator::NotEqual => Single::Truth(left != right),
        Operator::And | Operator::Or | Operator::BitOr => {
            panic!("{operator:?} does not join reals")
        }
    }
}
