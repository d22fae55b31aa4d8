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

/// An operation, by the places of its operands, which stand before it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Input,
    Constant(f64),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Negative(usize),
    Magnitude(usize),
    /// The third where the first is less than the second, else the fourth.
    IfLess([usize; 4]),
    /// No controller's equation asks for it; it answers NaN.
    Foreign,
}

thread_local! {
    static RECORD: RefCell<Vec<Operation>> = const { RefCell::new(Vec::new()) };
}

/// A number that records what is done with it: the place of its operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Recorded(usize);

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
        Recorded(place)
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

/// A list of operations from inputs to outputs.
#[derive(Clone, Debug)]
pub(super) struct Program {
    operations: Vec<Operation>,
    inputs: Vec<usize>,
    outputs: Vec<usize>,
    /// Operations that depend on inputs that stand still alone, and those that are left, each in order.
    still: Vec<usize>,
    moving: Vec<usize>,
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
        let outputs: Vec<usize> = equation(&given).iter().map(|output| output.0).collect();
        let operations = RECORD.with_borrow_mut(std::mem::take);
        let inputs: Vec<usize> = given.iter().map(|input| input.0).collect();
        let (mut moves, mut needed) =
            (vec![false; operations.len()], vec![false; operations.len()]);
        for (place, operation) in operations.iter().enumerate() {
            moves[place] = match operation {
                Operation::Input => place < moving,
                other => operands(other).any(|operand| moves[operand]),
            };
        }
        outputs.iter().for_each(|&output| needed[output] = true);
        for (place, operation) in operations.iter().enumerate().rev() {
            if needed[place] {
                operands(operation).for_each(|operand| needed[operand] = true);
            }
        }
        let of = |wanted: bool| {
            let places = (0..operations.len()).filter(|&place| {
                needed[place] && moves[place] == wanted && operations[place] != Operation::Input
            });
            places.collect()
        };
        let (still, moving) = (of(false), of(true));
        Self { inputs, outputs, still, moving, operations }
    }

    /// Room for the values of all operations.
    pub(super) fn room<const W: usize>(&self) -> Vec<[f64; W]> {
        vec![[0.0; W]; self.operations.len()]
    }

    /// Puts inputs from a place on.
    #[inline(always)]
    pub(super) fn put<const W: usize>(
        &self,
        values: &mut [[f64; W]],
        from: usize,
        inputs: &[[f64; W]],
    ) {
        for (place, input) in self.inputs.iter().skip(from).zip(inputs) {
            values[*place] = *input;
        }
    }

    /// An output.
    #[inline(always)]
    pub(super) fn output<const W: usize>(&self, values: &[[f64; W]], output: usize) -> [f64; W] {
        values[self.outputs[output]]
    }

    /// Adds what an output is worth.
    #[inline(always)]
    pub(super) fn credit<const W: usize>(
        &self,
        worth: &mut [[f64; W]],
        output: usize,
        by: &[f64; W],
    ) {
        let place = &mut worth[self.outputs[output]];
        for lane in 0..W {
            place[lane] += by[lane];
        }
    }

    /// What an input is worth, which is forgotten.
    #[inline(always)]
    pub(super) fn take<const W: usize>(&self, worth: &mut [[f64; W]], input: usize) -> [f64; W] {
        std::mem::replace(&mut worth[self.inputs[input]], [0.0; W])
    }

    /// Computes what depends on inputs that stand still alone.
    pub(super) fn run_still<const W: usize>(&self, values: &mut [[f64; W]]) {
        self.run_places(&self.still, values);
    }

    /// Computes the rest.
    #[inline(always)]
    pub(super) fn run<const W: usize>(&self, values: &mut [[f64; W]]) {
        self.run_places(&self.moving, values);
    }

    /// Hands what the outputs are worth to the inputs, and to what stands still, whose sums grow on.
    #[inline(always)]
    pub(super) fn back<const W: usize>(&self, values: &[[f64; W]], worth: &mut [[f64; W]]) {
        self.back_places(&self.moving, values, worth);
    }

    /// Hands the sums of what stands still to the inputs, once for a flight.
    pub(super) fn back_still<const W: usize>(&self, values: &[[f64; W]], worth: &mut [[f64; W]]) {
        self.back_places(&self.still, values, worth);
    }

    #[inline(always)]
    fn run_places<const W: usize>(&self, places: &[usize], values: &mut [[f64; W]]) {
        for &place in places {
            let value = match self.operations[place] {
                Operation::Input => continue,
                Operation::Constant(constant) => [constant; W],
                Operation::Foreign => [f64::NAN; W],
                Operation::Add(a, b) => each(&values[a], &values[b], |a, b| a + b),
                Operation::Subtract(a, b) => each(&values[a], &values[b], |a, b| a - b),
                Operation::Multiply(a, b) => each(&values[a], &values[b], |a, b| a * b),
                Operation::Divide(a, b) => each(&values[a], &values[b], |a, b| a / b),
                Operation::Negative(a) => values[a].map(|a| -a),
                Operation::Magnitude(a) => values[a].map(f64::abs),
                Operation::IfLess(four) => {
                    let [a, b, then, otherwise] = four.map(|operand| &values[operand]);
                    let mut value = *otherwise;
                    for lane in 0..W {
                        let is_less = a[lane] < b[lane];
                        value[lane] = if is_less { then[lane] } else { otherwise[lane] };
                    }
                    value
                }
            };
            values[place] = value;
        }
    }

    #[inline(always)]
    fn back_places<const W: usize>(
        &self,
        places: &[usize],
        values: &[[f64; W]],
        worth: &mut [[f64; W]],
    ) {
        for &place in places.iter().rev() {
            let of = std::mem::replace(&mut worth[place], [0.0; W]);
            match self.operations[place] {
                Operation::Input | Operation::Constant(_) | Operation::Foreign => {}
                Operation::Add(a, b) => {
                    add(&mut worth[a], &of);
                    add(&mut worth[b], &of);
                }
                Operation::Subtract(a, b) => {
                    add(&mut worth[a], &of);
                    subtract(&mut worth[b], &of);
                }
                Operation::Multiply(a, b) => {
                    add_product(&mut worth[a], &of, &values[b]);
                    add_product(&mut worth[b], &of, &values[a]);
                }
                Operation::Divide(a, b) => {
                    let up = each(&of, &values[b], |of, divisor| of / divisor);
                    let down = each(&up, &values[place], |up, quotient| up * quotient);
                    add(&mut worth[a], &up);
                    subtract(&mut worth[b], &down);
                }
                Operation::Negative(a) => subtract(&mut worth[a], &of),
                Operation::Magnitude(a) => {
                    let signed = each(&values[a], &of, |a, of| if a < 0.0 { -of } else { of });
                    add(&mut worth[a], &signed);
                }
                Operation::IfLess([a, b, then, otherwise]) => {
                    let (a, b) = (&values[a], &values[b]);
                    let (mut less, mut not_less) = (of, of);
                    for lane in 0..W {
                        let is_less = a[lane] < b[lane];
                        less[lane] = if is_less { of[lane] } else { 0.0 };
                        not_less[lane] = if is_less { 0.0 } else { of[lane] };
                    }
                    add(&mut worth[then], &less);
                    add(&mut worth[otherwise], &not_less);
                }
            }
        }
    }
}

/// A function of two numbers in each lane.
#[inline(always)]
fn each<const W: usize>(a: &[f64; W], b: &[f64; W], of: impl Fn(f64, f64) -> f64) -> [f64; W] {
    let mut value = [0.0; W];
    for lane in 0..W {
        value[lane] = of(a[lane], b[lane]);
    }
    value
}

#[inline(always)]
fn add<const W: usize>(to: &mut [f64; W], by: &[f64; W]) {
    for lane in 0..W {
        to[lane] += by[lane];
    }
}

#[inline(always)]
fn subtract<const W: usize>(from: &mut [f64; W], by: &[f64; W]) {
    for lane in 0..W {
        from[lane] -= by[lane];
    }
}

#[inline(always)]
fn add_product<const W: usize>(to: &mut [f64; W], a: &[f64; W], b: &[f64; W]) {
    for lane in 0..W {
        to[lane] += a[lane] * b[lane];
    }
}

fn operands(operation: &Operation) -> impl Iterator<Item = usize> {
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
