//! What an importer sees of a controller: its variables with units, ranges and places in memory.

use fspid_core::fuzzy::Label;
use fspid_numeric::units::{DEGREE_RAD, RADIAN_DEG};

use super::parameter;
use crate::compose::STRENGTHS;
use crate::program::{Member, Part, Program, Value};

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    Input,
    Parameter,
    Output,
}

/// What a variable holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Holds {
    Real,
    /// Small whole numbers.
    Whole,
    Truth,
}

/// A variable; its value reference is its place in the list.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) role: Role,
    pub(super) holds: Holds,
    /// Of [`Unit::ALL`].
    pub(super) unit: Option<&'static Unit>,
    pub(super) start: f64,
    /// The closed interval of what is allowed.
    pub(super) range: (f64, f64),
    /// Where it lies in C's `struct memory`; empty for the time, which has a place of its own.
    pub(super) place: String,
}

/// A unit, its exponents, and how it is shown.
#[derive(Debug, PartialEq)]
pub(super) struct Unit {
    pub(super) name: &'static str,
    pub(super) rad: i8,
    pub(super) s: i8,
    /// One of it in SI units.
    pub(super) factor: f64,
    /// A unit for people, and how many of that are one.
    pub(super) shown: Option<(&'static str, f64)>,
}

impl Unit {
    pub(super) const ALL: [Self; 8] = [
        Self { name: "rad", rad: 1, s: 0, factor: 1.0, shown: Some(("deg", RADIAN_DEG)) },
        Self { name: "rad/s", rad: 1, s: -1, factor: 1.0, shown: Some(("deg/s", RADIAN_DEG)) },
        Self { name: "deg", rad: 1, s: 0, factor: DEGREE_RAD, shown: Some(("rad", DEGREE_RAD)) },
        Self {
            name: "deg/s",
            rad: 1,
            s: -1,
            factor: DEGREE_RAD,
            shown: Some(("rad/s", DEGREE_RAD)),
        },
        Self { name: "s", rad: 0, s: 1, factor: 1.0, shown: None },
        Self { name: "1/s", rad: 0, s: -1, factor: 1.0, shown: None },
        Self { name: "1/rad", rad: -1, s: 0, factor: 1.0, shown: Some(("1/deg", DEGREE_RAD)) },
        Self { name: "1", rad: 0, s: 0, factor: 1.0, shown: None },
    ];

    pub(super) fn named(name: &str) -> Option<&'static Self> {
        const ALL: &[Unit] = &Unit::ALL;
        ALL.iter().find(|unit| unit.name == name)
    }

    /// The unit that the end of a name says, as names of this project do.
    pub(super) fn of(name: &str) -> Option<&'static Self> {
        // What is seen beside the error is an angle or a rate; what a factor behind the rules is depends on the law.
        if ["change_per_rad", "zone_change_rad", "scale_kp", "scale_ki", "scale_kd"].contains(&name)
        {
            return None;
        }
        let ends = [
            ("_per_kd", "1"),
            ("_per_rad", "1/rad"),
            ("_per_s", "1/s"),
            ("_rad_s", "rad/s"),
            ("_deg_s", "deg/s"),
            ("_rad", "rad"),
            ("_deg", "deg"),
            ("_s", "s"),
        ];
        let of_gain = match name.rsplit('_').next() {
            Some("kp") => Some("1"),
            Some("ki") => Some("1/s"),
            Some("kd") => Some("s"),
            _ => None,
        };
        let of_end = ends.iter().find(|(end, _)| name.ends_with(end)).map(|(_, unit)| *unit);
        of_end.or(of_gain).and_then(Self::named)
    }
}

/// All variables, the time first. Those of a fuzzy system have the units of its file, which are not known.
pub(super) fn variables(program: &Program, is_system: bool) -> Vec<Variable> {
    let plain = |member, part| {
        let found = plain(member, part)?;
        Some(match is_system {
            true => Variable { doc: member.doc.clone(), unit: None, ..found },
            false => found,
        })
    };
    let time = Variable {
        name: "time".to_owned(),
        doc: "Time.".to_owned(),
        role: Role::Time,
        holds: Holds::Real,
        unit: Unit::named("s"),
        start: 0.0,
        range: ANY,
        place: String::new(),
    };
    let inputs = program.sample.iter().filter_map(|member| plain(member, Part::Sample));
    let outputs = program.answer.iter().flat_map(|member| match &member.value {
        Value::Reals(_) => strengths(),
        _ => plain(member, Part::Answer).into_iter().collect(),
    });
    let parameters = parameter::parameters(program);
    [time].into_iter().chain(inputs).chain(outputs).chain(parameters).collect()
}

const ANY: (f64, f64) = (f64::MIN, f64::MAX);

/// The name of a part in C's `struct memory`.
pub(super) const fn part_name(part: Part) -> &'static str {
    match part {
        Part::Configuration => "configuration",
        Part::State => "state",
        Part::Sample => "sample",
        Part::Answer => "answer",
    }
}

/// A member that is one value.
pub(super) fn plain(member: &Member, part: Part) -> Option<Variable> {
    let (holds, start) = match member.value {
        Value::Real(start) => (Holds::Real, start),
        Value::Byte(start) => (Holds::Whole, f64::from(start)),
        Value::Truth(start) => (Holds::Truth, f64::from(u8::from(start))),
        Value::Reals(_) | Value::Bytes(_) => return None,
    };
    let role = match part {
        Part::Configuration => Role::Parameter,
        Part::Sample => Role::Input,
        Part::State | Part::Answer => Role::Output,
    };
    let doc = if member.name == "faults" { FAULTS.to_owned() } else { member.doc.clone() };
    let unit = (holds == Holds::Real).then(|| Unit::of(&member.name)).flatten();
    let place = format!("{}.{}", part_name(part), member.name);
    Some(Variable { name: member.name.clone(), doc, role, holds, unit, start, range: ANY, place })
}

const FAULTS: &str = "Faults latched so far, as a sum: 1 a sample not finite, 2 beyond the guard, 4 overflow, 8 supervisor input out of \
range, 16 supervisor underflow.";

fn strengths() -> Vec<Variable> {
    let labels = Label::ALL;
    let rules = labels.iter().flat_map(|error| labels.iter().map(move |change| (error, change)));
    let strength = |(index, (error, change))| Variable {
        name: format!("strength_R{}", index + 1),
        doc: format!(
            "Strength of rule R{}: error {error:?}, change {change:?}; 0 where nothing is inferred.",
            index + 1
        ),
        role: Role::Output,
        holds: Holds::Real,
        unit: Unit::named("1"),
        start: 0.0,
        range: ANY,
        place: format!("answer.{STRENGTHS}[{index}]"),
    };
    rules.enumerate().map(strength).collect()
}
