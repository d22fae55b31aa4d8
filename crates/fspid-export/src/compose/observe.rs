//! A program that tells besides how strong each rule was.
//!
//! Others need the command alone and shall not pay for this, so that it is added where it is asked for.

use crate::program::{
    Expression, Member, Operator, Part, Place, Program, Statement, Value, element, local, number,
    whole,
};

/// The member of the answer.
pub(crate) const STRENGTHS: &str = "strengths";
const RULES: i32 = 49;
/// Sets of an input, and rules in a row of the table.
const SETS: i32 = 7;

/// Adds the strengths of the rules R1 to R49 to the answer; a program without rules stays as it is.
///
/// A strength is the smaller of two grades where rules conclude labels, and their product where they conclude
/// numbers. Where nothing is inferred, in the dead zone or when a sample is held, all are 0. A network has no rules, and
/// its program stays as it is.
pub(crate) fn observed(mut program: Program) -> Program {
    if program.function("softsign").is_some() {
        return program;
    }
    let Some(infer) = program.functions.iter_mut().find(|function| function.name == "infer") else {
        return program;
    };
    infer.parts = &[Part::Configuration, Part::Answer];
    if !tell_rules(&mut infer.body) {
        tell_neighbours(&mut infer.body);
    }
    program.answer.push(Member {
        name: STRENGTHS.to_owned(),
        doc: "Strengths of the rules R1 to R49 at this sample, 0 to 1.".to_owned(),
        value: Value::Reals(vec![0.0; RULES as usize]),
    });
    for function in &mut program.functions {
        if function.name == "step" {
            let none = Statement::Set(strength_of(local("rule")), number(0.0));
            function.body.insert(0, Statement::repeat("rule", RULES, vec![none]));
        }
    }
    program
}

fn strength_of(rule: Expression) -> Place {
    Place::MemberElement(Part::Answer, STRENGTHS.to_owned(), Box::new(rule))
}

fn is_let(statement: &Statement, wanted: &str) -> bool {
    matches!(statement, Statement::Let(name, ..) if name == wanted)
}

/// Rules that conclude labels go through all 49; false where there is no such loop.
fn tell_rules(body: &mut Vec<Statement>) -> bool {
    if let Some(place) = body.iter().position(|statement| is_let(statement, "strength")) {
        body.insert(place + 1, Statement::Set(strength_of(local("rule")), local("strength")));
        return true;
    }
    body.iter_mut().any(|statement| match statement {
        Statement::For(.., inside) => tell_rules(inside),
        _ => false,
    })
}

/// Rules that conclude numbers are asked four at a time, from the one of the two lower sets on.
fn tell_neighbours(body: &mut Vec<Statement>) {
    let Some(place) = body.iter().position(|statement| is_let(statement, "rule")) else { return };
    let told = |(row, column): (i32, i32)| {
        let steps = whole(SETS * row + column);
        let rule = Expression::binary(Operator::Add, local("rule"), steps);
        let grade = element("row_grades", whole(row)) * element("column_grades", whole(column));
        Statement::Set(strength_of(rule), grade)
    };
    body.splice(place + 1..=place, [(0, 0), (0, 1), (1, 0), (1, 1)].map(told));
}

#[cfg(test)]
mod tests {
    use fspid_core::Controller;
    use fspid_core::fuzzy::{OutOfRange, Supervisor};
    use proptest::prelude::*;

    use super::*;
    use crate::interpret::{Cell, Machine};
    use crate::{Angles, program, vectors::samples};

    fn has_rules(controller: &Controller<f64>) -> bool {
        match controller {
            Controller::Fixed(_) => false,
            Controller::SelfTuning(fspid) => fspid.tuner().supervisor().network().is_none(),
        }
    }

    /// What the supervisor's own grades say of the rules.
    fn expected(supervisor: &Supervisor<f64>, seen: [f64; 2]) -> Vec<f64> {
        let [errors, changes] = seen.map(|input| supervisor.grades(input));
        let both = |error: f64, change: f64| {
            if supervisor.numbers().is_some() { error * change } else { error.min(change) }
        };
        errors.iter().flat_map(|error| changes.map(|change| both(*error, change))).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn what_is_observed_are_the_strengths_of_the_supervisor_and_the_command_keeps_its_bits(
            controller in fspid_options::any_controller(),
            seed in any::<u64>(),
        ) {
            let plain = program(&controller, Angles::Radians).expect("nothing here is refused");
            let observed = observed(plain.clone());
            let (mut plain, mut told) = (Machine::<f64>::new(&plain), Machine::<f64>::new(&observed));
            for sample in samples::<f64>(seed, 60) {
                for machine in [&mut plain, &mut told] {
                    machine.set(Part::Sample, "setpoint_rad", Cell::Real(sample.setpoint_rad));
                    machine.set(Part::Sample, "measurement_rad", Cell::Real(sample.measurement_rad));
                    machine.set(Part::Sample, "rate_rad_s", Cell::Real(sample.rate_rad_s));
                    machine.run("step");
                }
                let command = |machine: &Machine<'_, f64>| format!("{:?}", machine.member(Part::Answer, "command_rad"));
                prop_assert_eq!(command(&plain), command(&told));
                let Some(Cell::Reals(strengths)) = told.member(Part::Answer, STRENGTHS) else {
                    prop_assert!(!has_rules(&controller));
                    continue;
                };
                prop_assert!(strengths.iter().all(|strength| (0.0..=1.0).contains(strength)));
            }
        }

        #[test]
        fn the_strengths_are_those_of_the_grades(
            error in -6.0..6.0_f64,
            change in -6.0..6.0_f64,
            numbers in any::<bool>(),
        ) {
            let rules = fspid_core::paper::rules();
            let supervisor = if numbers {
                let grids = fspid_core::fuzzy::NumberTable::new([[[0.5; 7]; 7]; 3]).expect("finite");
                Supervisor::of_numbers(&grids, 5.0, OutOfRange::Clamp)
            } else {
                Supervisor::new(&rules, 5.0, fspid_core::fuzzy::Defuzzifier::Exact, OutOfRange::Clamp)
            };
            let supervisor = supervisor.expect("allowed");
            let nominal = fspid_core::Gains { kp: 1.0, ki: 0.5, kd: 0.2 };
            let settings = fspid_core::TunerSettings {
                change: fspid_core::Change::Delta,
                ..fspid_core::TunerSettings::literal()
            };
            let tuner = fspid_core::SelfTuner::new(nominal, supervisor, settings).expect("allowed");
            let config = fspid_core::PidConfig::sampled_every(0.01);
            let fspid = fspid_core::Fspid::new(tuner, config).expect("allowed");
            let program = program(&Controller::SelfTuning(fspid), Angles::Radians);
            let program = observed(program.expect("nothing here is refused"));
            let mut machine = Machine::<f64>::new(&program);
            // From an error of `error - change` to one of `error`: the supervisor sees both as they are.
            for setpoint in [error - change, error] {
                machine.set(Part::Sample, "setpoint_rad", Cell::Real(setpoint));
                machine.run("step");
            }
            let change = error - (error - change);
            let seen = [error, change].map(|input: f64| input.clamp(-5.0, 5.0));
            let Some(Cell::Reals(strengths)) = machine.member(Part::Answer, STRENGTHS) else {
                panic!("no strengths");
            };
            prop_assert_eq!(strengths, &expected(&supervisor, seen));
        }
    }
}
