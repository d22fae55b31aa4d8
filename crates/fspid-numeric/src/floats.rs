//! `f32` and `f64` as numbers of equations and of controllers.

use crate::exp;
use crate::real::{Lanes, Real, sealed};
use crate::scalar::Scalar;

macro_rules! float {
    ($float:ident, [$($lift:item)?], $exp:path, $ln:path, $sqrt:path, $pow:path, $sin:path, $cos:path, $tan:path,
     $asin:path, $acos:path, $atan:path, $sinh:path, $cosh:path, $tanh:path, $floor:path) => {
        impl Scalar for $float {
            #[allow(
                clippy::cast_possible_truncation,
                reason = "rounding to the nearest f32 is what is meant"
            )]
            #[inline(always)]
            fn constant(value: f64) -> Self {
                value as $float
            }
            $(#[inline] $lift)?
            #[inline(always)]
            fn smaller(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
                if self < bound { then } else { otherwise }
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            fn ln(self) -> Self {
                $ln(self)
            }
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            fn pow(self, power: Self) -> Self {
                $pow(self, power)
            }
            fn sin(self) -> Self {
                $sin(self)
            }
            fn cos(self) -> Self {
                $cos(self)
            }
            fn tan(self) -> Self {
                $tan(self)
            }
            fn asin(self) -> Self {
                $asin(self)
            }
            fn acos(self) -> Self {
                $acos(self)
            }
            fn atan(self) -> Self {
                $atan(self)
            }
            fn sinh(self) -> Self {
                $sinh(self)
            }
            fn cosh(self) -> Self {
                $cosh(self)
            }
            fn tanh(self) -> Self {
                $tanh(self)
            }
            fn floor(self) -> Self {
                $floor(self)
            }
        }
    };
}

float!(
    f64,
    [fn lift<'a>(values: &'a [f64], _: &'a mut [Self]) -> &'a [Self] {
        values
    }],
    exp::exp_one_f64,
    libm::log,
    libm::sqrt,
    libm::pow,
    libm::sin,
    libm::cos,
    libm::tan,
    libm::asin,
    libm::acos,
    libm::atan,
    libm::sinh,
    libm::cosh,
    libm::tanh,
    libm::floor
);
float!(
    f32,
    [],
    exp::exp_one_f32,
    libm::logf,
    libm::sqrtf,
    libm::powf,
    libm::sinf,
    libm::cosf,
    libm::tanf,
    libm::asinf,
    libm::acosf,
    libm::atanf,
    libm::sinhf,
    libm::coshf,
    libm::tanhf,
    libm::floorf
);

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
