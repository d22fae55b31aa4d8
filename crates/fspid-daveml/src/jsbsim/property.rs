//! Properties of JSBSim that a flight here has, by the names of the standard, and those that are held.

use std::collections::{BTreeMap, BTreeSet};

use crate::document::{Document, Role, Variable};
use crate::expression::Expression;
use crate::finding::{Findings, Origin};
use crate::formula::{is_name, parse};
use crate::jsbsim::class::{Class, Share};
use crate::jsbsim::metrics::Metrics;
use crate::jsbsim::surface::Scaled;

/// Where a property comes from.
#[derive(Clone, Copy)]
enum Kind {
    /// A quantity of the flight with that name in the standard.
    Flight(&'static str),
    /// A surface with that name in the standard.
    Surface(&'static str),
    /// The rate of the angle of attack.
    Rate(&'static str),
    /// Made of others.
    Formula(&'static str),
    /// Always the same, unless another value is asked for.
    Held(f64),
}

use Kind::{Flight, Formula, Held, Rate, Surface};

/// The dynamic pressure, to which every load is proportional: coefficients are loads at a pressure of 1.
const PRESSURE: &str = "aero/qbar-psf";

/// Height over the ground in spans at which the ground is far: tables of its effect end near 1.
const FAR_FROM_THE_GROUND: f64 = 100.0;

/// Lift over dynamic pressure, without what is proportional to the rate of the angle of attack.
pub(super) const LIFT_AT_REST: &str = "axis/LIFT-at-rest";

/// The angle of attack, whose name stands in formulas of the axes too.
pub(super) const ALPHA: &str = "aero/alpha-rad";
/// The angle of sideslip.
pub(super) const BETA: &str = "aero/beta-rad";
/// The Mach number.
pub(super) const MACH: &str = "velocities/mach";
/// The altitude.
pub(super) const ALTITUDE: &str = "position/h-sl-ft";
/// The square of the coefficient of lift.
pub(super) const LIFT_SQUARED: &str = "aero/cl-squared";

/// Properties, their units and where they come from.
///
/// The air is calm where JSBSim tells motion through the air from motion over the ground. One degree is π/180.
const PROPERTIES: &[(&str, &str, Kind)] = &[
    (ALPHA, "rad", Flight("angleOfAttack")),
    (BETA, "rad", Flight("angleOfSideslip")),
    ("velocities/vt-fps", "ft_s", Flight("trueAirspeed")),
    ("velocities/p-aero-rad_sec", "rad_s", Flight("bodyAngularRate_Roll")),
    ("velocities/q-aero-rad_sec", "rad_s", Flight("bodyAngularRate_Pitch")),
    ("velocities/r-aero-rad_sec", "rad_s", Flight("bodyAngularRate_Yaw")),
    (MACH, "nd", Flight("mach")),
    (ALTITUDE, "ft", Flight("altitudeMSL")),
    ("fcs/elevator-pos-rad", "rad", Surface("elevatorDeflection")),
    ("fcs/left-aileron-pos-rad", "rad", Surface("aileronDeflection")),
    ("fcs/rudder-pos-rad", "rad", Surface("rudderDeflection")),
    ("aero/alphadot-rad_sec", "rad_s", Rate("angleOfAttackRate")),
    ("aero/alpha-deg", "deg", Formula("times(57.29577951308232, aero/alpha-rad)")),
    ("aero/beta-deg", "deg", Formula("times(57.29577951308232, aero/beta-rad)")),
    ("aero/mag-beta-rad", "rad", Formula("abs(aero/beta-rad)")),
    ("aero/mag-beta-deg", "deg", Formula("abs(aero/beta-deg)")),
    ("aero/bi2vel", "s", Formula("divide(metrics/bw-ft, times(2.0, velocities/vt-fps))")),
    ("aero/ci2vel", "s", Formula("divide(metrics/cbarw-ft, times(2.0, velocities/vt-fps))")),
    (LIFT_SQUARED, "nd", Formula("power(divide(axis/LIFT-at-rest, metrics/Sw-sqft), 2.0)")),
    ("velocities/p-rad_sec", "rad_s", Formula("velocities/p-aero-rad_sec")),
    ("velocities/q-rad_sec", "rad_s", Formula("velocities/q-aero-rad_sec")),
    ("velocities/r-rad_sec", "rad_s", Formula("velocities/r-aero-rad_sec")),
    (
        "velocities/u-aero-fps",
        "ft_s",
        Formula("times(velocities/vt-fps, cos(aero/alpha-rad), cos(aero/beta-rad))"),
    ),
    ("velocities/v-aero-fps", "ft_s", Formula("times(velocities/vt-fps, sin(aero/beta-rad))")),
    (
        "velocities/w-aero-fps",
        "ft_s",
        Formula("times(velocities/vt-fps, sin(aero/alpha-rad), cos(aero/beta-rad))"),
    ),
    ("fcs/elevator-pos-deg", "deg", Formula("times(57.29577951308232, fcs/elevator-pos-rad)")),
    ("fcs/mag-elevator-pos-rad", "rad", Formula("abs(fcs/elevator-pos-rad)")),
    (
        "fcs/left-aileron-pos-deg",
        "deg",
        Formula("times(57.29577951308232, fcs/left-aileron-pos-rad)"),
    ),
    ("fcs/mag-left-aileron-pos-rad", "rad", Formula("abs(fcs/left-aileron-pos-rad)")),
    ("fcs/right-aileron-pos-rad", "rad", Formula("minus(fcs/left-aileron-pos-rad)")),
    ("fcs/right-aileron-pos-deg", "deg", Formula("minus(fcs/left-aileron-pos-deg)")),
    ("fcs/mag-right-aileron-pos-rad", "rad", Formula("abs(fcs/left-aileron-pos-rad)")),
    ("fcs/rudder-pos-deg", "deg", Formula("times(57.29577951308232, fcs/rudder-pos-rad)")),
    ("fcs/mag-rudder-pos-rad", "rad", Formula("abs(fcs/rudder-pos-rad)")),
    ("metrics/iw-deg", "deg", Formula("times(57.29577951308232, metrics/iw-rad)")),
    ("aero/h_b-cg-ft", "nd", Held(FAR_FROM_THE_GROUND)),
    ("aero/h_b-mac-ft", "nd", Held(FAR_FROM_THE_GROUND)),
    ("aero/stall-hyst-norm", "nd", Held(0.0)),
    ("fcs/flap-cmd-norm", "nd", Held(0.0)),
    ("fcs/flap-pos-deg", "deg", Held(0.0)),
    ("fcs/flap-pos-norm", "nd", Held(0.0)),
    ("fcs/flap-pos-rad", "rad", Held(0.0)),
    ("fcs/speedbrake-pos-deg", "deg", Held(0.0)),
    ("fcs/speedbrake-pos-norm", "nd", Held(0.0)),
    ("fcs/speedbrake-pos-rad", "rad", Held(0.0)),
    ("fcs/spoiler-pos-deg", "deg", Held(0.0)),
    ("fcs/spoiler-pos-norm", "nd", Held(0.0)),
    ("fcs/spoiler-pos-rad", "rad", Held(0.0)),
    ("gear/gear-pos-norm", "nd", Held(0.0)),
];

/// What an unknown property may be instead.
const EXPECTED: &str =
    "a property of the flight, or a value at which this one is held: `--set PROPERTY=VALUE`";

/// A formula and what it depends on.
#[derive(Clone, Debug)]
pub(super) struct Term {
    pub(super) formula: Expression,
    pub(super) class: Class,
}

/// The model of aerodynamics while it is put together.
pub(super) struct Builder<'a> {
    pub(super) document: Document,
    pub(super) findings: &'a mut Findings,
    held: &'a [(String, f64)],
    /// Properties by name that are made by other parts of the file, as formulas, or why they are not known.
    scaled: BTreeMap<String, Scaled>,
    classes: BTreeMap<String, Class>,
    /// Names that were refused, so that each is told once.
    refused: BTreeSet<String>,
    used: BTreeSet<String>,
}

impl<'a> Builder<'a> {
    /// A model with the constants of `<metrics>`.
    pub(super) fn new(
        metrics: &Metrics,
        held: &'a [(String, f64)],
        scaled: BTreeMap<String, Scaled>,
        findings: &'a mut Findings,
    ) -> Self {
        let mut builder = Self {
            document: Document::default(),
            findings,
            held,
            scaled,
            classes: BTreeMap::new(),
            refused: BTreeSet::new(),
            used: BTreeSet::new(),
        };
        for &(property, standard, units, value) in &metrics.values {
            let roles = if standard.is_empty() { vec![] } else { vec![Role::Output] };
            let name = if standard.is_empty() { property } else { standard };
            let variable = Variable { initial: Some(value), roles, ..named(property, name, units) };
            builder.add(variable, Class::default());
        }
        builder
    }

    /// Adds a variable under a name that nothing has.
    pub(super) fn add(&mut self, variable: Variable, class: Class) {
        if !self.classes.contains_key(&variable.id) {
            self.classes.insert(variable.id.clone(), class);
            self.document.variables.push(variable);
        }
    }

    /// Notes that a name makes nothing, and was told.
    pub(super) fn refuse(&mut self, name: &str) {
        self.refused.insert(name.to_owned());
    }

    /// Tells what is wrong, once for each name.
    fn unknown(&mut self, name: &str, origin: Origin) {
        if self.refused.insert(name.to_owned()) {
            let message = "a flight here has no such property";
            self.findings.problem(origin, name, message, EXPECTED);
        }
    }

    /// What a property is; a name that begins with a minus is its negative.
    pub(super) fn property(&mut self, text: &str, origin: Origin) -> Option<Term> {
        if let Some(name) = text.strip_prefix('-') {
            let Term { formula, class } = self.plain(name.trim(), origin)?;
            let minus = crate::expression::Function::Minus;
            return Some(Term { formula: Expression::Apply(minus, vec![formula]), class });
        }
        self.plain(text, origin)
    }

    fn plain(&mut self, name: &str, origin: Origin) -> Option<Term> {
        if name == PRESSURE {
            let class = Class { pressure: true, ..Class::default() };
            return Some(Term { formula: Expression::Number(1.0), class });
        }
        if !self.classes.contains_key(name) && !self.refused.contains(name) {
            self.introduce(name, origin);
        }
        let class = *self.classes.get(name)?;
        Some(Term { formula: Expression::Variable { id: name.to_owned(), origin }, class })
    }

    /// Adds the variable of a property that is met for the first time.
    fn introduce(&mut self, name: &str, origin: Origin) {
        let row = PROPERTIES.iter().find(|(property, ..)| *property == name);
        let asked = self.held.iter().rev().find(|(property, _)| property == name);
        let asked = asked.map(|&(_, value)| value);
        self.used.extend(asked.map(|_| name.to_owned()));
        let scaled = self.scaled.get(name).cloned();
        match (row, asked) {
            (Some((_, _, Flight(_) | Surface(_))), Some(_)) => {
                let message = "this is flown, and cannot be held";
                self.findings.problem(origin, name, message, "another property");
                self.refuse(name);
            }
            (Some(&(_, units, _)), Some(value)) => self.hold(name, units, value, origin),
            (None, Some(value)) => self.hold(name, "nd", value, origin),
            (Some(&(_, units, Held(value))), None) => self.hold(name, units, value, origin),
            (Some(&(_, units, Formula(text))), None) => {
                let formula = parse(text).unwrap_or(Expression::Number(f64::NAN));
                self.made((name, units), formula, origin);
            }
            (Some(&(_, units, Flight(standard))), None) => {
                let variable =
                    Variable { roles: vec![Role::Input], ..named(name, standard, units) };
                self.add(variable, Class::default());
            }
            (Some(&(_, units, Surface(standard))), None) => {
                let variable =
                    Variable { roles: vec![Role::Control], ..named(name, standard, units) };
                self.add(variable, Class { control: true, ..Class::default() });
            }
            (Some(&(_, units, Rate(standard))), None) => {
                let variable =
                    Variable { roles: vec![Role::Input], ..named(name, standard, units) };
                self.add(variable, Class { rate: Share::Proportional, ..Class::default() });
            }
            (None, None) => match scaled {
                Some(Ok(formula)) => self.made((name, "nd"), formula, origin),
                Some(Err(why)) => {
                    self.findings.problem(origin, name, why, EXPECTED);
                    self.refuse(name);
                }
                None => self.unknown(name, origin),
            },
        }
    }

    fn hold(&mut self, name: &str, units: &str, value: f64, origin: Origin) {
        if !is_name(name) {
            return self.unknown(name, origin);
        }
        self.findings.note(origin, format!("{name} is held at {value}"));
        let variable = Variable { initial: Some(value), ..named(name, name, units) };
        self.add(variable, Class::default());
    }

    /// A property that is made of others.
    fn made(&mut self, (name, units): (&str, &str), formula: Expression, origin: Origin) {
        if name == LIFT_SQUARED {
            let message = format!(
                "{name} is the square of the lift without its part by the rate of the angle of attack"
            );
            self.findings.note(origin, message);
        }
        let mut classes = Vec::new();
        let known = self.each_operand(&formula, origin, &mut classes);
        if !known {
            return self.refuse(name);
        }
        let class = Class::product(&classes).unwrap_or_default();
        self.add(Variable { formula: Some(formula), ..named(name, name, units) }, class);
    }

    /// Classes of the variables of a formula; false if one of them is not known.
    fn each_operand(
        &mut self,
        formula: &Expression,
        origin: Origin,
        classes: &mut Vec<Class>,
    ) -> bool {
        match formula {
            Expression::Number(_) => true,
            // Made of what surfaces move, and of nothing that may not stand in a square.
            Expression::Variable { id, .. } if id == LIFT_AT_REST => {
                classes.push(Class { control: true, ..Class::default() });
                true
            }
            Expression::Variable { id, .. } => {
                let term = self.plain(id, origin);
                classes.extend(term.as_ref().map(|term| term.class));
                term.is_some()
            }
            Expression::Apply(_, operands) => {
                operands.iter().all(|operand| self.each_operand(operand, origin, classes))
            }
        }
    }

    /// True where a value is asked for at which a property is held.
    pub(super) fn is_held(&self, name: &str) -> bool {
        self.held.iter().any(|(held, _)| held == name)
    }

    /// True where the model asks for the square of the lift.
    pub(super) fn squares_lift(&self) -> bool {
        self.classes.contains_key(LIFT_SQUARED)
    }

    /// What a variable depends on.
    pub(super) fn class(&self, id: &str) -> Class {
        self.classes.get(id).copied().unwrap_or_default()
    }

    /// Tells of values that nothing asked for.
    pub(super) fn unused(&mut self) {
        for (name, _) in self.held {
            if !self.used.contains(name) {
                let message = "no function of the aerodynamics asks for this property";
                self.findings.problem(Origin(None), name, message, "nothing; leave it out");
            }
        }
    }
}

/// A variable with an identifier, a name and units.
pub(super) fn named(id: &str, name: &str, units: &str) -> Variable {
    Variable {
        id: id.to_owned(),
        name: name.to_owned(),
        units: units.to_owned(),
        ..Variable::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_formula_of_a_property_can_be_read_and_names_stand_once() {
        let mut names = BTreeSet::new();
        for (name, _, kind) in PROPERTIES {
            assert!(is_name(name) && names.insert(name), "{name}");
            if let Formula(text) = kind {
                assert_eq!(parse(text).map(|formula| formula.to_string()), Ok((*text).to_owned()));
            }
        }
    }
}
