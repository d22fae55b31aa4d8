//! What derivatives are made of.

use crate::scalar::Scalar;

/// Powers beyond this are not told to be whole.
const MAX_WHOLE: f64 = 1e9;

/// A number that can be the value and the slopes of a [`Dual`](crate::scalar::Dual): a float or an
/// [`Interval`](crate::scalar::Interval).
pub trait Base: Scalar {
    /// Whether `self < bound`: `None` where an interval holds both cases.
    fn is_less(self, bound: Self) -> Option<bool>;

    /// A slope for the case that [`if_less`](Scalar::if_less) takes. Unlike there, an interval hull of
    /// both answers also where two single numbers tie: a kink has the slopes of both sides.
    #[must_use]
    fn choose(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// The product, which is zero if `self` is zero: an infinite slope met by no change.
    #[must_use]
    fn scaled(self, factor: Self) -> Self;

    /// A number of which nothing is known: NaN, or everything.
    fn unknown() -> Self;

    /// True for zero without width.
    fn is_zero(self) -> bool;

    /// The whole number that this is, without width and small enough.
    fn whole(self) -> Option<i32>;
}

macro_rules! float {
    ($float:ident) => {
        impl Base for $float {
            #[inline]
            fn is_less(self, bound: Self) -> Option<bool> {
                Some(self < bound)
            }

            #[inline]
            fn choose(self, bound: Self, then: Self, otherwise: Self) -> Self {
                self.if_less(bound, then, otherwise)
            }

            #[inline]
            fn scaled(self, factor: Self) -> Self {
                if self.is_zero() { self } else { self * factor }
            }

            fn unknown() -> Self {
                $float::NAN
            }

            #[inline]
            fn is_zero(self) -> bool {
                self == 0.0
            }

            #[allow(clippy::cast_possible_truncation, reason = "whole and small")]
            fn whole(self) -> Option<i32> {
                let value = f64::from(self);
                let whole = libm::floor(value) >= value && value.abs() <= MAX_WHOLE;
                whole.then_some(value as i32)
            }
        }
    };
}

float!(f32);
float!(f64);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_change_met_by_an_infinite_slope_stays_no_change() {
        assert_eq!(0.0_f64.scaled(f64::INFINITY), 0.0);
        assert_eq!(2.0_f64.scaled(f64::INFINITY), f64::INFINITY);
    }

    #[test]
    fn whole_numbers_are_told_from_others() {
        assert_eq!(
            [-3.0, 0.0, 2.5, 1e10, f64::NAN].map(f64::whole),
            [Some(-3), Some(0), None, None, None]
        );
    }
}
