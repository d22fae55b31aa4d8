//! Numbers side by side, so that each equation of an inference stands once for all widths.

use core::ops::{Add, Div, Mul, Sub};

use crate::real::Real;
use crate::real::sealed::Sealed as _;

pub use crate::real::Lanes;

/// $e^x$ in each lane, as every inference has it.
#[must_use]
pub fn exp<L: Lanes>(x: L) -> L {
    L::Number::exp_of(x)
}

/// Most numbers that [`Lanes::lane_by_lane`] takes.
pub const MOST_LANES_ROWS: usize = 64;

/// A function of one lane's numbers; of those beyond the sixty-fourth it takes no notice.
pub fn of_lane<N: Real, L: Copy>(
    numbers: &[L],
    lane: impl Fn(L) -> N,
    function: impl Fn(&[N]) -> N,
) -> N {
    let mut plain = [N::ZERO; MOST_LANES_ROWS];
    for (place, &number) in plain.iter_mut().zip(numbers) {
        *place = lane(number);
    }
    function(plain.get(..numbers.len()).unwrap_or(&plain))
}

/// One number.
#[derive(Clone, Copy, Debug)]
pub struct One<R>(pub R);

/// Two numbers; a compiler makes a vector of them where it can.
#[derive(Clone, Copy, Debug)]
pub struct Two<R>(pub R, pub R);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<R: Real> $trait for One<R> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl<R: Real> $trait for Two<R> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<R: Real> Lanes for One<R> {
    type Number = R;

    #[inline(always)]
    fn same(self, value: R) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self(self.0.smaller(other.0))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.larger(other.0))
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self(self.0.power_of_two())
    }

    #[inline(always)]
    fn raised(self, shifted: Self) -> Self {
        Self(self.0.raised(shifted.0))
    }

    fn lane_by_lane(numbers: &[Self], _: Self, function: impl Fn(&[R]) -> R) -> Self {
        Self(of_lane(numbers, |number| number.0, &function))
    }
}

impl<R: Real> Lanes for Two<R> {
    type Number = R;

    #[inline(always)]
    fn same(self, value: R) -> Self {
        Self(value, value)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self(self.0.smaller(other.0), self.1.smaller(other.1))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.larger(other.0), self.1.larger(other.1))
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self(self.0.power_of_two(), self.1.power_of_two())
    }

    #[inline(always)]
    fn raised(self, shifted: Self) -> Self {
        Self(self.0.raised(shifted.0), self.1.raised(shifted.1))
    }

    fn lane_by_lane(numbers: &[Self], _: Self, function: impl Fn(&[R]) -> R) -> Self {
        let first = of_lane(numbers, |number| number.0, &function);
        Self(first, of_lane(numbers, |number| number.1, &function))
    }
}
