//! Taking part in what another commands, and what is asked of state and answer.

use fspid_core::equations::Memory;
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Controller, largest_remembered};
use fspid_numeric::Real;

use super::super::infer;
use super::{Composer, IMPLAUSIBLE, NOT_FINITE, PARTS, cut, held, is_limited, read};
use crate::program::{
    Expression, Function, Kind, Operator, Parameter, Part, Statement, local, member, number,
};
use crate::trace::Traced;

/// True if the answer was cut.
pub(super) fn saturated() -> Function {
    Function {
        name: "saturated",
        doc: "True if a limit cut the command of an answer.",
        parts: &[Part::Answer],
        parameters: Vec::new(),
        answers: Some(Kind::Truth),
        body: vec![Statement::Return(Some(member(Part::Answer, "saturated")))],
    }
}

/// Faults, read and cleared.
pub(super) fn faults() -> Function {
    Function {
        name: "faults",
        doc: "The faults latched since the last call, which clears them.",
        parts: &[Part::State],
        parameters: Vec::new(),
        answers: Some(Kind::Byte),
        body: vec![
            latched(),
            Statement::set_member(Part::State, "faults", Expression::Byte(0)),
            Statement::Return(Some(local("latched"))),
        ],
    }
}

fn latched() -> Statement {
    Statement::Let("latched".to_owned(), Kind::Byte, member(Part::State, "faults"))
}

const DOC: &str = "Takes part in a sample that another has commanded, in place of a step, so that taking over bumps \
    nothing: the next step at an unchanged sample differs from that command by one sample of the integral, the \
    derivative that fades and what the gains move, and by at most the slew limit. All of the difference may come back \
    where the integral gain is zero or its term is limited. A command that cannot be believed is held.";

impl<R: Real> Composer<'_, R> {
    /// As `track` of `fspid-core`.
    pub(super) fn track(mut self) -> Function {
        let given = match self.angles {
            super::Angles::Radians => "command_rad",
            super::Angles::Degrees => "command_deg",
        };
        let mut body = vec![Statement::real("given_rad", self.in_radians(local(given)))];
        let within = |most| local("given_rad").magnitude().at_most(most);
        body.push(Statement::when(within(self.largest()).negated(), held(NOT_FINITE)));
        body.push(Statement::when(within(self.guard()).negated(), held(IMPLAUSIBLE)));
        // The step would hold it alike; asked here, it is known below.
        body.extend(self.believed());
        let joined = Expression::binary(Operator::BitOr, local("latched"), local("fault"));
        body.extend([
            latched(),
            Statement::set_member(Part::State, "faults", Expression::Byte(0)),
            Statement::Call("step", Vec::new()),
            Statement::Let("fault".to_owned(), Kind::Byte, member(Part::State, "faults")),
            Statement::set_member(Part::State, "faults", joined),
            Statement::set_member(Part::Answer, "faults", member(Part::State, "faults")),
        ]);
        let tracked = self.tracked();
        body.push(Statement::when(self.went_on(), tracked));
        Function {
            name: "track",
            doc: DOC,
            parts: PARTS,
            parameters: vec![Parameter { name: given, kind: Kind::Real, written: false }],
            answers: None,
            body,
        }
    }

    /// True unless the step has held: of all faults only those of the supervisor do not.
    fn went_on(&self) -> Expression {
        let is =
            |fault| Expression::binary(Operator::Equal, local("fault"), Expression::Byte(fault));
        let Controller::SelfTuning(fspid) = self.controller else { return is(0) };
        match fspid.tuner().supervisor().out_of_range() {
            OutOfRange::Clamp => is(0),
            OutOfRange::Error => is(0).or(is(infer::OUT_OF_RANGE)),
            OutOfRange::Evaluate => is(0).or(is(infer::UNDERFLOW)),
        }
    }

    /// The command within its limits, and the integral that goes with it.
    fn tracked(&mut self) -> Vec<Statement> {
        let mut body = Vec::new();
        let (pid, _) = self.equations();
        let state = |name: &str| Traced::read(member(Part::State, name));
        let (nominal, zero) = (self.nominal(), Traced::read(number(0.0)));
        let gains = match self.controller {
            Controller::Fixed(_) => [nominal.kp, nominal.ki, nominal.kd],
            Controller::SelfTuning(_) => infer::GAINS.map(state),
        };
        let memory = Memory {
            command_rad: zero,
            integral: state("integral"),
            derivative_rad_s: state("derivative_rad_s"),
            error_rad: zero,
            derivative_input_rad: zero,
            kp: gains[0],
            ki: gains[1],
            kd: gains[2],
            model_rad: zero,
            model_rad_s: zero,
        };
        let tracked = pid.within_limits(read("given_rad"));
        body.extend(self.listing.values(&[("tracked_rad", tracked)]));
        let integral = pid.tracking(&memory, &self.traced_sample(), read("tracked_rad"));
        body.extend(self.listing.values(&[("integral", integral)]));
        let [_, most] = largest_remembered::<R>().map(|most| number(most.to_f64()));
        let command = format!("command_{}", self.angles.unit());
        let shown = match self.angles.per_radian() {
            Some(factor) => local("tracked_rad") * number(factor),
            None => local("tracked_rad"),
        };
        body.extend([
            Statement::when(
                local("integral").magnitude().at_most(most),
                vec![Statement::set_member(Part::State, "integral", local("integral"))],
            ),
            Statement::set_member(Part::State, "command_rad", local("tracked_rad")),
            Statement::set_member(Part::Answer, &command, shown),
        ]);
        if is_limited(self.controller) {
            body.extend(cut(self.controller, &local("tracked_rad"), &local("given_rad")));
        }
        body
    }
}
