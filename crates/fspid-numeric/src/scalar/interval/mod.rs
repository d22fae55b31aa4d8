//! Intervals: all that a value can be when its inputs are known only within bounds.
//!
//! An equation asked with intervals answers an interval that holds every value it takes for inputs
//! inside, rounding included. The answer may be wider than need be where an input occurs more than
//! once (it is then treated as if it were several inputs), never narrower.
//!
//! # What is guaranteed
//! For $x \in X$, and $y \in Y$ where there are two operands, $f(x, y) \in F(X, Y)$ for the real
//! function $f$ and for the one that `f64` computes. An argument outside of the domain (the root of
//! a negative number, a quotient by zero) has no value and adds none; if no argument is inside,
//! the answer is [`ENTIRE`](Interval::ENTIRE). An infinite bound says that there is no bound; it is
//! not a value, and $0 \cdot \infty = 0$. NaN never appears.
//!
//! # What it rests on
//! Sums, products, quotients and roots round to nearest (IEEE 754) and move outward by one float
//! unless exact. The project's own exponential is within 1 unit in the last place and moves by 3
//! floats. The functions of `libm` are assumed to be within 2 units, as measured against
//! high-precision values in `tests/data/elementary.csv`, and move by 6 floats.
//!
//! # Source
//! Moore, Kearfott and Cloud, *Introduction to Interval Analysis*, SIAM 2009; W. Tucker,
//! *Validated Numerics*, Princeton 2011.

mod arithmetic;
mod functions;

use crate::rounding;

/// The closed interval from `lower` to `upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
}

impl Interval {
    /// All real numbers: nothing is known.
    pub const ENTIRE: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// Nothing but zero.
    pub const ZERO: Self = Self { lower: 0.0, upper: 0.0 };
    /// Nothing but one.
    pub const ONE: Self = Self { lower: 1.0, upper: 1.0 };
    /// Zero to one, where grades lie.
    pub const UNIT: Self = Self { lower: 0.0, upper: 1.0 };

    /// The interval between two bounds; `None` if a bound is NaN, if they are in the wrong order, or
    /// if no real number lies between them.
    #[must_use]
    pub const fn new(lower: f64, upper: f64) -> Option<Self> {
        let holds_numbers = lower < f64::INFINITY && upper > f64::NEG_INFINITY;
        if lower <= upper && holds_numbers { Some(Self { lower, upper }) } else { None }
    }

    /// Nothing but `value`. An infinite value stands for what overflowed, NaN for anything.
    #[must_use]
    pub const fn point(value: f64) -> Self {
        let (lower, upper) = (value.min(f64::MAX), value.max(f64::MIN));
        if value.is_nan() { Self::ENTIRE } else { Self { lower, upper } }
    }

    /// The smallest interval with both numbers in it.
    #[must_use]
    pub const fn between(one: f64, other: f64) -> Self {
        Self::point(one).hull(Self::point(other))
    }

    /// The lower bound; minus infinity if there is none.
    #[must_use]
    pub const fn lower(self) -> f64 {
        self.lower
    }

    /// The upper bound; infinity if there is none.
    #[must_use]
    pub const fn upper(self) -> f64 {
        self.upper
    }

    /// The smallest interval that holds both.
    #[inline]
    #[must_use]
    pub const fn hull(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// What both hold; `None` if nothing.
    #[inline]
    #[must_use]
    pub const fn intersection(self, other: Self) -> Option<Self> {
        Self::new(self.lower.max(other.lower), self.upper.min(other.upper))
    }

    /// True if `value` lies inside or on a bound; false for NaN.
    #[inline]
    #[must_use]
    pub const fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// True if every number of `other` lies inside.
    #[inline]
    #[must_use]
    pub const fn encloses(self, other: Self) -> bool {
        self.lower <= other.lower && other.upper <= self.upper
    }

    /// True if the interval holds one number only.
    #[inline]
    #[must_use]
    pub const fn is_point(self) -> bool {
        self.lower >= self.upper
    }

    /// True if both bounds are finite.
    #[inline]
    #[must_use]
    pub const fn is_bounded(self) -> bool {
        self.lower > f64::NEG_INFINITY && self.upper < f64::INFINITY
    }

    /// Distance of the bounds, rounded up.
    #[inline]
    #[must_use]
    pub fn width(self) -> f64 {
        // Zero without a sign.
        rounding::sum_up(self.upper, -self.lower) + 0.0
    }

    /// Half the [`width`](Self::width), rounded up: no number of the interval is further from
    /// [`midpoint`](Self::midpoint), but for the rounding of the latter.
    #[inline]
    #[must_use]
    pub fn radius(self) -> f64 {
        rounding::product_up(0.5, self.width())
    }

    /// A finite number of the interval, half-way between its bounds if they are finite.
    #[must_use]
    pub const fn midpoint(self) -> f64 {
        let (lower, upper) = (self.lower.max(f64::MIN), self.upper.min(f64::MAX));
        // Halved first where the sum would overflow, last where halving would lose a digit.
        let sum = lower + upper;
        let middle = if sum.is_finite() { 0.5 * sum } else { 0.5 * lower + 0.5 * upper };
        middle.max(lower).min(upper)
    }

    /// The largest absolute value.
    #[inline]
    #[must_use]
    pub const fn magnitude(self) -> f64 {
        self.lower.abs().max(self.upper.abs())
    }

    /// The smallest absolute value.
    #[inline]
    #[must_use]
    pub const fn mignitude(self) -> f64 {
        if self.contains(0.0) { 0.0 } else { self.lower.abs().min(self.upper.abs()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_has_ordered_bounds_with_numbers_between_them() {
        assert!(Interval::new(1.0, 2.0).is_some() && Interval::new(1.0, 1.0).is_some());
        for (lower, upper) in [
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (0.0, f64::NAN),
            (f64::INFINITY, f64::INFINITY),
            (f64::NEG_INFINITY, f64::NEG_INFINITY),
        ] {
            assert_eq!(Interval::new(lower, upper), None, "{lower} {upper}");
        }
        assert_eq!(Interval::point(f64::NAN), Interval::ENTIRE);
        assert_eq!(Interval::point(f64::INFINITY), Interval::between(f64::MAX, f64::INFINITY));
    }

    #[test]
    fn intervals_are_sets() {
        let [one, two] = [Interval::between(2.0, 0.0), Interval::between(1.0, 3.0)];
        assert_eq!(one.hull(two), Interval::between(0.0, 3.0));
        assert_eq!(one.intersection(two), Interval::new(1.0, 2.0));
        assert_eq!(one.intersection(Interval::point(2.5)), None);
        assert!(one.contains(0.0) && one.contains(2.0) && !one.contains(f64::NAN));
        assert!(Interval::ENTIRE.encloses(one) && !one.encloses(two));
    }

    #[test]
    fn an_interval_tells_its_size() {
        let interval = Interval::between(-3.0, 1.0);
        assert_eq!((interval.width(), interval.radius(), interval.midpoint()), (4.0, 2.0, -1.0));
        assert_eq!((interval.magnitude(), interval.mignitude()), (3.0, 0.0));
        assert_eq!(Interval::between(-3.0, -1.0).mignitude(), 1.0);
        assert_eq!(Interval::ENTIRE.midpoint(), 0.0);
        assert_eq!(Interval::between(f64::MAX, f64::INFINITY).midpoint(), f64::MAX);
        assert_eq!(Interval::point(5e-324).midpoint(), 5e-324);
        assert_eq!(Interval::ENTIRE.width(), f64::INFINITY);
    }
}
