//! Every single change of a program that the vectors are asked to find.

use crate::program::{Expression, Operator, Program, Statement, Value};

/// One change.
#[derive(Clone, Debug)]
pub(super) struct Mutant {
    /// What of the design or the code is changed.
    pub(super) element: String,
    /// Into what.
    pub(super) change: String,
    /// Part of the configuration and not of the code.
    pub(super) is_design: bool,
    place: Place,
}

#[derive(Clone, Debug)]
enum Place {
    /// A value of a member of the configuration.
    Real(usize, usize, f64),
    Label(usize, usize, u8),
    /// An expression by its number in the order of the walk.
    Expression(usize, Expression),
    /// A statement by its number, which is left out.
    Statement(usize),
    /// A loop by its number, which ends one earlier.
    Loop(usize),
}

impl Mutant {
    /// The program with the change.
    pub(super) fn of(&self, program: &Program) -> Program {
        let mut program = program.clone();
        match &self.place {
            Place::Real(member, index, value) => match &mut program.configuration[*member].value {
                Value::Real(held) => *held = *value,
                Value::Reals(held) => held[*index] = *value,
                Value::Bytes(_) | Value::Byte(_) | Value::Truth(_) => {}
            },
            Place::Label(member, index, label) => {
                if let Value::Bytes(held) = &mut program.configuration[*member].value {
                    held[*index] = *label;
                }
            }
            Place::Expression(wanted, other) => {
                let mut walk = Walk::default();
                walk.program(&mut program, &mut |number, it| {
                    if let (true, At::Expression(it)) = (number == *wanted, it) {
                        *it = other.clone();
                    }
                });
            }
            Place::Statement(wanted) => {
                let mut walk = Walk::default();
                walk.program(&mut program, &mut |number, it| {
                    if let (true, At::Statement(it)) = (number == *wanted, it) {
                        *it = Statement::Remark("Left out.".to_owned());
                    }
                });
            }
            Place::Loop(wanted) => {
                let mut walk = Walk::default();
                walk.program(&mut program, &mut |number, it| {
                    if let (true, At::Statement(Statement::For(_, _, last, _))) =
                        (number == *wanted, it)
                    {
                        *last -= 1;
                    }
                });
            }
        }
        program
    }
}

/// All changes, those of the configuration first.
pub(super) fn all(program: &Program) -> Vec<Mutant> {
    let mut mutants = configured(program);
    let mut walk = Walk::default();
    let mut copy = program.clone();
    let mut found = Vec::new();
    walk.program(&mut copy, &mut |number, it| match it {
        At::Expression(it) => {
            for (change, other) in changes(it) {
                found.push((number, change, Place::Expression(number, other)));
            }
        }
        At::Statement(Statement::Set(..) | Statement::Call(..) | Statement::Return(None)) => {
            found.push((number, "left out", Place::Statement(number)));
        }
        At::Statement(Statement::For(..)) => {
            found.push((number, "ends one earlier", Place::Loop(number)));
        }
        At::Statement(_) => {}
    });
    for (number, change, place) in found {
        let function = walk.functions.get(number).copied().unwrap_or_default();
        mutants.push(Mutant {
            element: function.to_owned(),
            change: change.to_owned(),
            is_design: false,
            place,
        });
    }
    mutants
}

fn configured(program: &Program) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    let mut add = |element: String, change: String, place| {
        mutants.push(Mutant { element, change, is_design: true, place });
    };
    for (member, index) in program.configuration.iter().zip(0..) {
        let named = |place: usize| match (member.is_rules(), member.name.split_once('_')) {
            (true, Some((_, gain))) => format!("R{} of {gain}", place + 1),
            _ => format!("{}[{place}]", member.name),
        };
        match &member.value {
            Value::Real(value) => {
                for (change, other) in others(*value) {
                    add(member.name.clone(), change.to_owned(), Place::Real(index, 0, other));
                }
            }
            Value::Reals(values) => {
                for (value, place) in values.iter().zip(0..) {
                    for (change, other) in others(*value) {
                        add(named(place), change.to_owned(), Place::Real(index, place, other));
                    }
                }
            }
            Value::Bytes(labels) => {
                for (label, place) in labels.iter().zip(0..) {
                    for other in (0..7).filter(|other| other != label) {
                        let change = format!("label {other} for {label}");
                        add(named(place), change, Place::Label(index, place, other));
                    }
                }
            }
            Value::Byte(_) | Value::Truth(_) => {}
        }
    }
    mutants
}

/// Other numbers in place of one.
fn others(value: f64) -> Vec<(&'static str, f64)> {
    if value == 0.0 {
        return vec![("0.001 for 0", 0.001), ("-0.001 for 0", -0.001)];
    }
    vec![
        ("a thousandth more", value * 1.001),
        ("a thousandth less", value * 0.999),
        ("the other sign", -value),
    ]
}

/// Other expressions in place of one.
fn changes(value: &Expression) -> Vec<(&'static str, Expression)> {
    match value {
        Expression::Number(value) if value.abs() > 1e30 => vec![
            ("a thousandth less", Expression::Number(value * 0.999)),
            ("the other sign", Expression::Number(-value)),
        ],
        Expression::Number(value) => others(*value)
            .into_iter()
            .map(|(change, other)| (change, Expression::Number(other)))
            .collect(),
        Expression::Byte(value) => vec![("another byte", Expression::Byte(value ^ 32))],
        Expression::Truth(value) => vec![("the other truth", Expression::Truth(!value))],
        Expression::Negative(inner) => vec![("not turned", (**inner).clone())],
        Expression::Magnitude(inner) => vec![("no magnitude", (**inner).clone())],
        Expression::Not(inner) => vec![("not negated", (**inner).clone())],
        Expression::Select(_, then, otherwise) => vec![
            ("always the first", (**then).clone()),
            ("always the second", (**otherwise).clone()),
        ],
        Expression::Binary(operator, left, right) => joined(*operator, left, right),
        Expression::Whole(_)
        | Expression::Read(_)
        | Expression::ToReal(_)
        | Expression::PowerOfTwo(_)
        | Expression::Call(..) => Vec::new(),
    }
}

fn joined(
    operator: Operator,
    left: &Expression,
    right: &Expression,
) -> Vec<(&'static str, Expression)> {
    let other =
        |change, operator| (change, Expression::binary(operator, left.clone(), right.clone()));
    let negated = |operator| {
        let same = Expression::binary(operator, left.clone(), right.clone());
        ("negated", same.negated())
    };
    // What counts places of an array would leave it.
    let counts = |it: &Expression| is_counting(it);
    match operator {
        _ if counts(left) || counts(right) => Vec::new(),
        Operator::Add => vec![other("- for +", Operator::Subtract)],
        Operator::Subtract => vec![other("+ for -", Operator::Add)],
        Operator::Multiply => vec![other("/ for *", Operator::Divide)],
        Operator::Divide => vec![other("* for /", Operator::Multiply)],
        Operator::Less => vec![other("<= for <", Operator::LessOrEqual), negated(operator)],
        Operator::LessOrEqual => vec![other("< for <=", Operator::Less), negated(operator)],
        Operator::Equal | Operator::NotEqual => vec![negated(operator)],
        Operator::And => vec![other("or for and", Operator::Or)],
        Operator::Or => vec![other("and for or", Operator::And)],
        Operator::BitOr => {
            vec![("the first alone", left.clone()), ("the second alone", right.clone())]
        }
    }
}

fn is_counting(value: &Expression) -> bool {
    match value {
        Expression::Whole(_) => true,
        Expression::Binary(_, left, right) => is_counting(left) || is_counting(right),
        _ => false,
    }
}

/// What a walk comes by.
enum At<'a> {
    Expression(&'a mut Expression),
    Statement(&'a mut Statement),
}

/// Goes through all statements and expressions in the same order each time.
#[derive(Default)]
struct Walk {
    /// In which function each number is.
    functions: Vec<&'static str>,
}

type Visit<'a> = dyn FnMut(usize, At<'_>) + 'a;

impl Walk {
    fn program(&mut self, program: &mut Program, visit: &mut Visit<'_>) {
        for function in &mut program.functions {
            self.block(&mut function.body, function.name, visit);
        }
    }

    fn next(&mut self, function: &'static str) -> usize {
        self.functions.push(function);
        self.functions.len() - 1
    }

    fn block(&mut self, body: &mut [Statement], function: &'static str, visit: &mut Visit<'_>) {
        for statement in body {
            let number = self.next(function);
            match statement {
                Statement::Let(_, _, value)
                | Statement::Set(_, value)
                | Statement::Return(Some(value)) => self.expression(value, function, visit),
                Statement::If(condition, then, otherwise) => {
                    self.expression(condition, function, visit);
                    self.block(then, function, visit);
                    self.block(otherwise, function, visit);
                }
                Statement::For(.., body) => self.block(body, function, visit),
                Statement::Call(_, arguments) => self.arguments(arguments, function, visit),
                Statement::Remark(_) | Statement::Array(..) | Statement::Return(None) => {}
            }
            visit(number, At::Statement(statement));
        }
    }

    fn arguments(
        &mut self,
        arguments: &mut [crate::program::Argument],
        function: &'static str,
        visit: &mut Visit<'_>,
    ) {
        for argument in arguments {
            if let crate::program::Argument::Value(value) = argument {
                self.expression(value, function, visit);
            }
        }
    }

    fn expression(
        &mut self,
        value: &mut Expression,
        function: &'static str,
        visit: &mut Visit<'_>,
    ) {
        let number = self.next(function);
        match value {
            Expression::Negative(inner)
            | Expression::Magnitude(inner)
            | Expression::Not(inner)
            | Expression::ToReal(inner)
            | Expression::PowerOfTwo(inner) => self.expression(inner, function, visit),
            Expression::Binary(_, left, right) => {
                self.expression(left, function, visit);
                self.expression(right, function, visit);
            }
            Expression::Select(condition, then, otherwise) => {
                for inner in [condition, then, otherwise] {
                    self.expression(inner, function, visit);
                }
            }
            Expression::Call(_, arguments) => self.arguments(arguments, function, visit),
            Expression::Number(_)
            | Expression::Whole(_)
            | Expression::Byte(_)
            | Expression::Truth(_)
            | Expression::Read(_) => {}
        }
        visit(number, At::Expression(value));
    }
}
