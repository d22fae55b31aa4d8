//! The equations of the core, asked with a number that writes down what is done with it.
//!
//! A [`Traced`] number is a step of a computation. The controllers' equations are generic over their numbers, so
//! asked with traced ones they answer themselves: the same operations in the same order, ready to be written in
//! another language. What is exported and what flies are one definition.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use fspid_numeric::Real;
use fspid_numeric::lanes::Lanes;
use fspid_numeric::scalar::Scalar;

use crate::program::{Argument, Expression, Operator, Precision, Statement, local, number};

/// A step of a computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Traced(usize);

/// What a step does.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    /// A constant, which may be infinite.
    Constant(f64),
    /// What the program reads.
    Read(Expression),
    Binary(Operator, Traced, Traced),
    Negative(Traced),
    Magnitude(Traced),
    /// The third where the first is less than the second, else the fourth.
    IfLess(Traced, Traced, Traced, Traced),
    PowerOfTwo(Traced),
    /// What a function of the program answers.
    Call(&'static str, Traced),
    /// What only the platform's mathematics could compute.
    Foreign(&'static str),
}

thread_local! {
    static STEPS: RefCell<Vec<Step>> = const { RefCell::new(Vec::new()) };
}

fn step(step: Step) -> Traced {
    STEPS.with_borrow_mut(|steps| {
        // The same computation twice is one step.
        let index = steps.iter().position(|known| *known == step).unwrap_or(steps.len());
        if index == steps.len() {
            steps.push(step);
        }
        Traced(index)
    })
}

fn constant(traced: Traced) -> Option<f64> {
    STEPS.with_borrow(|steps| match steps.get(traced.0) {
        Some(Step::Constant(value)) => Some(*value),
        _ => None,
    })
}

/// True for the constant 0, which is not -0.
fn is_zero(traced: Traced) -> bool {
    matches!(get(traced), Step::Constant(value) if value.to_bits() == 0)
}

fn infinite(traced: Traced) -> Option<f64> {
    constant(traced).filter(|value| value.is_infinite())
}

/// A constant that no finite number is beyond.
fn endless(traced: Traced) -> Option<f64> {
    constant(traced).filter(|value| value.abs() >= f64::MAX)
}

/// Whether one is less than another, where one of them is endless and the other is a constant too, or what the program
/// reads or computes: a number that is no NaN and, unless an equation asks just that, finite.
fn is_less(value: Traced, bound: Traced) -> Option<bool> {
    match (endless(value), endless(bound)) {
        (None, None) => None,
        (Some(value), Some(bound)) => Some(value < bound),
        (Some(value), None) => Some(value < 0.0),
        // Below the upper end is what is finite: that is asked.
        (None, Some(bound)) => (bound < 0.0).then_some(false),
    }
}

impl Traced {
    /// What the program reads.
    pub(crate) fn read(expression: Expression) -> Self {
        step(Step::Read(expression))
    }

    /// A number of the configuration: what the program reads, or an infinity, with which equations do nothing.
    pub(crate) fn configured(value: f64, expression: Expression) -> Self {
        if value.is_infinite() { Self::constant(value) } else { Self::read(expression) }
    }
}

impl Add for Traced {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let end = infinite(self).or(infinite(other));
        end.map_or_else(|| step(Step::Binary(Operator::Add, self, other)), Self::constant)
    }
}

impl Sub for Traced {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        if is_zero(other) {
            // Exact for every number: also -0 - 0 is -0.
            return self;
        }
        let end = infinite(self).or(infinite(other).map(|end| -end));
        end.map_or_else(|| step(Step::Binary(Operator::Subtract, self, other)), Self::constant)
    }
}

impl Mul for Traced {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if is_zero(self) && is_zero(other) {
            return self;
        }
        step(Step::Binary(Operator::Multiply, self, other))
    }
}

impl Div for Traced {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        step(Step::Binary(Operator::Divide, self, other))
    }
}

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        step(Step::Negative(self))
    }
}

/// No controller flies with these, and no exported system may ask for them.
macro_rules! foreign {
    ($($name:ident),+) => {
        $(fn $name(self) -> Self {
            step(Step::Foreign(stringify!($name)))
        })+
    };
}

impl Scalar for Traced {
    fn constant(value: f64) -> Self {
        step(Step::Constant(value))
    }

    fn smaller(self, other: Self) -> Self {
        self.if_less(other, self, other)
    }

    fn larger(self, other: Self) -> Self {
        other.if_less(self, self, other)
    }

    fn abs(self) -> Self {
        step(Step::Magnitude(self))
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        // Nothing is below the lower infinity and nothing above the upper one.
        match is_less(self, bound) {
            Some(true) => then,
            Some(false) => otherwise,
            // The smaller of a number and infinity.
            None if then == self && otherwise == bound && endless(bound).is_some() => self,
            None => step(Step::IfLess(self, bound, then, otherwise)),
        }
    }

    fn exp(self) -> Self {
        step(Step::Call("exponential", self))
    }

    fn sqrt(self) -> Self {
        step(Step::Call("square_root", self))
    }

    fn pow(self, _: Self) -> Self {
        step(Step::Foreign("pow"))
    }

    foreign!(ln, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, floor);
}

/// A traced number of a precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lane<R>(pub(crate) Traced, std::marker::PhantomData<R>);

impl<R> Lane<R> {
    pub(crate) fn new(traced: Traced) -> Self {
        Self(traced, std::marker::PhantomData)
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident) => {
        impl<R: Real> $trait for Lane<R> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::new(self.0.$method(other.0))
            }
        }
    };
}

lane_operator!(Add, add);
lane_operator!(Sub, sub);
lane_operator!(Mul, mul);
lane_operator!(Div, div);

impl<R: Real> Lanes for Lane<R> {
    type Number = R;

    fn same(self, value: R) -> Self {
        Self::new(Traced::constant(value.to_f64()))
    }

    fn smaller(self, other: Self) -> Self {
        Self::new(self.0.smaller(other.0))
    }

    fn larger(self, other: Self) -> Self {
        Self::new(self.0.larger(other.0))
    }

    fn power_of_two(self) -> Self {
        Self::new(step(Step::PowerOfTwo(self.0)))
    }

    fn raised(self, shifted: Self) -> Self {
        let k = shifted - self.same(R::ROUND);
        self * k.power_of_two()
    }

    fn lane_by_lane(_: &[Self], zero: Self, _: impl Fn(&[R]) -> R) -> Self {
        // No exponential asks for this.
        zero * zero.same(R::from_f64(f64::NAN))
    }
}

/// Writes traced steps as statements of one function.
pub(crate) struct Listing {
    precision: Precision,
    /// What stands in a value of the function already.
    named: BTreeMap<Traced, String>,
    /// How many values without a name of the equations there are.
    unnamed: usize,
}

impl Listing {
    /// For a function that begins; traced numbers of another function mean nothing in it.
    pub(crate) fn new(precision: Precision) -> Self {
        STEPS.with_borrow_mut(Vec::clear);
        Self { precision, named: BTreeMap::new(), unnamed: 0 }
    }

    /// Statements that compute these values and give them these names.
    pub(crate) fn values(&mut self, values: &[(&str, Traced)]) -> Vec<Statement> {
        let mut uses = BTreeMap::new();
        for (_, traced) in values {
            self.count(*traced, &mut uses);
        }
        let wanted: BTreeMap<Traced, &str> =
            values.iter().rev().map(|(name, traced)| (*traced, *name)).collect();
        let mut statements = Vec::new();
        for (&traced, &count) in &uses {
            let name = match wanted.get(&traced) {
                Some(name) => (*name).to_owned(),
                None if count > 1 && !self.is_leaf(traced) => {
                    self.unnamed += 1;
                    format!("part_{}", self.unnamed)
                }
                None => continue,
            };
            statements.push(Statement::real(&name, self.expression(traced)));
            self.named.insert(traced, name);
        }
        for (name, traced) in values {
            if self.named.get(traced).is_some_and(|known| known != name) {
                statements.push(Statement::real(name, self.expression(*traced)));
            }
        }
        statements
    }

    /// The first function that only the platform's mathematics could compute, among all that was asked for.
    pub(crate) fn foreign(&self) -> Option<&'static str> {
        let name = |step: &Step| if let Step::Foreign(name) = step { Some(*name) } else { None };
        STEPS.with_borrow(|steps| steps.iter().find_map(name))
    }

    /// Values of these names do not stand any more: their block has ended.
    pub(crate) fn forget(&mut self, names: &[String]) {
        self.named.retain(|_, name| !names.contains(name) && !name.starts_with("part_"));
    }

    /// One value in place.
    pub(crate) fn value(&mut self, traced: Traced) -> Expression {
        self.expression(traced)
    }

    fn is_leaf(&self, traced: Traced) -> bool {
        matches!(get(traced), Step::Constant(_) | Step::Read(_)) || self.named.contains_key(&traced)
    }

    /// How often each step is used; steps stand behind those that they use.
    fn count(&self, traced: Traced, uses: &mut BTreeMap<Traced, usize>) {
        let count = uses.entry(traced).or_insert(0);
        *count += 1;
        if *count == 1 && !self.named.contains_key(&traced) {
            operands(&get(traced)).into_iter().for_each(|operand| self.count(operand, uses));
        }
    }

    fn expression(&self, traced: Traced) -> Expression {
        if let Some(name) = self.named.get(&traced) {
            return local(name);
        }
        let of = |traced| self.expression(traced);
        match get(traced) {
            Step::Constant(value) => number(value),
            Step::Read(expression) => expression,
            Step::Binary(operator, left, right) => {
                Expression::binary(operator, of(left), of(right))
            }
            Step::Negative(value) => -of(value),
            Step::Magnitude(value) => of(value).magnitude(),
            Step::PowerOfTwo(value) => Expression::PowerOfTwo(Box::new(of(value))),
            Step::Call(name, value) => Expression::Call(name, vec![Argument::Value(of(value))]),
            Step::Foreign(_) => number(f64::NAN),
            Step::IfLess(value, bound, then, otherwise) => {
                let beyond = |end: &f64| *end > self.precision.largest();
                let is_less = match constant(bound).filter(beyond) {
                    Some(_) => of(value).at_most(number(self.precision.largest())),
                    None => of(value).less(of(bound)),
                };
                is_less.select(of(then), of(otherwise))
            }
        }
    }
}

fn get(traced: Traced) -> Step {
    STEPS.with_borrow(|steps| steps.get(traced.0).cloned().unwrap_or(Step::Constant(f64::NAN)))
}

fn operands(step: &Step) -> Vec<Traced> {
    match *step {
        Step::Constant(_) | Step::Read(_) | Step::Foreign(_) => Vec::new(),
        Step::Negative(value)
        | Step::Magnitude(value)
        | Step::PowerOfTwo(value)
        | Step::Call(_, value) => vec![value],
        Step::Binary(_, left, right) => vec![left, right],
        Step::IfLess(value, bound, then, otherwise) => vec![value, bound, then, otherwise],
    }
}
