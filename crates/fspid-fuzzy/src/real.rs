//! The two number types a controller can be built for.

use core::fmt::Display;
use core::ops::AddAssign;

use crate::scalar::Scalar;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
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
    ($float:ident) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const MIN_POSITIVE: Self = $float::MIN_POSITIVE;

            #[allow(
                clippy::cast_possible_truncation,
                reason = "rounding to the nearest f32 is what is meant"
            )]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

real!(f32);
real!(f64);
