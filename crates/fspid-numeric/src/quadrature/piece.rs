//! Where a function changes from one smooth piece to the next, found with floats.
//!
//! A piece is told by the cases that were taken on the way to its value. Nothing rests on what is
//! found here but speed: a panel is enclosed rigorously wherever it begins and ends.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Curve, Span};
use crate::scalar::Scalar;

/// A value and a fingerprint of the cases that led to it.
#[derive(Clone, Copy, Debug)]
struct Traced {
    value: f64,
    piece: u64,
}

/// Two fingerprints to one, told apart by their order.
const fn mixed(left: u64, right: u64) -> u64 {
    // The multiplier of a 64-bit linear congruential generator (Knuth, MMIX).
    left.wrapping_mul(6_364_136_223_846_793_005).rotate_left(31) ^ right
}

impl Traced {
    /// A new value on this piece.
    const fn to(self, value: f64) -> Self {
        Self { value, ..self }
    }

    /// This value, remembering that it was case `number` of a choice.
    const fn chosen(self, number: u64) -> Self {
        Self { piece: mixed(self.piece, number), ..self }
    }

    /// A value of two operands.
    const fn join(self, other: Self, value: f64) -> Self {
        let piece = if other.piece == 0 { self.piece } else { mixed(other.piece, self.piece) };
        Self { value, piece }
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Traced {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.join(other, self.value.$method(other.value))
            }
        }
    )*};
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        self.to(-self.value)
    }
}

macro_rules! functions {
    ($($method:ident),*) => {$(
        fn $method(self) -> Self {
            self.to(Scalar::$method(self.value))
        }
    )*};
}

impl Scalar for Traced {
    fn constant(value: f64) -> Self {
        Self { value, piece: 0 }
    }

    fn smaller(self, other: Self) -> Self {
        if self.value < other.value { self.chosen(1) } else { other.chosen(2) }
    }

    fn larger(self, other: Self) -> Self {
        if self.value > other.value { self.chosen(1) } else { other.chosen(2) }
    }

    fn abs(self) -> Self {
        if self.value < 0.0 { (-self).chosen(1) } else { self.chosen(2) }
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value < bound.value { then.chosen(1) } else { otherwise.chosen(2) }
    }

    fn pow(self, power: Self) -> Self {
        self.join(power, self.value.pow(power.value))
    }

    fn floor(self) -> Self {
        let floor = libm::floor(self.value);
        self.to(floor).chosen(floor.to_bits())
    }

    functions!(exp, ln, sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh);
}

/// Where a panel is asked for its piece, as shares of its width.
const PROBES: [f64; 5] = [1e-6, 0.25, 0.5, 0.75, 1.0 - 1e-6];
/// Halvings until a change is located.
const HALVINGS: u32 = 30;
/// How far the panel around a located change reaches on either side, as a share of the whole.
const MARGIN: f64 = 3e-9;

/// A short part of the span in which the function changes to another piece, if some change was seen.
pub(super) fn change<C: Curve>(curve: &C, span: Span) -> Option<[f64; 2]> {
    let piece = |x: f64| curve.at(Traced { value: x, piece: 0 }).piece;
    let seen = PROBES.map(|share| {
        let x = span.lower + share * (span.upper - span.lower);
        (x, piece(x))
    });
    let pair = seen.windows(2).find(|pair| pair[0].1 != pair[1].1)?;
    let (mut left, mut right, before) = (pair[0].0, pair[1].0, pair[0].1);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (left + right);
        if piece(middle) == before {
            left = middle;
        } else {
            right = middle;
        }
    }
    let margin = MARGIN * (span.upper - span.lower);
    Some([(left - margin).next_down().max(span.lower), (right + margin).next_up().min(span.upper)])
}
