//! Dual numbers: a value and its exact derivatives with respect to `N` inputs.
//!
//! Each operation carries the derivatives along by the chain rule (forward mode), so they are exact
//! to rounding: no step width, no cancellation. Over [`Interval`](crate::scalar::Interval) they
//! enclose the derivatives at all inputs inside.
//!
//! # Kinks
//! Where two cases of `min`, `max`, `abs` or `if_less` meet there is no derivative. Over floats it
//! is that of the case which gives the value. Over intervals that hold both cases it is the hull of
//! the two: an enclosure $D$ of Clarke's generalised gradient, which is what the mean value theorem
//! needs. If the function is continuous, for any two points of the box
//!
//! $$ f(y) - f(x) \in D \cdot (y - x) $$
//!
//! Where a kink only touches the face of a box, the derivative of the side inside counts. A jump (of
//! `floor`, of `if_less` between cases that do not meet) does not show in a derivative.
//!
//! # Infinite slopes
//! $\sqrt x$ at 0 and the like have an infinite slope; an input on which they do not depend still
//! has the derivative 0, not NaN. So $|x|^p$ with $p > 1$ has the derivative 0 at $x = 0$ with
//! respect to both $x$ and $p$.
//!
//! # Source
//! Griewank and Walther, *Evaluating Derivatives*, SIAM 2008, chapter 3; F. H. Clarke, *Optimization
//! and Nonsmooth Analysis*, 1983, proposition 2.3.12 and theorem 2.3.7 (the mean value theorem).

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::scalar::{Base, Scalar};

/// A little below $-1/e$, the least value of $y \ln y$.
const LEAST_Y_LN_Y: f64 = -0.367_879_441_171_442_5;

/// A value and its derivatives with respect to `N` inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S, const N: usize> {
    /// The value.
    pub value: S,
    /// The derivative with respect to each input.
    pub derivative: [S; N],
}

impl<S: Base, const N: usize> Dual<S, N> {
    /// The input with that index.
    #[must_use]
    pub fn variable(value: S, index: usize) -> Self {
        let derivative = from_fn(|input| if input == index { S::one() } else { S::zero() });
        Self { value, derivative }
    }

    /// All inputs.
    #[must_use]
    pub fn variables(values: [S; N]) -> [Self; N] {
        from_fn(|index| Self::variable(values[index], index))
    }

    /// A number that depends on no input.
    #[must_use]
    pub fn fixed(value: S) -> Self {
        Self { value, derivative: [S::zero(); N] }
    }

    /// `value` with derivatives from those of two operands.
    #[inline]
    fn join(self, other: Self, value: S, each: impl Fn(S, S) -> S) -> Self {
        let derivative = from_fn(|index| each(self.derivative[index], other.derivative[index]));
        Self { value, derivative }
    }

    /// A function of this number with that value and that slope.
    #[inline]
    fn chain(self, value: S, slope: S) -> Self {
        Self { value, derivative: self.derivative.map(|derivative| derivative.scaled(slope)) }
    }

    /// `value` with the derivatives of `then` where `self < bound`, else of `otherwise`.
    #[inline]
    fn pick(self, bound: Self, value: S, then: Self, otherwise: Self) -> Self {
        let (left, right) = (self.value, bound.value);
        then.join(otherwise, value, |then, otherwise| left.choose(right, then, otherwise))
    }

    /// The slope of a power with respect to its exponent, $x^p \ln x$, which is at least
    /// $-1 / (e p)$ for $p > 0$; zero where the power is.
    fn power_slope(base: S, power: S, value: S) -> S {
        let slope = value.scaled(base.ln());
        let bounded = slope.larger(S::constant(LEAST_Y_LN_Y) / power);
        S::zero().if_less(power, bounded, slope)
    }
}

impl<S: Base, const N: usize> Neg for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: self.derivative.map(|derivative| -derivative) }
    }
}

impl<S: Base, const N: usize> Add for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.join(other, self.value + other.value, |left, right| left + right)
    }
}

impl<S: Base, const N: usize> Sub for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.join(other, self.value - other.value, |left, right| left - right)
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
impl<S: Base, const N: usize> Mul for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        self.join(other, a * b, |left, right| left.scaled(b) + right.scaled(a))
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule")]
impl<S: Base, const N: usize> Div for Dual<S, N> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let (quotient, divisor) = (self.value / other.value, other.value);
        self.join(other, quotient, |left, right| {
            let change = left - right.scaled(quotient);
            if change.is_zero() { change } else { change / divisor }
        })
    }
}

/// Duals of duals carry second derivatives along: of $f$ asked with variables of both kinds, the derivative with
/// respect to input j of the derivative with respect to input i is $\partial_i \partial_j f$.
impl<S: Base, const N: usize> Base for Dual<S, N> {
    #[inline]
    fn is_less(self, bound: Self) -> Option<bool> {
        self.value.is_less(bound.value)
    }

    #[inline]
    fn choose(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let (left, right) = (self.value, bound.value);
        let value = left.choose(right, then.value, otherwise.value);
        then.join(otherwise, value, |then, otherwise| left.choose(right, then, otherwise))
    }

    #[inline]
    fn scaled(self, factor: Self) -> Self {
        if self.is_zero() { self } else { self * factor }
    }

    fn unknown() -> Self {
        Self { value: S::unknown(), derivative: [S::unknown(); N] }
    }

    fn is_zero(self) -> bool {
        self.value.is_zero() && self.derivative.iter().all(|it| it.is_zero())
    }

    fn whole(self) -> Option<i32> {
        let is_fixed = self.derivative.iter().all(|it| it.is_zero());
        self.value.whole().filter(|_| is_fixed)
    }
}

impl<S: Base, const N: usize> Scalar for Dual<S, N> {
    #[inline]
    fn constant(value: f64) -> Self {
        Self::fixed(S::constant(value))
    }

    #[inline]
    fn smaller(self, other: Self) -> Self {
        self.pick(other, self.value.smaller(other.value), self, other)
    }

    #[inline]
    fn larger(self, other: Self) -> Self {
        other.pick(self, self.value.larger(other.value), self, other)
    }

    #[inline]
    fn abs(self) -> Self {
        self.pick(Self::zero(), self.value.abs(), -self, self)
    }

    #[inline]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let value = self.value.if_less(bound.value, then.value, otherwise.value);
        self.pick(bound, value, then, otherwise)
    }

    #[inline]
    fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::one() / self.value)
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::half() / root)
    }

    fn pow(self, power: Self) -> Self {
        let (base, exponent) = (self.value, power.value);
        let value = base.pow(exponent);
        let in_base = exponent.scaled(base.pow(exponent - S::one()));
        let in_power = Self::power_slope(base, exponent, value);
        self.join(power, value, |left, right| left.scaled(in_base) + right.scaled(in_power))
    }

    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }

    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }

    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.chain(tangent, S::one() + tangent.square())
    }

    fn asin(self) -> Self {
        self.chain(self.value.asin(), S::one() / (S::one() - self.value.square()).sqrt())
    }

    fn acos(self) -> Self {
        self.chain(self.value.acos(), -(S::one() / (S::one() - self.value.square()).sqrt()))
    }

    fn atan(self) -> Self {
        self.chain(self.value.atan(), S::one() / (S::one() + self.value.square()))
    }

    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    fn tanh(self) -> Self {
        self.chain(self.value.tanh(), S::one() / self.value.cosh().square())
    }

    fn floor(self) -> Self {
        Self::fixed(self.value.floor())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// $f = x^2 \sin y$: all second derivatives at once, against what is known of them.
    #[test]
    fn duals_of_duals_have_second_derivatives() {
        let (x, y) = (1.5_f64, 0.4_f64);
        let inner = Dual::<f64, 2>::variables([x, y]);
        let [x2, y2] = Dual::<Dual<f64, 2>, 2>::variables(inner);
        let f = x2.square() * y2.sin();
        let second = |i: usize, j: usize| f.derivative[i].derivative[j];
        let expected = [
            [2.0 * libm::sin(y), 2.0 * x * libm::cos(y)],
            [2.0 * x * libm::cos(y), -x * x * libm::sin(y)],
        ];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert!((second(i, j) - value).abs() < 1e-14, "{i} {j}");
            }
        }
    }
}
