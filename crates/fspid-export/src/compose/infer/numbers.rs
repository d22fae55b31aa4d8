//! Rules that conclude numbers, over triangular sets: bilinear interpolation between set centres.

use fspid_core::fuzzy::{NumberTable, Output, Supervisor};
use fspid_numeric::Real;

use super::super::members::Configuration;
use super::{GAINS, limited};
use crate::program::{
    Argument, Expression, Function, Kind, Operator, Parameter, Part, Statement, Value, element,
    local, member_element, number, whole,
};

/// The function that finds the two sets between whose centres an input lies.
pub(super) fn neighbour() -> Function {
    let step = |set: i32| {
        let centre = number(f64::from(set) - 3.0);
        Statement::when(
            centre.clone().at_most(local("input")),
            vec![Statement::set("lower", whole(set)), Statement::set("centre", centre)],
        )
    };
    let centre = || local("centre");
    let mut body = vec![
        Statement::Let("lower".to_owned(), Kind::Whole, whole(0)),
        Statement::real("centre", number(-3.0)),
    ];
    body.extend((1..=5).map(step));
    body.extend([
        Statement::set_element("grades", whole(0), number(1.0) - (local("input") - centre())),
        Statement::set_element(
            "grades",
            whole(1),
            number(1.0) - ((centre() + number(1.0)) - local("input")),
        ),
        Statement::Return(Some(local("lower"))),
    ]);
    Function {
        name: "lower_set",
        doc: "The lower of the two sets between whose centres an input lies, 0 to 5, and its grades in both.",
        parts: &[],
        parameters: vec![
            Parameter { name: "input", kind: Kind::Real, written: false },
            Parameter { name: "grades", kind: Kind::Reals(2), written: true },
        ],
        answers: Some(Kind::Whole),
        body,
    }
}

/// What `infer` does with its inputs, which lie within the range.
pub(super) fn body<R: Real>(
    configuration: &mut Configuration,
    supervisor: &Supervisor<R>,
    numbers: &NumberTable<R>,
) -> Vec<Statement> {
    let [.., spacing, _, _] = supervisor.sets().map(|[centre, _]| centre.to_f64());
    let spacing = configuration.real("spacing", "Distance between two set centres.", spacing);
    for (gain, output) in GAINS.into_iter().zip(Output::ALL) {
        let numbers = numbers.grid(output).iter().flatten().map(|number| number.to_f64()).collect();
        let doc = format!(
            "Numbers that the rules conclude for {gain}: R1 to R49, error by error from NB to PB, in each the changes \
             from NB to PB."
        );
        configuration.add(&format!("rules_{gain}"), &doc, Value::Reals(numbers));
    }
    let mut body = Vec::new();
    for (input, grades, lower) in
        [("seen_error", "row_grades", "row"), ("seen_change", "column_grades", "column")]
    {
        let (spaced, within) = (format!("{lower}_spaced"), format!("{lower}_input"));
        let arguments = vec![Argument::Value(local(&within)), Argument::Array(grades.to_owned())];
        body.extend([
            Statement::real(&spaced, local(input) / spacing.clone()),
            Statement::real(&within, limited(local(&spaced), number(-3.0), number(3.0))),
            Statement::Array(grades.to_owned(), 2),
            Statement::Let(lower.to_owned(), Kind::Whole, Expression::Call("lower_set", arguments)),
        ]);
    }
    let first = Expression::binary(Operator::Multiply, local("row"), whole(7));
    let first = Expression::binary(Operator::Add, first, local("column"));
    body.push(Statement::Let("rule".to_owned(), Kind::Whole, first));
    for (gain, place) in GAINS.into_iter().zip(0..) {
        let at = |steps| {
            let further = || Expression::binary(Operator::Add, local("rule"), whole(steps));
            let rule = if steps == 0 { local("rule") } else { further() };
            member_element(Part::Configuration, &format!("rules_{gain}"), rule)
        };
        let column = |set| element("column_grades", whole(set));
        let along = |row: i32| column(0) * at(7 * row) + column(1) * at(7 * row + 1);
        let row = |set| element("row_grades", whole(set));
        let increment = row(0) * along(0) + row(1) * along(1);
        body.push(Statement::set_element("increments", whole(place), increment));
    }
    body.push(Statement::Return(Some(Expression::Byte(0))));
    body
}
