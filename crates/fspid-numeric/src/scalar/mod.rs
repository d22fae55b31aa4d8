//! Numbers that an equation can be asked with: plain floats, derivatives, intervals.
//!
//! Each equation of a fuzzy system (a membership function, a norm, a formula) is written once,
//! generic over [`Scalar`]. Asked with `f64` it answers the value; with a dual number the value and
//! its exact derivatives; with an interval everything that the value can be over a range of inputs.
//!
//! To make that possible an equation chooses between cases only by [`smaller`](Scalar::smaller),
//! [`larger`](Scalar::larger), [`abs`](Scalar::abs) and [`if_less`](Scalar::if_less), never by `if`.

mod base;
mod dual;
mod interval;
mod jet;

pub use base::Base;
pub use dual::Dual;
pub use interval::Interval;
pub use jet::Jet;

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number with the operations that equations may use.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest number of this type, without derivatives and without width.
    fn constant(value: f64) -> Self;

    /// Plain numbers as numbers of this type, written into `room`, which must be long enough; plain
    /// numbers themselves stay where they are.
    #[must_use]
    fn lift<'a>(values: &'a [f64], room: &'a mut [Self]) -> &'a [Self] {
        for (place, &value) in room.iter_mut().zip(values) {
            *place = Self::constant(value);
        }
        room.get(..values.len()).unwrap_or_default()
    }

    /// Zero.
    #[must_use]
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    /// One.
    #[must_use]
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }

    /// One half.
    #[must_use]
    #[inline(always)]
    fn half() -> Self {
        Self::constant(0.5)
    }

    /// The smaller of two numbers; the second if either is NaN.
    #[must_use]
    fn smaller(self, other: Self) -> Self;
    /// The larger of two numbers; the second if either is NaN.
    #[must_use]
    fn larger(self, other: Self) -> Self;
    /// Magnitude.
    #[must_use]
    fn abs(self) -> Self;
    /// `then` where `self < bound`, else `otherwise`; of an interval that holds both cases, the
    /// hull of the two.
    #[must_use]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// The number moved into `[0, 1]`.
    #[must_use]
    fn unit(self) -> Self {
        self.larger(Self::zero()).smaller(Self::one())
    }

    /// The square.
    #[must_use]
    fn square(self) -> Self {
        self * self
    }

    /// $e^x$.
    #[must_use]
    fn exp(self) -> Self;
    /// $\ln x$.
    #[must_use]
    fn ln(self) -> Self;
    /// $\sqrt x$.
    #[must_use]
    fn sqrt(self) -> Self;
    /// $x^p$.
    #[must_use]
    fn pow(self, power: Self) -> Self;
    /// $\sin x$.
    #[must_use]
    fn sin(self) -> Self;
    /// $\cos x$.
    #[must_use]
    fn cos(self) -> Self;
    /// $\tan x$.
    #[must_use]
    fn tan(self) -> Self;
    /// $\arcsin x$.
    #[must_use]
    fn asin(self) -> Self;
    /// $\arccos x$.
    #[must_use]
    fn acos(self) -> Self;
    /// $\arctan x$.
    #[must_use]
    fn atan(self) -> Self;
    /// $\sinh x$.
    #[must_use]
    fn sinh(self) -> Self;
    /// $\cosh x$.
    #[must_use]
    fn cosh(self) -> Self;
    /// $\tanh x$.
    #[must_use]
    fn tanh(self) -> Self;
    /// The largest whole number not above.
    #[must_use]
    fn floor(self) -> Self;

    /// The smallest whole number not below.
    #[must_use]
    fn ceil(self) -> Self {
        -(-self).floor()
    }

    /// The whole number next towards 0.
    #[must_use]
    fn trunc(self) -> Self {
        self.if_less(Self::zero(), self.ceil(), self.floor())
    }

    /// The nearest whole number; halves go away from 0.
    #[must_use]
    fn round(self) -> Self {
        let magnitude = self.abs();
        let below = magnitude.floor();
        let rest = magnitude - below;
        let nearest = rest.if_less(Self::half(), below, below + Self::one());
        self.if_less(Self::zero(), -nearest, nearest)
    }

    /// -1, 0 or 1.
    #[must_use]
    fn sign(self) -> Self {
        let positive = Self::zero().if_less(self, Self::one(), Self::zero());
        self.if_less(Self::zero(), -Self::one(), positive)
    }

    /// $a - b \operatorname{trunc}\frac ab$, with the sign of $a$.
    #[must_use]
    fn remainder(self, divisor: Self) -> Self {
        self - divisor * (self / divisor).trunc()
    }

    /// $\log_{10} x$.
    #[must_use]
    fn log10(self) -> Self {
        self.ln() / Self::constant(core::f64::consts::LN_10)
    }

    /// $\ln(1 + x)$, without special care for small $x$.
    #[must_use]
    fn ln_1p(self) -> Self {
        (Self::one() + self).ln()
    }

    /// $\operatorname{arsinh} x$.
    #[must_use]
    fn asinh(self) -> Self {
        let magnitude = self.abs();
        let value = (magnitude + (self.square() + Self::one()).sqrt()).ln();
        self.if_less(Self::zero(), -value, value)
    }

    /// $\operatorname{arcosh} x$.
    #[must_use]
    fn acosh(self) -> Self {
        (self + (self.square() - Self::one()).sqrt()).ln()
    }

    /// $\operatorname{artanh} x$.
    #[must_use]
    fn atanh(self) -> Self {
        Self::half() * ((Self::one() + self) / (Self::one() - self)).ln()
    }

    /// The angle of the point $(x, y)$ with `self` as $y$, in $(-\pi, \pi]$; 0 at the origin.
    #[must_use]
    fn atan2(self, x: Self) -> Self {
        let pi = Self::constant(core::f64::consts::PI);
        let angle = (self / x).atan();
        let left = angle + self.if_less(Self::zero(), -pi, pi);
        let upright = Self::half() * pi * self.sign();
        x.if_less(Self::zero(), left, Self::zero().if_less(x, angle, upright))
    }

    /// 1 if the number is not 0, else 0; what formulas mean by true.
    #[must_use]
    fn truth(self) -> Self {
        let positive = Self::zero().if_less(self, Self::one(), Self::zero());
        self.if_less(Self::zero(), Self::one(), positive)
    }
}
