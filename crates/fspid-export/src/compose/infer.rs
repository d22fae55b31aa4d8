//! The supervisor: from what it sees to the increments of the gains.

pub(crate) mod centroid;
mod labels;
mod network;
mod numbers;

use fspid_core::SelfTuner;
use fspid_core::fuzzy::{OutOfRange, Supervisor};
use fspid_numeric::Real;

use super::members::Configuration;
use super::{Refusal, exponential};
use crate::program::{
    Expression, Function, Kind, Parameter, Part, Statement, local, member, number,
};

/// Name of the gains, in the order of the increments.
pub(crate) const GAINS: [&str; 3] = ["kp", "ki", "kd"];
/// Sets of an input.
const SETS: i32 = 7;

/// The bits of a fault, as the core has them.
pub(super) const OUT_OF_RANGE: u8 = fspid_core::Faults::OUT_OF_RANGE.bits();
pub(super) const UNDERFLOW: u8 = fspid_core::Faults::UNDERFLOW.bits();

/// The function `infer` and those that it calls.
pub(super) fn functions<R: Real>(
    configuration: &mut Configuration,
    tuner: &SelfTuner<R>,
) -> Result<Vec<Function>, Refusal> {
    let supervisor = tuner.supervisor();
    let range = supervisor.range().to_f64();
    configuration.real("range", "Half range of the inputs, in their units.", range);
    let mut functions = Vec::new();
    let policy = supervisor.out_of_range();
    let mut body = match policy {
        OutOfRange::Error => vec![Statement::when(
            is_outside(),
            vec![Statement::Return(Some(Expression::Byte(OUT_OF_RANGE)))],
        )],
        OutOfRange::Evaluate if supervisor.has_labels() => Vec::new(),
        // The ends of the range are at three spacings, where the numbers limit once more.
        OutOfRange::Clamp | OutOfRange::Evaluate if ends_at_three_spacings(supervisor) => {
            Vec::new()
        }
        OutOfRange::Clamp | OutOfRange::Evaluate => vec![Statement::when(is_outside(), clamped())],
    };
    match (supervisor.numbers(), supervisor.network()) {
        (_, Some(network)) => {
            functions.push(network::softsign());
            body.extend(network::body(configuration, network));
        }
        (Some(numbers), None) => {
            functions.push(numbers::neighbour());
            body.extend(numbers::body(configuration, supervisor, numbers));
        }
        (None, None) => {
            functions.push(exponential::function::<R>());
            functions.push(labels::grades(configuration, supervisor));
            functions.push(centroid::function::<R>(supervisor.defuzzifier(), policy)?);
            body.extend(labels::body(configuration, supervisor));
        }
    }
    functions.push(Function {
        name: "infer",
        doc: "Increments of the three gains, in the units of the supervisor; answers a fault, 0 for none.",
        parts: &[Part::Configuration],
        parameters: vec![
            Parameter { name: "error", kind: Kind::Real, written: false },
            Parameter { name: "change", kind: Kind::Real, written: false },
            increments(),
        ],
        answers: Some(Kind::Byte),
        body: copied(body),
    });
    Ok(functions)
}

/// True of numbers whose outermost centres are the ends of the range also when divided by the spacing.
fn ends_at_three_spacings<R: Real>(supervisor: &Supervisor<R>) -> bool {
    let [.., [spacing, _], _, _] = &supervisor.sets();
    supervisor.numbers().is_some() && (supervisor.range() / *spacing).to_f64() >= 3.0
}

/// Parameters cannot be written to in every language, so that copies are.
fn copied(body: Vec<Statement>) -> Vec<Statement> {
    let copies = [("seen_error", "error"), ("seen_change", "change")];
    let copies = copies.map(|(copy, of)| Statement::real(copy, local(of)));
    copies.into_iter().chain(body).collect()
}

fn increments() -> Parameter {
    Parameter { name: "increments", kind: Kind::Reals(3), written: true }
}

/// True where an input lies outside of the range.
fn is_outside() -> Expression {
    let within = |input: &str| local(input).magnitude().at_most(range());
    within("seen_error").and(within("seen_change")).negated()
}

fn range() -> Expression {
    member(Part::Configuration, "range")
}

/// Both inputs moved into the range.
fn clamped() -> Vec<Statement> {
    ["seen_error", "seen_change"]
        .map(|input| Statement::set(input, limited(local(input), -range(), range())))
        .into()
}

/// The number moved between two others; NaN stays NaN.
fn limited(value: Expression, lower: Expression, upper: Expression) -> Expression {
    let above = upper.clone().less(value.clone()).select(upper, value.clone());
    value.less(lower.clone()).select(lower, above)
}

/// The function that moves an input so that the even sets see it, for [`fspid_core::SetCentres`].
///
/// Beyond the range it answers no less than the range where inputs are moved there behind it, else what it is given.
pub(super) fn warp_function<R: Real>(policy: OutOfRange) -> Function {
    let beyond = Statement::when(
        local("part").less(number(1.0)).negated(),
        vec![Statement::Return(Some(local("seen")))],
    );
    let is_moved = policy == OutOfRange::Clamp;
    let whole = || local("warped");
    let most = if is_moved { whole() } else { whole().smaller(number(1.0)) };
    let third = number((R::ONE / R::from_f64(3.0)).to_f64());
    let two_thirds = R::ONE / R::from_f64(3.0) + R::ONE / R::from_f64(3.0);
    let (part, small, medium) = (|| local("part"), || local("small"), || local("medium"));
    let warped = || local("warped");
    let between = third.clone() + third.clone() * ((part() - small()) / (medium() - small()));
    let outer = number(two_thirds.to_f64())
        + third.clone() * ((part() - medium()) / (number(1.0) - medium()));
    let real = |name| Parameter { name, kind: Kind::Real, written: false };
    Function {
        name: "warp",
        doc: "An input as even sets see it: linear from 0 over the two centres to the range.",
        parts: &[Part::Configuration],
        parameters: vec![real("seen"), real("small"), real("medium")],
        answers: Some(Kind::Real),
        body: [
            Statement::real("part", local("seen").magnitude() / range()),
            Statement::real("warped", number(0.0)),
        ]
        .into_iter()
        .chain((!is_moved).then_some(beyond))
        .chain([
            Statement::If(
                part().at_most(small()),
                vec![Statement::set("warped", third * (part() / small()))],
                vec![Statement::If(
                    part().at_most(medium()),
                    vec![Statement::set("warped", between)],
                    vec![Statement::set("warped", outer)],
                )],
            ),
            Statement::set("warped", most * range()),
            Statement::Return(Some(local("seen").less(number(0.0)).select(-warped(), warped()))),
        ])
        .collect(),
    }
}
