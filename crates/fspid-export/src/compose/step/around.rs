//! What a controller does beside a step: it begins anew, and holds.

use fspid_core::{Controller, Gains};
use fspid_numeric::Real;

use super::super::Angles;
use super::super::infer::GAINS;
use super::super::members::Configuration;
use super::{answered, state};
use crate::program::{
    Expression, Function, Kind, Member, Operator, Parameter, Part, Statement, Value, local, member,
    number,
};

/// The function that forgets everything.
pub(super) fn reset<R: Real>(
    configuration: &mut Configuration,
    controller: &Controller<R>,
) -> Function {
    let begin = |member: Member| {
        let value = match (GAINS.iter().position(|gain| *gain == member.name), member.value) {
            (Some(gain), _) => nominal_gain(configuration, controller, gain),
            (None, Value::Truth(value)) => Expression::Truth(value),
            (None, Value::Byte(value)) => Expression::Byte(value),
            (None, Value::Real(value)) => number(value),
            (None, Value::Reals(_) | Value::Bytes(_)) => unreachable!("no list is remembered"),
        };
        Statement::set_member(Part::State, &member.name, value)
    };
    Function {
        name: "reset",
        doc: "Forgets everything: as before the first sample.",
        parts: &[Part::Configuration, Part::State],
        parameters: Vec::new(),
        answers: None,
        body: state(controller).into_iter().map(begin).collect(),
    }
}

/// The function that answers a sample which cannot be used.
pub(super) fn hold<R: Real>(
    configuration: &mut Configuration,
    controller: &Controller<R>,
    angles: Angles,
) -> Function {
    let state = |name: &str| member(Part::State, name);
    let faults = Expression::binary(Operator::BitOr, state("faults"), local("fault"));
    let mut command = state("command_rad");
    if let Some(limits) = controller.config().limits {
        // Only a memory that the step has not written can lie outside.
        let last = || state("command_rad");
        let end = |configuration: &mut Configuration, name, doc, value: R| {
            let value = value.to_f64();
            value.is_finite().then(|| configuration.real(name, doc, value))
        };
        let upper =
            end(configuration, "upper_rad", "Upper limit of the command, rad.", limits.upper());
        let lower =
            end(configuration, "lower_rad", "Lower limit of the command, rad.", limits.lower());
        if let Some(upper) = upper {
            command = upper.clone().less(last()).select(upper, command);
        }
        if let Some(lower) = lower {
            command = last().less(lower.clone()).select(lower, command);
        }
    }
    let mut body = vec![
        Statement::set_member(Part::State, "faults", faults),
        Statement::real("held_rad", command),
    ];
    body.extend(answered(angles, "held_rad", |gain| {
        gain_of_state(configuration, controller, gain)
    }));
    body.extend([
        Statement::set_member(Part::Answer, "saturated", Expression::Truth(false)),
        Statement::set_member(Part::Answer, "faults", state("faults")),
    ]);
    Function {
        name: "hold",
        doc: "Answers the last command to a sample that cannot be used, and latches the fault.",
        parts: &[Part::Configuration, Part::State, Part::Answer],
        parameters: vec![Parameter { name: "fault", kind: Kind::Byte, written: false }],
        answers: None,
        body,
    }
}

/// The last gain: constant where the gains are.
fn gain_of_state<R: Real>(
    configuration: &mut Configuration,
    controller: &Controller<R>,
    gain: usize,
) -> Expression {
    match controller {
        Controller::Fixed(_) => nominal_gain(configuration, controller, gain),
        Controller::SelfTuning(_) => member(Part::State, GAINS[gain]),
    }
}

pub(super) fn nominal_gain<R: Real>(
    configuration: &mut Configuration,
    controller: &Controller<R>,
    gain: usize,
) -> Expression {
    let Gains { kp, ki, kd } = controller.nominal();
    let value = [kp, ki, kd][gain].to_f64();
    let doc = ["Proportional gain.", "Integral gain, 1/s.", "Derivative gain, s."][gain];
    configuration.real(&format!("nominal_{}", GAINS[gain]), doc, value)
}
