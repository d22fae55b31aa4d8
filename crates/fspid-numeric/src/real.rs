//! The two number types a controller can be built for.

use core::fmt::Display;
use core::ops::AddAssign;

use crate::exp;
use crate::lanes::Lanes;
use crate::scalar::Scalar;

pub(crate) mod sealed {
    use super::{Lanes, Real};

    /// What may be in a machine's vector.
    #[cfg(feature = "simd")]
    #[allow(unreachable_pub, reason = "as public as the trait that has it")]
    pub use fearless_simd::SimdFloatElement as Element;

    /// Anything: there are no vectors.
    #[cfg(not(feature = "simd"))]
    pub trait Element {}
    #[cfg(not(feature = "simd"))]
    impl<T> Element for T {}

    pub trait Sealed: Sized + Element {
        /// Adding and subtracting this rounds a small number to the nearest integer, which then
        /// stands in the low bits of the sum.
        const ROUND: Self;
        /// Bits below the exponent.
        const MANTISSA_BITS: u32;

        /// $e^x$ in each lane.
        fn exp_of<L: Lanes<Number = Self>>(x: L) -> L
        where
            Self: Real;

        /// [`exp_of`](Self::exp_of) for numbers from -100 to 0: the same bits, sooner.
        fn exp_inside_of<L: Lanes<Number = Self>>(x: L) -> L
        where
            Self: Real;

        /// $2^k$ for an integer `k` between the least and the greatest normal exponent.
        fn power_of_two(self) -> Self;

        /// $2^k$ times the number, by its exponent, for a `k` shifted by [`ROUND`](Self::ROUND);
        /// the number and the answer must be normal.
        fn raised(self, shifted: Self) -> Self;

        /// The vectors of an instruction set with numbers of this type.
        #[cfg(feature = "simd")]
        type Vector<S: fearless_simd::Simd>: fearless_simd::SimdFloat<S, Element = Self>;
    }
}

/// A floating-point number with only the operations that give the same bits on every platform.
///
/// Sealed: `f32` and `f64`. Deliberately absent are the platform's elementary functions, whose last
/// bits differ between systems, and the fused multiply-add, which only some machines have.
pub trait Real:
    sealed::Sealed + Scalar + Display + PartialEq + PartialOrd + AddAssign + Send + Sync + 'static
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// One half.
    const HALF: Self;
    /// The smallest positive number of full precision.
    const MIN_POSITIVE: Self;

    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The same number as `f64`; exact.
    fn to_f64(self) -> f64;
    /// True for everything but infinities and NaN.
    fn is_finite(self) -> bool;

    /// The number moved into `[lower, upper]`; NaN stays NaN.
    #[inline(always)]
    fn limited(self, lower: Self, upper: Self) -> Self {
        if self < lower {
            lower
        } else if self > upper {
            upper
        } else {
            self
        }
    }
}

macro_rules! real {
    ($float:ident, $vector:ident, $round:expr, $exp:path, $exp_inside:path) => {
        impl sealed::Sealed for $float {
            const ROUND: Self = $round;
            const MANTISSA_BITS: u32 = $float::MANTISSA_DIGITS - 1;

            #[inline(always)]
            fn exp_of<L: Lanes<Number = Self>>(x: L) -> L {
                $exp(x)
            }

            #[inline(always)]
            fn exp_inside_of<L: Lanes<Number = Self>>(x: L) -> L {
                $exp_inside(x)
            }

            #[inline(always)]
            fn power_of_two(self) -> Self {
                let one: Self = 1.0;
                one.raised(self + $round)
            }

            #[inline(always)]
            fn raised(self, shifted: Self) -> Self {
                let exponent = shifted.to_bits() << Self::MANTISSA_BITS;
                $float::from_bits(self.to_bits().wrapping_add(exponent))
            }

            #[cfg(feature = "simd")]
            type Vector<S: fearless_simd::Simd> = S::$vector;
        }

        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const MIN_POSITIVE: Self = $float::MIN_POSITIVE;

            #[allow(
                clippy::cast_possible_truncation,
                reason = "rounding to the nearest f32 is what is meant"
            )]
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

real!(f32, f32s, exp::ROUND_F32, exp::exp_f32, exp::exp_f32);
real!(f64, f64s, exp::ROUND_F64, exp::exp_f64, exp::exp_normal_f64);
