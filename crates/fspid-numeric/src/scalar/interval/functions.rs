//! Elementary functions of intervals, piece by monotone piece.

use super::Interval;
use crate::rounding::{positive_down, positive_up, root_down, root_up, steps_down, steps_up};
use crate::scalar::{Base, Scalar};

/// How far the project's exponential moves outward: its error of 1 unit in the last place at the
/// bound, and at an argument inside whose value may have units twice as large.
const EXP_STEPS: u64 = 3;
/// How far a function of `libm` moves outward, likewise; its error is taken to be at most 2 units.
const LIBM_STEPS: u64 = 6;
/// $\pi$, which lies between two neighbouring floats.
const PI: Interval =
    Interval { lower: core::f64::consts::PI, upper: core::f64::consts::PI.next_up() };
/// Where sine and cosine lie.
const SINES: Interval = Interval { lower: -1.0, upper: 1.0 };

impl Interval {
    /// The values of a function of `libm` that rises and is zero only where it is exactly zero.
    #[inline]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        let (lower, upper) = (function(self.lower), function(self.upper));
        Self { lower: steps_down(lower, LIBM_STEPS), upper: steps_up(upper, LIBM_STEPS) }
    }

    /// The part inside `range`; for values that cannot lie elsewhere.
    fn within(self, range: Self) -> Self {
        self.intersection(range).unwrap_or(range)
    }

    /// Whether an even and whether an odd whole number lies inside.
    fn parities(self) -> (bool, bool) {
        let (first, last) = (libm::ceil(self.lower), libm::floor(self.upper));
        if last - first >= 1.0 {
            return (true, true);
        }
        let (one, half) = (first <= last, 0.5 * first);
        let even = libm::floor(half) >= half;
        (one && even, one && !even)
    }

    /// Values of a sine or cosine with a largest value at the even and a least value at the odd whole
    /// numbers of `turns`.
    fn wave(self, turns: Self, function: impl Fn(f64) -> f64) -> Self {
        let (top, bottom) = turns.parities();
        if top && bottom {
            return SINES;
        }
        let ends = Self::between(function(self.lower), function(self.upper)).rising(|end| end);
        let lower = if bottom { -1.0 } else { ends.lower };
        let upper = if top { 1.0 } else { ends.upper };
        Self { lower, upper }.within(SINES)
    }

    /// Powers of numbers that are not negative. At a fixed base the power is monotone in its
    /// exponent and at a fixed exponent in its base, so its extremes lie in corners.
    fn positive_power(self, power: Self) -> Self {
        let ends = [self.lower, self.upper].map(|x| [power.lower, power.upper].map(|p| (x, p)));
        let corners = ends.as_flattened().iter().map(|&(x, p)| libm::pow(x, p));
        let (least, most) =
            corners.fold((f64::INFINITY, 0.0_f64), |(a, b), corner| (a.min(corner), b.max(corner)));
        let (lower, upper) = (positive_down(least, LIBM_STEPS), positive_up(most, LIBM_STEPS));
        let at_most_one = self.upper <= 1.0 && power.lower >= 0.0;
        Self { lower, upper: if at_most_one { upper.min(1.0) } else { upper } }
    }

    /// A whole power of any numbers.
    fn whole_power(self, power: i32) -> Self {
        match power {
            0 => Self::ONE,
            1 => self,
            2 => self.square(),
            ..0 => Self::ONE / self.whole_power(power.saturating_neg()),
            _ if power % 2 == 0 => Scalar::abs(self).positive_power(Self::point(power.into())),
            _ => self.odd_power(Self::point(power.into())),
        }
    }

    fn odd_power(self, power: Self) -> Self {
        let end = |end: f64| {
            let magnitude = Self::point(end.abs()).positive_power(power);
            if end < 0.0 { -magnitude } else { magnitude }
        };
        end(self.lower).hull(end(self.upper))
    }

    /// Powers with exponents that are not one whole number. A negative base has powers to whole
    /// exponents only, of either sign.
    fn any_power(self, power: Self) -> Self {
        let positive = self.intersection(Self { lower: 0.0, upper: f64::INFINITY });
        let positive = positive.map(|base| base.positive_power(power));
        if self.lower >= 0.0 || libm::ceil(power.lower) > power.upper {
            return positive.unwrap_or(Self::ENTIRE);
        }
        let base = Self { lower: (-self.upper).max(0.0), upper: -self.lower };
        let magnitude = base.positive_power(power).upper;
        let either = Self { lower: -magnitude, upper: magnitude };
        positive.map_or(either, |positive| positive.hull(either))
    }
}

impl Scalar for Interval {
    #[inline]
    fn constant(value: f64) -> Self {
        Self::point(value)
    }

    #[inline]
    fn smaller(self, other: Self) -> Self {
        Self { lower: self.lower.smaller(other.lower), upper: self.upper.smaller(other.upper) }
    }

    #[inline]
    fn larger(self, other: Self) -> Self {
        Self { lower: self.lower.larger(other.lower), upper: self.upper.larger(other.upper) }
    }

    #[inline]
    fn abs(self) -> Self {
        Self { lower: self.mignitude(), upper: self.magnitude() }
    }

    #[inline]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        match self.is_less(bound) {
            Some(true) => then,
            Some(false) => otherwise,
            None => then.hull(otherwise),
        }
    }

    #[inline]
    fn square(self) -> Self {
        let magnitude = Scalar::abs(self);
        magnitude * magnitude
    }

    #[inline]
    fn exp(self) -> Self {
        let lower = positive_down(Scalar::exp(self.lower), EXP_STEPS);
        let upper = positive_up(Scalar::exp(self.upper), EXP_STEPS);
        // On its side of 1, and exactly 1 at 0.
        let lower = if self.lower >= 0.0 { lower.larger(1.0) } else { lower };
        let upper = if self.upper <= 0.0 { upper.smaller(1.0) } else { upper };
        Self { lower, upper }
    }

    fn ln(self) -> Self {
        if !(self.upper > 0.0) {
            return Self::ENTIRE;
        }
        Self { lower: self.lower.max(0.0), upper: self.upper }.rising(libm::log)
    }

    fn sqrt(self) -> Self {
        if !(self.upper >= 0.0) {
            return Self::ENTIRE;
        }
        Self { lower: root_down(self.lower.max(0.0)), upper: root_up(self.upper) }
    }

    fn pow(self, power: Self) -> Self {
        match power.whole() {
            Some(whole) => self.whole_power(whole),
            None => self.any_power(power),
        }
    }

    fn sin(self) -> Self {
        self.wave(self / PI - Self::half(), libm::sin)
    }

    fn cos(self) -> Self {
        self.wave(self / PI, libm::cos)
    }

    fn tan(self) -> Self {
        let poles = self / PI - Self::half();
        if poles.parities() == (false, false) { self.rising(libm::tan) } else { Self::ENTIRE }
    }

    fn asin(self) -> Self {
        self.intersection(SINES).map_or(Self::ENTIRE, |inside| inside.rising(libm::asin))
    }

    fn acos(self) -> Self {
        let inside = self.intersection(SINES);
        inside.map_or(Self::ENTIRE, |inside| -inside.rising(|x| -libm::acos(x)))
    }

    fn atan(self) -> Self {
        self.rising(libm::atan)
    }

    fn sinh(self) -> Self {
        self.rising(libm::sinh)
    }

    fn cosh(self) -> Self {
        let values = Scalar::abs(self).rising(libm::cosh);
        Self { lower: values.lower.max(1.0), upper: values.upper }
    }

    fn tanh(self) -> Self {
        self.rising(libm::tanh).within(SINES)
    }

    fn floor(self) -> Self {
        Self { lower: libm::floor(self.lower), upper: libm::floor(self.upper) }
    }
}

impl Base for Interval {
    #[inline]
    fn is_less(self, bound: Self) -> Option<bool> {
        if self.upper < bound.lower {
            Some(true)
        } else if self.lower >= bound.upper {
            Some(false)
        } else {
            None
        }
    }

    /// Both cases also at a tie of two single numbers, which is a kink hit exactly.
    #[inline]
    fn choose(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let tie = self.is_point() && bound.is_point() && bound.contains(self.lower);
        if tie { then.hull(otherwise) } else { self.if_less(bound, then, otherwise) }
    }

    #[inline]
    fn scaled(self, factor: Self) -> Self {
        self * factor
    }

    fn unknown() -> Self {
        Self::ENTIRE
    }

    #[inline]
    fn is_zero(self) -> bool {
        self.lower >= 0.0 && self.upper <= 0.0
    }

    fn whole(self) -> Option<i32> {
        if self.is_point() { self.lower.whole() } else { None }
    }
}
