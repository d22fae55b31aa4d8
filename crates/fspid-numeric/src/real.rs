//! The two number types a controller can be built for, and numbers of one side by side: each of the two traits is written
//! with the other.

use core::fmt::Display;
use core::ops::{Add, AddAssign, Div, Mul, Sub};

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

/// Some numbers, each operation done to every one of them by itself.
///
/// A lane never sees another, so its bits do not depend on how many there are or on what is in
/// them. Comparisons are those of [`Real`], but for a NaN, which no inference meets.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// What is in a lane.
    type Number: Real;

    /// `value` in as many lanes as `self` has.
    fn same(self, value: Self::Number) -> Self;
    /// The smaller numbers.
    fn smaller(self, other: Self) -> Self;
    /// The larger numbers.
    fn larger(self, other: Self) -> Self;
    /// $2^k$ for whole `k`; see `Sealed::power_of_two`.
    fn power_of_two(self) -> Self;
    /// $2^k$ times the numbers; see `Sealed::raised`.
    fn raised(self, shifted: Self) -> Self;
    /// A function of plain numbers in each lane by itself, for what cannot be done side by side.
    fn lane_by_lane(
        numbers: &[Self],
        zero: Self,
        function: impl Fn(&[Self::Number]) -> Self::Number,
    ) -> Self;
}
