//! The equations of a controller, written down once by a number that records what is done with it, and gone through forwards
//! and backwards for many flights side by side.
//!
//! The controllers' equations are generic over their numbers and choose by [`if_less`](Scalar::if_less) alone, so that what
//! they do is the same list of operations at every sample. Recorded once, it is run on values; backwards, each operation
//! hands what its result is worth to its operands (reverse mode). What flies and what is differentiated are one definition.
//!
//! Where two cases of `if_less` or of a magnitude meet, the derivative is that of the case that gave the value: one of
//! Clarke's generalised gradient.
//!
//! # Source
//! Griewank and Walther, *Evaluating Derivatives*, SIAM 2008, chapters 3 and 4.

use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use fspid_numeric::Scalar;

/// A place among the values; as small as can be, so that a list of operations is read quickly.
type Place = u32;

/// An operation, by the places of its operands, which stand before it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Input,
    Constant(f64),
    Add(Place, Place),
    Subtract(Place, Place),
    Multiply(Place, Place),
    Divide(Place, Place),
    Negative(Place),
    Magnitude(Place),
    /// The third where the first is less than the second, else the fourth.
    IfLess([Place; 4]),
    /// No controller's equation asks for it; it answers NaN.
    Foreign,
}

thread_local! {
    static RECORD: RefCell<Vec<Operation>> = const { RefCell::new(Vec::new()) };
}

/// A number that records what is done with it: the place of its operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Recorded(Place);

fn recorded(operation: Operation) -> Recorded {
    RECORD.with_borrow_mut(|record| {
        // The same computation twice is one operation; inputs are never the same.
        let known = match operation {
            Operation::Input => None,
            _ => record.iter().position(|known| *known == operation),
        };
        let place = known.unwrap_or(record.len());
        if place == record.len() {
            record.push(operation);
        }
        #[allow(clippy::cast_possible_truncation, reason = "equations have hundreds of operations")]
        Recorded(place as Place)
    })
}

macro_rules! operator {
    ($trait:ident, $method:ident, $operation:ident) => {
        impl $trait for Recorded {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                recorded(Operation::$operation(self.0, other.0))
            }
        }
    };
}
operator!(Add, add, Add);
operator!(Sub, sub, Subtract);
operator!(Mul, mul, Multiply);
operator!(Div, div, Divide);

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        recorded(Operation::Negative(self.0))
    }
}

macro_rules! foreign {
    ($($name:ident),+) => {
        $(fn $name(self) -> Self {
            recorded(Operation::Foreign)
        })+
    };
}

impl Scalar for Recorded {
    fn constant(value: f64) -> Self {
        recorded(Operation::Constant(value))
    }

    fn smaller(self, other: Self) -> Self {
        self.if_less(other, self, other)
    }

    fn larger(self, other: Self) -> Self {
        other.if_less(self, self, other)
    }

    fn abs(self) -> Self {
        recorded(Operation::Magnitude(self.0))
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        recorded(Operation::IfLess([self.0, bound.0, then.0, otherwise.0]))
    }

    fn pow(self, _: Self) -> Self {
        recorded(Operation::Foreign)
    }

    foreign!(exp, ln, sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, floor);
}

/// An operation and the place of its answer.
#[derive(Clone, Copy, Debug)]
struct Step {
    operation: Operation,
    to: Place,
}

/// A list of operations from inputs to outputs. The inputs are the first places.
#[derive(Clone, Debug)]
pub(super) struct Program {
    places: usize,
    outputs: Vec<Place>,
    /// Operations that depend on inputs that stand still alone, and those that are left, each in order.
    still: Vec<Step>,
    moving: Vec<Step>,
}

impl Program {
    /// Records what an equation does with so many inputs, of which the first `moving` differ from sample to sample and the
    /// others stand still through a flight.
    pub(super) fn record(
        [moving, inputs]: [usize; 2],
        equation: impl FnOnce(&[Recorded]) -> Vec<Recorded>,
    ) -> Self {
        RECORD.with_borrow_mut(Vec::clear);
        let given: Vec<Recorded> = (0..inputs).map(|_| recorded(Operation::Input)).collect();
        let outputs: Vec<Place> = equation(&given).iter().map(|output| output.0).collect();
        let operations = RECORD.with_borrow_mut(std::mem::take);
        let (mut moves, mut needed) =
            (vec![false; operations.len()], vec![false; operations.len()]);
        for (place, operation) in operations.iter().enumerate() {
            moves[place] = match operation {
                Operation::Input => place < moving,
                other => operands(other).any(|operand| moves[operand as usize]),
            };
        }
        outputs.iter().for_each(|&output| needed[output as usize] = true);
        for (place, operation) in operations.iter().enumerate().rev() {
            if needed[place] {
                operands(operation).for_each(|operand| needed[operand as usize] = true);
            }
        }
        let of = |wanted: bool| {
            let steps = operations.iter().zip(0..).filter(|(operation, to)| {
                let place = *to as usize;
                needed[place] && moves[place] == wanted && **operation != Operation::Input
            });
            steps.map(|(operation, to)| Step { operation: *operation, to }).collect()
        };
        let (still, moving) = (of(false), of(true));
        Self { places: operations.len(), outputs, still, moving }
    }

    /// Room for the values of all operations.
    pub(super) fn room<const W: usize>(&self) -> Vec<[f64; W]> {
        vec![[0.0; W]; self.places]
    }

    /// Puts inputs from a place on.
    #[inline(always)]
    pub(super) fn put<const W: usize>(
        &self,
        values: &mut [[f64; W]],
        from: usize,
        inputs: &[[f64; W]],
    ) {
        values[from..from + inputs.len()].copy_from_slice(inputs);
    }

    /// An output.
    #[inline(always)]
    pub(super) fn output<const W: usize>(&self, values: &[[f64; W]], output: usize) -> [f64; W] {
        values[self.outputs[output] as usize]
    }

    /// Adds what an output is worth.
    #[inline(always)]
    pub(super) fn credit<const W: usize>(
        &self,
        worth: &mut [[f64; W]],
        output: usize,
        by: &[f64; W],
    ) {
        let place = self.outputs[output] as usize;
        worth[place] = each(worth[place], *by, |worth, by| worth + by);
    }

    /// What an input is worth, which is forgotten.
    #[inline(always)]
    pub(super) fn take<const W: usize>(&self, worth: &mut [[f64; W]], input: usize) -> [f64; W] {
        std::mem::replace(&mut worth[input], [0.0; W])
    }

    /// Computes what depends on inputs that stand still alone.
    pub(super) fn run_still<const W: usize>(&self, values: &mut [[f64; W]]) {
        run_steps(&self.still, values);
    }

    /// Computes the rest.
    #[inline(always)]
    pub(super) fn run<const W: usize>(&self, values: &mut [[f64; W]]) {
        run_steps(&self.moving, values);
    }

    /// Hands what the outputs are worth to the inputs, and to what stands still, whose sums grow on.
    #[inline(always)]
    pub(super) fn back<const W: usize>(&self, values: &[[f64; W]], worth: &mut [[f64; W]]) {
        back_steps(&self.moving, values, worth);
    }

    /// Hands the sums of what stands still to the inputs, once for a flight.
    pub(super) fn back_still<const W: usize>(&self, values: &[[f64; W]], worth: &mut [[f64; W]]) {
        back_steps(&self.still, values, worth);
    }
}

#[inline(always)]
fn run_steps<const W: usize>(steps: &[Step], values: &mut [[f64; W]]) {
    for step in steps {
        let value = {
            let of = |place: Place| values[place as usize];
            match step.operation {
                Operation::Input => continue,
                Operation::Constant(constant) => [constant; W],
                Operation::Foreign => [f64::NAN; W],
                Operation::Add(a, b) => each(of(a), of(b), |a, b| a + b),
                Operation::Subtract(a, b) => each(of(a), of(b), |a, b| a - b),
                Operation::Multiply(a, b) => each(of(a), of(b), times),
                Operation::Divide(a, b) => each(of(a), of(b), |a, b| a / b),
                Operation::Negative(a) => of(a).map(|a| -a),
                Operation::Magnitude(a) => of(a).map(f64::abs),
                Operation::IfLess(four) => {
                    let [a, b, then, otherwise] = four.map(of);
                    let mut value = otherwise;
                    for lane in 0..W {
                        value[lane] = if a[lane] < b[lane] { then[lane] } else { otherwise[lane] };
                    }
                    value
                }
            }
        };
        values[step.to as usize] = value;
    }
}

#[inline(always)]
fn back_steps<const W: usize>(steps: &[Step], values: &[[f64; W]], worth: &mut [[f64; W]]) {
    let value = |place: Place| values[place as usize];
    for step in steps.iter().rev() {
        let of = std::mem::replace(&mut worth[step.to as usize], [0.0; W]);
        let mut more = |place: Place, by: [f64; W]| {
            let place = &mut worth[place as usize];
            *place = each(*place, by, |worth, by| worth + by);
        };
        match step.operation {
            Operation::Input | Operation::Constant(_) | Operation::Foreign => {}
            Operation::Add(a, b) => {
                more(a, of);
                more(b, of);
            }
            Operation::Subtract(a, b) => {
                more(a, of);
                more(b, of.map(|of| -of));
            }
            Operation::Multiply(a, b) => {
                more(a, each(of, value(b), times));
                more(b, each(of, value(a), times));
            }
            Operation::Divide(a, b) => {
                let up = each(of, value(b), |of, divisor| of / divisor);
                more(a, up);
                more(b, each(up, value(step.to), |up, quotient| -(up * quotient)));
            }
            Operation::Negative(a) => more(a, of.map(|of| -of)),
            Operation::Magnitude(a) => {
                more(a, each(value(a), of, |a, of| if a < 0.0 { -of } else { of }));
            }
            Operation::IfLess([a, b, then, otherwise]) => {
                let (a, b) = (value(a), value(b));
                let (mut less, mut not_less) = (of, of);
                for lane in 0..W {
                    let is_less = a[lane] < b[lane];
                    less[lane] = if is_less { of[lane] } else { 0.0 };
                    not_less[lane] = if is_less { 0.0 } else { of[lane] };
                }
                more(then, less);
                more(otherwise, not_less);
            }
        }
    }
}

/// A function of two numbers in each lane. The numbers are copied, so that nothing they come from can change beneath them:
/// then a compiler makes vectors of them.
#[inline(always)]
fn each<const W: usize>(a: [f64; W], b: [f64; W], of: impl Fn(f64, f64) -> f64) -> [f64; W] {
    let mut value = [0.0; W];
    for lane in 0..W {
        value[lane] = of(a[lane], b[lane]);
    }
    value
}

#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    a * b
}

fn operands(operation: &Operation) -> impl Iterator<Item = Place> {
    let (operands, count) = match *operation {
        Operation::Input | Operation::Constant(_) | Operation::Foreign => ([0; 4], 0),
        Operation::Negative(a) | Operation::Magnitude(a) => ([a, 0, 0, 0], 1),
        Operation::Add(a, b)
        | Operation::Subtract(a, b)
        | Operation::Multiply(a, b)
        | Operation::Divide(a, b) => ([a, b, 0, 0], 2),
        Operation::IfLess(four) => (four, 4),
    };
    operands.into_iter().take(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (a b + |a - c|) / (1 + b b), or c where a is less than 0; then the same twice.
    fn equation<S: Scalar>([a, b, c]: [S; 3]) -> S {
        let quotient = (a * b + (a - c).abs()) / (S::one() + b.square());
        a.if_less(S::zero(), c, quotient) + S::half() * quotient
    }

    #[test]
    fn backwards_it_has_the_derivatives_that_dual_numbers_have() {
        use fspid_numeric::scalar::Dual;
        let program = Program::record([2, 3], |it| vec![equation([it[0], it[1], it[2]])]);
        let points = [[0.3, -1.2, 2.0], [-0.3, 0.4, -1.0], [1.5, 0.0, 0.2], [2.0, 3.0, 2.5]];
        let (mut values, mut worth) = (program.room::<4>(), program.room::<4>());
        let inputs: Vec<[f64; 4]> = (0..3).map(|input| points.map(|point| point[input])).collect();
        program.put(&mut values, 0, &inputs);
        program.run_still(&mut values);
        program.run(&mut values);
        program.credit(&mut worth, 0, &[1.0; 4]);
        program.back(&values, &mut worth);
        program.back_still(&values, &mut worth);
        let found: Vec<[f64; 4]> = (0..3).map(|input| program.take(&mut worth, input)).collect();
        for (lane, point) in points.into_iter().enumerate() {
            let expected = equation(Dual::variables(point));
            assert!((program.output(&values, 0)[lane] - expected.value).abs() < 1e-15);
            for input in 0..3 {
                let off = found[input][lane] - expected.derivative[input];
                assert!(off.abs() < 1e-14, "{lane} {input} {off}");
            }
        }
    }
}
