//! Sum, difference, product and quotient of intervals.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::Interval;
use crate::rounding::{product_down, product_up, quotient_down, quotient_up, sum_down, sum_up};

impl Neg for Interval {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { lower: -self.upper, upper: -self.lower }
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { lower: sum_down(self.lower, other.lower), upper: sum_up(self.upper, other.upper) }
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    /// By the signs of the factors only two of the four products of bounds are needed, unless both
    /// factors change sign.
    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.lower >= 0.0 {
            return other.times_positive(self);
        }
        if self.upper <= 0.0 {
            return -other.times_positive(-self);
        }
        if other.lower >= 0.0 {
            return self.times_positive(other);
        }
        if other.upper <= 0.0 {
            return -self.times_positive(-other);
        }
        let [(a, b), (c, d)] = [(self.lower, self.upper), (other.lower, other.upper)];
        Self {
            lower: product_down(a, d).min(product_down(b, c)),
            upper: product_up(a, c).max(product_up(b, d)),
        }
    }
}

impl Interval {
    /// The product with numbers that are not negative.
    #[inline]
    fn times_positive(self, factor: Self) -> Self {
        let low = if self.lower >= 0.0 { factor.lower } else { factor.upper };
        let high = if self.upper >= 0.0 { factor.upper } else { factor.lower };
        Self { lower: product_down(self.lower, low), upper: product_up(self.upper, high) }
    }

    /// The quotient by numbers above zero.
    #[inline]
    fn over_positive(self, divisor: Self) -> Self {
        let low = if self.lower >= 0.0 { divisor.upper } else { divisor.lower };
        let high = if self.upper >= 0.0 { divisor.lower } else { divisor.upper };
        Self { lower: quotient_down(self.lower, low), upper: quotient_up(self.upper, high) }
    }

    /// The quotient by numbers of which zero is the least.
    fn over_zero_and_positive(self, upper: f64) -> Self {
        if self.contains(0.0) {
            return Self::ENTIRE;
        }
        if self.lower > 0.0 {
            Self { lower: quotient_down(self.lower, upper), upper: f64::INFINITY }
        } else {
            Self { lower: f64::NEG_INFINITY, upper: quotient_up(self.upper, upper) }
        }
    }

    /// The quotient by numbers of which one is zero.
    #[cold]
    fn over_zero(self, divisor: Self) -> Self {
        if self.lower >= 0.0 && self.upper <= 0.0 && !divisor.is_point() {
            return Self::ZERO;
        }
        match (divisor.lower < 0.0, divisor.upper > 0.0) {
            (false, true) => self.over_zero_and_positive(divisor.upper),
            (true, false) => (-self).over_zero_and_positive(-divisor.lower),
            _ => Self::ENTIRE,
        }
    }
}

impl Div for Interval {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        if other.lower > 0.0 {
            self.over_positive(other)
        } else if other.upper < 0.0 {
            (-self).over_positive(-other)
        } else {
            self.over_zero(other)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn products_of_small_whole_numbers_are_exact_in_every_quadrant() {
        let bounds = [-3.0, -1.0, 0.0, 2.0, 5.0];
        let intervals =
            || bounds.iter().flat_map(|&a| bounds.iter().filter_map(move |&b| Interval::new(a, b)));
        for one in intervals() {
            for other in intervals() {
                let ends = [one.lower, one.upper].map(|a| [a * other.lower, a * other.upper]);
                let least = ends.as_flattened().iter().copied().fold(f64::INFINITY, f64::min);
                let most = ends.as_flattened().iter().copied().fold(f64::NEG_INFINITY, f64::max);
                assert_eq!(one * other, between(least, most), "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn a_quotient_by_zero_and_more_is_a_half_line() {
        let one = between(1.0, 2.0);
        assert_eq!(one / between(0.0, 4.0), between(0.25, f64::INFINITY));
        assert_eq!(one / between(-4.0, 0.0), between(f64::NEG_INFINITY, -0.25));
        assert_eq!(-one / between(0.0, 4.0), between(f64::NEG_INFINITY, -0.25));
        assert_eq!(-one / between(-4.0, -0.0), between(0.25, f64::INFINITY));
        for divisor in [between(-1.0, 1.0), Interval::ZERO] {
            assert_eq!(one / divisor, Interval::ENTIRE);
        }
        assert_eq!(Interval::UNIT / Interval::UNIT, Interval::ENTIRE);
        assert_eq!(Interval::ZERO / Interval::UNIT, Interval::ZERO);
        assert_eq!(Interval::ZERO / Interval::ZERO, Interval::ENTIRE);
    }

    #[test]
    fn a_lack_of_bounds_meets_zero_without_nan() {
        let half_line = between(1.0, f64::INFINITY);
        assert_eq!(half_line * Interval::ZERO, Interval::ZERO);
        assert_eq!(Interval::ENTIRE * Interval::ZERO, Interval::ZERO);
        assert_eq!(half_line * Interval::UNIT, between(0.0, f64::INFINITY));
        assert_eq!(half_line - half_line, Interval::ENTIRE);
        assert_eq!(half_line / half_line, between(0.0, f64::INFINITY));
        assert_eq!(Interval::ENTIRE / half_line, Interval::ENTIRE);
    }
}
