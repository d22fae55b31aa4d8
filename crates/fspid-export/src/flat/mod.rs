//! A program as one list of statements, for languages whose functions or conditional expressions differ too much from
//! compiler to compiler.
//!
//! What is called stands where it was called, a choice is a statement that decides, a power of two is a product of
//! exact powers. Operations and their order stay as they are, and so do the bits. Every value gets the name of its
//! function in front, so that none is a word that a language has reserved.

mod hoist;

use crate::program::{
    Argument, Expression, Function, Kind, Operator, Part, Place, Precision, Program, Statement,
    Value, local, number,
};

/// The functions of a program, flat.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Flat {
    /// Values of all functions with their kinds, in the order in which they are first named.
    pub(crate) values: Vec<(String, Kind)>,
    /// Constants that the program itself does not have.
    pub(crate) powers: Option<(&'static str, Value)>,
    /// What `reset` does.
    pub(crate) reset: Vec<Statement>,
    /// What `step` does, or `infer` of a fuzzy system.
    pub(crate) step: Vec<Statement>,
    /// What `track` does before and behind a step, where there is one; before it all may end.
    pub(crate) track: Option<[Vec<Statement>; 2]>,
}

/// True where a step has nothing more to do.
const OVER: &str = "step_is_over";

/// Name of the constants 2^64 (or 2^512), 2^32, ... 2.
pub(crate) const POWERS: &str = "powers_of_two";

/// The functions of a program, flat.
pub(crate) fn flatten(program: &Program) -> Flat {
    let mut flattener = Flattener { program, values: Vec::new(), hoisted: 0, needs_powers: false };
    let reset = flattener.function("reset", Answer::Leaves);
    let track = program.function("track").map(|function| flattener.track(&function.body));
    let step = match track {
        Some(_) => flattener.step(),
        None => flattener.function(program.entry(), Answer::Leaves),
    };
    let powers = flattener.needs_powers.then(|| {
        let powers = doublings(program.precision).map(|exponent| f64::exp2(f64::from(exponent)));
        (POWERS, Value::Reals(powers.collect()))
    });
    Flat { values: flattener.values, powers, reset, step, track }
}

/// The exponents whose sums are all exponents of normal numbers, from the largest on.
pub(crate) fn doublings(precision: Precision) -> impl Iterator<Item = u32> {
    let most = match precision {
        Precision::Single => 6,
        Precision::Double => 9,
    };
    (0..=most).rev().map(|place| 1 << place)
}

/// Where what a function answers goes.
#[derive(Clone)]
enum Answer {
    /// Nowhere: it ends all.
    Leaves,
    /// Nowhere: it notes that the function is over, as more follows behind it.
    Notes,
    /// Nowhere: what follows goes on.
    Nothing,
    /// Into this place.
    Into(Place),
}

/// A function as it is called here.
#[derive(Clone)]
struct Scope {
    function: &'static str,
    answer: Answer,
    /// Its parameters that are arrays, and which array of the caller each is.
    arrays: Vec<(&'static str, String)>,
}

impl Scope {
    fn name(&self, name: &str) -> String {
        let given = self.arrays.iter().find(|(parameter, _)| *parameter == name);
        given.map_or_else(|| format!("{}_{name}", self.function), |(_, array)| array.clone())
    }
}

struct Flattener<'a> {
    program: &'a Program,
    values: Vec<(String, Kind)>,
    /// How many hoisted values are in use.
    hoisted: usize,
    needs_powers: bool,
}

impl Flattener<'_> {
    fn function(&mut self, name: &'static str, answer: Answer) -> Vec<Statement> {
        let scope = Scope { function: name, answer, arrays: Vec::new() };
        let function = self.program.function(name);
        function.map_or_else(Vec::new, |function| self.block(&scope, &function.body))
    }

    fn step(&mut self) -> Vec<Statement> {
        let mut step = vec![Statement::set(OVER, Expression::Truth(false))];
        self.declare(OVER, Kind::Truth);
        step.extend(self.function("step", Answer::Notes));
        step
    }

    /// What stands around the step in it.
    fn track(&mut self, body: &[Statement]) -> [Vec<Statement>; 2] {
        let scope = Scope { function: "track", answer: Answer::Leaves, arrays: Vec::new() };
        let is_step = |it: &Statement| matches!(it, Statement::Call("step", _));
        let place = body.iter().position(is_step).unwrap_or(body.len());
        let (before, behind) = body.split_at(place);
        [before, behind.get(1..).unwrap_or_default()].map(|part| self.block(&scope, part))
    }

    fn declare(&mut self, name: &str, kind: Kind) {
        match self.values.iter().find(|(known, _)| known == name) {
            Some((_, known)) => debug_assert_eq!(*known, kind, "two values are called {name}"),
            None => self.values.push((name.to_owned(), kind)),
        }
    }

    fn block(&mut self, scope: &Scope, body: &[Statement]) -> Vec<Statement> {
        let mut out = Vec::new();
        for (place, statement) in body.iter().enumerate() {
            let in_use = self.hoisted;
            match statement {
                Statement::Return(value) => {
                    self.answered(scope, value.as_ref(), &mut out);
                    return out;
                }
                Statement::If(_, then, otherwise)
                    if matches!(scope.answer, Answer::Notes)
                        && (returns(then) || returns(otherwise)) =>
                {
                    self.statement(scope, statement, &mut out);
                    let rest = self.block(scope, body.get(place + 1..).unwrap_or_default());
                    decide(local(OVER).negated(), rest, Vec::new(), &mut out);
                    return out;
                }
                // What follows belongs to the way on which the function goes on.
                Statement::If(condition, then, otherwise)
                    if !matches!(scope.answer, Answer::Leaves)
                        && (returns(then) || returns(otherwise)) =>
                {
                    let rest = body.get(place + 1..).unwrap_or_default();
                    let condition = self.value(scope, condition, &mut out);
                    let [then, otherwise] = [then, otherwise].map(|way| {
                        let way: Vec<Statement> = way.iter().chain(rest).cloned().collect();
                        self.block(scope, &way)
                    });
                    decide(condition, then, otherwise, &mut out);
                    return out;
                }
                statement => self.statement(scope, statement, &mut out),
            }
            self.hoisted = in_use;
        }
        out
    }

    fn answered(&mut self, scope: &Scope, value: Option<&Expression>, out: &mut Vec<Statement>) {
        match (&scope.answer, value) {
            (Answer::Into(place), Some(value)) => self.assign(scope, place.clone(), value, out),
            (Answer::Leaves, _) => out.push(Statement::Return(None)),
            (Answer::Notes, _) => out.push(Statement::set(OVER, Expression::Truth(true))),
            (Answer::Nothing | Answer::Into(_), _) => {}
        }
    }

    fn statement(&mut self, scope: &Scope, statement: &Statement, out: &mut Vec<Statement>) {
        match statement {
            Statement::Remark(text) => out.push(Statement::Remark(text.clone())),
            Statement::Let(name, kind, value) => {
                let name = scope.name(name);
                self.declare(&name, *kind);
                self.assign(scope, Place::Local(name), value, out);
            }
            Statement::Array(name, count) => self.zeros(scope, name, *count, out),
            Statement::Set(place, value) => {
                let place = self.place(scope, place, out);
                self.assign(scope, place, value, out);
            }
            Statement::If(condition, then, otherwise) => {
                let condition = self.value(scope, condition, out);
                let [then, otherwise] = [then, otherwise].map(|way| self.block(scope, way));
                decide(condition, then, otherwise, out);
            }
            Statement::For(name, first, last, body) => {
                debug_assert!(!returns(body), "no function ends inside of a loop");
                let name = scope.name(name);
                self.declare(&name, Kind::Whole);
                let body = self.block(scope, body);
                out.push(Statement::For(name, *first, *last, body));
            }
            Statement::Call(function, arguments) => {
                self.call(scope, function, arguments, Answer::Nothing, out);
            }
            Statement::Return(_) => {}
        }
    }

    fn zeros(&mut self, scope: &Scope, name: &str, count: usize, out: &mut Vec<Statement>) {
        let (name, index) = (scope.name(name), scope.name("zeroed"));
        self.declare(&name, Kind::Reals(count));
        self.declare(&index, Kind::Whole);
        let zero = Statement::set_element(&name, local(&index), number(0.0));
        out.push(Statement::repeat(&index, i32::try_from(count).unwrap_or(i32::MAX), vec![zero]));
    }

    /// The body of a function with its parameters as values of their own.
    fn call(
        &mut self,
        scope: &Scope,
        name: &str,
        arguments: &[Argument],
        answer: Answer,
        out: &mut Vec<Statement>,
    ) {
        let program = self.program;
        let Some(function) = program.function(name) else {
            unreachable!("a program calls its own functions")
        };
        let mut called = Scope { function: function.name, answer, arrays: Vec::new() };
        for (parameter, argument) in function.parameters.iter().zip(arguments) {
            match argument {
                Argument::Array(array) => called.arrays.push((parameter.name, scope.name(array))),
                Argument::Value(value) => {
                    let name = called.name(parameter.name);
                    self.declare(&name, parameter.kind);
                    self.assign(scope, Place::Local(name), value, out);
                }
            }
        }
        out.extend(self.remarked(function, &called));
    }

    fn remarked(&mut self, function: &Function, scope: &Scope) -> Vec<Statement> {
        let mut body = vec![Statement::Remark(function.doc.to_owned())];
        body.extend(self.block(scope, &function.body));
        body
    }

    fn place(&mut self, scope: &Scope, place: &Place, out: &mut Vec<Statement>) -> Place {
        match place {
            Place::Local(name) => Place::Local(scope.name(name)),
            Place::Member(part, name) => Place::Member(*part, name.clone()),
            Place::Element(name, index) => {
                Place::Element(scope.name(name), Box::new(self.value(scope, index, out)))
            }
            Place::MemberElement(part, name, index) => {
                let index = Box::new(self.value(scope, index, out));
                Place::MemberElement(*part, name.clone(), index)
            }
        }
    }
}

/// One way or the other; a way without statements is left out.
fn decide(
    condition: Expression,
    then: Vec<Statement>,
    otherwise: Vec<Statement>,
    out: &mut Vec<Statement>,
) {
    match (then.is_empty(), otherwise.is_empty()) {
        (true, true) => {}
        (true, false) => out.push(Statement::when(condition.negated(), otherwise)),
        (false, _) => out.push(Statement::If(condition, then, otherwise)),
    }
}

fn returns(body: &[Statement]) -> bool {
    body.iter().any(|statement| match statement {
        Statement::Return(_) => true,
        Statement::If(_, then, otherwise) => returns(then) || returns(otherwise),
        Statement::For(.., body) => returns(body),
        _ => false,
    })
}
