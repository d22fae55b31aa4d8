//! What is computed in front of a statement.

use super::{
    Answer, Expression, Flattener, Kind, Operator, POWERS, Part, Place, Scope, Statement, decide,
    doublings, local, number,
};
use crate::program::member_element;

impl Flattener<'_> {
    /// Statements that put a value into a place, which is that of the flat program already.
    pub(super) fn assign(
        &mut self,
        scope: &Scope,
        place: Place,
        value: &Expression,
        out: &mut Vec<Statement>,
    ) {
        let in_use = self.hoisted;
        match value {
            Expression::Select(condition, then, otherwise) => {
                let condition = self.value(scope, condition, out);
                let [then, otherwise] = [then, otherwise].map(|way| {
                    let mut body = Vec::new();
                    self.assign(scope, place.clone(), way, &mut body);
                    body
                });
                decide(condition, then, otherwise, out);
            }
            Expression::Call(function, arguments) => {
                self.call(scope, function, arguments, Answer::Into(place), out);
            }
            Expression::Magnitude(value) => {
                let value = self.leaf(scope, value, out);
                magnitude(place, value, out);
            }
            Expression::PowerOfTwo(exponent) => self.power_of_two(scope, place, exponent, out),
            value => {
                let value = self.value(scope, value, out);
                if value != Expression::Read(place.clone()) {
                    out.push(Statement::Set(place, value));
                }
            }
        }
        self.hoisted = in_use;
    }

    /// The value as an expression without choices, calls and powers.
    pub(super) fn value(
        &mut self,
        scope: &Scope,
        value: &Expression,
        out: &mut Vec<Statement>,
    ) -> Expression {
        match value {
            Expression::Number(_)
            | Expression::Whole(_)
            | Expression::Byte(_)
            | Expression::Truth(_) => value.clone(),
            Expression::Read(place) => Expression::Read(self.place(scope, place, out)),
            Expression::Negative(value) => -self.value(scope, value, out),
            Expression::Not(value) => self.value(scope, value, out).negated(),
            Expression::ToReal(value) => {
                Expression::ToReal(Box::new(self.value(scope, value, out)))
            }
            Expression::Binary(operator, left, right) => {
                let compares = matches!(operator, Operator::Less | Operator::LessOrEqual);
                let [left, right] = [left, right].map(|side| match &**side {
                    // The sign of a zero does not show in a comparison, and no other number has two magnitudes.
                    Expression::Magnitude(of) if compares => self.value(scope, of, out).magnitude(),
                    side => self.value(scope, side, out),
                });
                Expression::binary(*operator, left, right)
            }
            Expression::Magnitude(_)
            | Expression::Select(..)
            | Expression::PowerOfTwo(_)
            | Expression::Call(..) => self.hoist(scope, value, out),
        }
    }

    /// A value with a name of its own.
    fn hoist(&mut self, scope: &Scope, value: &Expression, out: &mut Vec<Statement>) -> Expression {
        self.hoisted += 1;
        let name = format!("aside_{}", self.hoisted);
        self.declare(&name, Kind::Real);
        self.assign(scope, Place::Local(name.clone()), value, out);
        local(&name)
    }

    /// A value that is read more than once.
    fn leaf(&mut self, scope: &Scope, value: &Expression, out: &mut Vec<Statement>) -> Expression {
        match value {
            Expression::Read(Place::Local(_) | Place::Member(..)) => self.value(scope, value, out),
            value => self.hoist(scope, value, out),
        }
    }

    /// From the largest of the doublings to the smallest, each that fits in what is left of the exponent.
    fn power_of_two(
        &mut self,
        scope: &Scope,
        place: Place,
        exponent: &Expression,
        out: &mut Vec<Statement>,
    ) {
        self.needs_powers = true;
        let exponent = self.leaf(scope, exponent, out);
        let [rest, weight, index] =
            ["power_rest", "power_weight", "power_place"].map(|name| scope.name(name));
        for (name, kind) in [(&rest, Kind::Real), (&weight, Kind::Real), (&index, Kind::Whole)] {
            self.declare(name, kind);
        }
        let exponents: Vec<u32> = doublings(self.program.precision).collect();
        let largest = exponents.first().copied().unwrap_or(1);
        let of = || Expression::Read(place.clone());
        let power = || member_element(Part::Configuration, POWERS, local(&index));
        let multiply = Statement::If(
            exponent.clone().less(number(0.0)),
            vec![Statement::Set(place.clone(), of() / power())],
            vec![Statement::Set(place.clone(), of() * power())],
        );
        let fits = vec![multiply, Statement::set(&rest, local(&rest) - local(&weight))];
        let body = vec![
            Statement::when(local(&weight).at_most(local(&rest)), fits),
            Statement::set(&weight, local(&weight) * number(0.5)),
        ];
        magnitude(Place::Local(rest), exponent, out);
        out.extend([
            Statement::set(&weight, number(f64::from(largest))),
            Statement::Set(place.clone(), number(1.0)),
            Statement::repeat(&index, i32::try_from(exponents.len()).unwrap_or(0), body),
        ]);
    }
}

/// The magnitude with a zero that is positive, whatever a language's own function makes of it.
fn magnitude(place: Place, of: Expression, out: &mut Vec<Statement>) {
    let turned = Statement::Set(place.clone(), number(0.0) - of.clone());
    let kept = Statement::Set(place, of.clone());
    out.push(Statement::If(number(0.0).less(of), vec![kept], vec![turned]));
}
