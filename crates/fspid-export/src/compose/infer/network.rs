//! A network in the place of rules; see [`Network`] for its equations.

use fspid_core::fuzzy::{Network, UNITS};
use fspid_numeric::Real;

use super::super::members::Configuration;
use super::{GAINS, range};
use crate::program::{
    Argument, Expression, Function, Kind, Parameter, Part, Statement, Value, local, member_element,
    number, whole,
};

/// What a row is, in the order of [`Network::ROWS`].
const DOCS: [&str; 6] = [
    "Weight of the error in each hidden unit.",
    "Weight of what is seen beside it in each hidden unit.",
    "Offset of each hidden unit.",
    "Weight of each hidden unit in the increment of kp.",
    "Weight of each hidden unit in the increment of ki.",
    "Weight of each hidden unit in the increment of kd.",
];

/// The function $x / (1 + |x|)$.
pub(super) fn softsign() -> Function {
    let x = || local("x");
    Function {
        name: "softsign",
        doc: "From -1 to 1: x over one and its magnitude.",
        parts: &[],
        parameters: vec![Parameter { name: "x", kind: Kind::Real, written: false }],
        answers: Some(Kind::Real),
        body: vec![Statement::Return(Some(x() / (number(1.0) + x().magnitude())))],
    }
}

fn softsign_of(x: Expression) -> Expression {
    Expression::Call("softsign", vec![Argument::Value(x)])
}

/// What `infer` does with its inputs, which lie within the range.
pub(super) fn body<R: Real>(
    configuration: &mut Configuration,
    network: &Network<R>,
) -> Vec<Statement> {
    for ((name, doc), row) in Network::<R>::ROWS.into_iter().zip(DOCS).zip(network.rows()) {
        let row = row.iter().map(|weight| weight.to_f64()).collect();
        configuration.add(&row_name(name), doc, Value::Reals(row));
    }
    let sum = |gain: &str| format!("sum_{gain}");
    let mut body = vec![
        Statement::real("error_part", local("seen_error") / range()),
        Statement::real("change_part", local("seen_change") / range()),
    ];
    body.extend(GAINS.map(|gain| Statement::real(&sum(gain), number(0.0))));
    body.push(Statement::repeat("unit", UNITS as i32, unit(sum)));
    for (gain, place) in GAINS.into_iter().zip(0..) {
        body.push(Statement::real(&format!("answer_{gain}"), softsign_of(local(&sum(gain)))));
        let increment = range() * local(&format!("answer_{gain}"));
        body.push(Statement::set_element("increments", whole(place), increment));
    }
    body.push(Statement::Return(Some(Expression::Byte(0))));
    body
}

/// A hidden unit, and what it adds to the sums.
fn unit(sum: impl Fn(&str) -> String) -> Vec<Statement> {
    let weight = |row: &str| member_element(Part::Configuration, &row_name(row), local("unit"));
    let seen = weight("error") * local("error_part") + weight("change") * local("change_part");
    let bracket = |side: &str| local(side) - local("at_rest");
    let mut body = vec![
        Statement::real("seen", seen),
        Statement::real("at_rest", softsign_of(weight("offset"))),
        Statement::real("ahead", softsign_of(weight("offset") + local("seen"))),
        Statement::real("behind", softsign_of(weight("offset") - local("seen"))),
        Statement::real("hidden", bracket("ahead") + bracket("behind")),
    ];
    for gain in GAINS {
        let added = weight(&format!("delta_{gain}")) * local("hidden");
        body.push(Statement::set(&sum(gain), local(&sum(gain)) + added));
    }
    body
}

fn row_name(row: &str) -> String {
    format!("network_{row}")
}
