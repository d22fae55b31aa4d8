//! Leaves out what nobody reads.

use std::collections::BTreeSet;

use crate::program::{Argument, Expression, Kind, Part, Place, Program, Statement};

/// Removes values and members of configuration and state that are not read, with what is written into them.
pub(crate) fn prune(program: &mut Program) {
    while remove_unread(program) {}
}

/// How many statements there are, those within others included.
pub(crate) fn statements(body: &[Statement]) -> usize {
    let inside = |statement: &Statement| match statement {
        Statement::If(_, then, otherwise) => statements(then) + statements(otherwise),
        Statement::For(.., body) => statements(body),
        _ => 0,
    };
    body.len() + body.iter().map(inside).sum::<usize>()
}

fn size(program: &Program) -> usize {
    let functions: usize =
        program.functions.iter().map(|function| statements(&function.body)).sum();
    functions + program.configuration.len() + program.state.len()
}

/// Removes functions that `entries` do not call, directly or through others.
pub(crate) fn remove_uncalled(program: &mut Program, entries: &[&'static str]) {
    let mut called: BTreeSet<&str> = entries.iter().copied().collect();
    // One is called only below where it stands.
    for function in program.functions.iter().rev().filter(|it| !it.body.is_empty()) {
        if called.contains(function.name) {
            let text = format!("{:?}", function.body);
            let names = program.functions.iter().map(|it| it.name);
            called.extend(names.filter(|name| text.contains(&format!("Call(\"{name}\""))));
        }
    }
    program.functions.retain(|function| called.contains(function.name));
}

/// Removes arrays that are filled and never read, and reals that are never read; for programs in which a function that
/// answers a real does nothing else.
pub(crate) fn remove_unread_arrays(body: &mut Vec<Statement>) {
    let mut before = usize::MAX;
    while statements(body) < before {
        before = statements(body);
        let mut reads = Reads::new();
        body.iter().for_each(|statement| read_in(statement, &mut reads));
        keep(body, &|statement| match statement {
            Statement::Array(name, _) | Statement::Set(Place::Element(name, _), _) => {
                reads.contains(&(LOCAL, name.clone()))
            }
            Statement::Let(name, Kind::Real, _) => reads.contains(&(LOCAL, name.clone())),
            _ => true,
        });
    }
}

/// True if something was removed, after which more may be unread.
fn remove_unread(program: &mut Program) -> bool {
    let before = size(program);
    for function in &mut program.functions {
        let mut reads = Reads::new();
        function.body.iter().for_each(|statement| read_in(statement, &mut reads));
        let arrays: Vec<&str> =
            function.parameters.iter().map(|parameter| parameter.name).collect();
        let is_read =
            |name: &str| reads.contains(&(LOCAL, name.to_owned())) || arrays.contains(&name);
        keep(&mut function.body, &|statement| match statement {
            // A call may do more than answer.
            Statement::Let(name, _, value) => {
                is_read(name) || matches!(value, Expression::Call(..))
            }
            Statement::Set(Place::Local(name), _) => is_read(name),
            _ => true,
        });
    }
    remove_unread_members(program);
    size(program) < before
}

fn remove_unread_members(program: &mut Program) {
    let mut reads = BTreeSet::new();
    for function in &program.functions {
        function.body.iter().for_each(|statement| read_in(statement, &mut reads));
    }
    let is_read = |part: Part, name: &str| reads.contains(&(part as u8, name.to_owned()));
    program.configuration.retain(|member| is_read(Part::Configuration, &member.name));
    program.state.retain(|member| is_read(Part::State, &member.name));
    for function in &mut program.functions {
        keep(&mut function.body, &|statement| match statement {
            Statement::Set(Place::Member(Part::State, name), _) => is_read(Part::State, name),
            _ => true,
        });
    }
}

fn keep(body: &mut Vec<Statement>, is_kept: &impl Fn(&Statement) -> bool) {
    body.retain_mut(|statement| {
        match statement {
            Statement::If(_, then, otherwise) => {
                keep(then, is_kept);
                keep(otherwise, is_kept);
            }
            Statement::For(.., body) => keep(body, is_kept),
            _ => {}
        }
        is_kept(statement)
    });
}

/// Values of the function among the parts.
const LOCAL: u8 = u8::MAX;

type Reads = BTreeSet<(u8, String)>;

fn read_in(statement: &Statement, reads: &mut Reads) {
    match statement {
        Statement::Remark(_) | Statement::Array(..) | Statement::Return(None) => {}
        Statement::Let(_, _, value) | Statement::Return(Some(value)) => value_in(value, reads),
        Statement::Set(place, value) => {
            if let Place::Element(_, index) | Place::MemberElement(_, _, index) = place {
                value_in(index, reads);
            }
            value_in(value, reads);
        }
        Statement::If(condition, then, otherwise) => {
            value_in(condition, reads);
            then.iter().chain(otherwise).for_each(|statement| read_in(statement, reads));
        }
        Statement::For(.., body) => body.iter().for_each(|statement| read_in(statement, reads)),
        Statement::Call(_, arguments) => arguments_in(arguments, reads),
    }
}

fn arguments_in(arguments: &[Argument], reads: &mut Reads) {
    for argument in arguments {
        match argument {
            Argument::Value(value) => value_in(value, reads),
            Argument::Array(name) => {
                reads.insert((LOCAL, name.clone()));
            }
        }
    }
}

fn value_in(value: &Expression, reads: &mut Reads) {
    match value {
        Expression::Number(_)
        | Expression::Whole(_)
        | Expression::Byte(_)
        | Expression::Truth(_) => {}
        Expression::Read(Place::Local(name)) => {
            reads.insert((LOCAL, name.clone()));
        }
        Expression::Read(Place::Member(part, name)) => {
            reads.insert((*part as u8, name.clone()));
        }
        Expression::Read(Place::MemberElement(part, name, index)) => {
            reads.insert((*part as u8, name.clone()));
            value_in(index, reads);
        }
        Expression::Read(Place::Element(name, index)) => {
            reads.insert((LOCAL, name.clone()));
            value_in(index, reads);
        }
        Expression::Negative(value)
        | Expression::Magnitude(value)
        | Expression::Not(value)
        | Expression::ToReal(value)
        | Expression::PowerOfTwo(value) => value_in(value, reads),
        Expression::Binary(_, left, right) => {
            value_in(left, reads);
            value_in(right, reads);
        }
        Expression::Select(condition, then, otherwise) => {
            [condition, then, otherwise].into_iter().for_each(|value| value_in(value, reads));
        }
        Expression::Call(_, arguments) => arguments_in(arguments, reads),
    }
}
