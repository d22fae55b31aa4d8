//! What a function does on a panel: its values at both ends and its Taylor coefficients in between.
//!
//! The ends sharpen what the coefficients say. A function with a slope of one sign lies between its
//! values at the ends; two functions whose difference has a slope of one sign and the same sign at
//! both ends do not cross inside, so a comparison of them is decided although their ranges overlap.
//! At most at one end they may be equal there: for an integral that point does not count, so a panel
//! may end on a kink or a jump.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::gauss::ORDER;
use crate::scalar::{Base, Interval, Jet, Scalar};

/// Taylor coefficients up to the order of the remainder.
type Series = Jet<Interval, { ORDER + 1 }>;

/// A function on a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    ends: [Interval; 2],
    series: Series,
}

impl Panel {
    /// The variable itself.
    pub(super) fn variable(lower: f64, upper: f64) -> Self {
        let ends = [lower, upper].map(Interval::point);
        Self { ends, series: Jet::variable(Interval::between(lower, upper)) }
    }

    /// The last two Taylor coefficients, unless nothing is known of some.
    pub(super) fn last_two(&self) -> Option<[Interval; 2]> {
        let coefficients @ &[.., before, last] = self.series.coefficients();
        coefficients.iter().all(|c| c.is_bounded()).then_some([before, last])
    }

    /// All values.
    pub(super) fn range(&self) -> Interval {
        self.series.value()
    }

    /// The range cut down to the values at the ends if the slope has one sign.
    fn sharpened(ends: [Interval; 2], series: Series) -> Self {
        let slope = series.coefficients()[1];
        let turns = slope.lower() < 0.0 && slope.upper() > 0.0;
        // A range without bounds may hide a pole.
        if turns || !series.value().is_bounded() {
            return Self { ends, series };
        }
        let [left, right] = ends;
        let range = series.value().intersection(left.hull(right)).unwrap_or(series.value());
        Self { ends, series: series.with_value(range) }
    }

    /// Whether the function lies below `bound` on all of the panel, but for one point.
    fn lies_below(&self, bound: &Self) -> Option<bool> {
        let by_range = self.range().is_less(bound.range());
        by_range.or_else(|| {
            let slope = bound.series.coefficients()[1] - self.series.coefficients()[1];
            let no_pole = self.range().is_bounded() && bound.range().is_bounded();
            if no_pole && !slope.contains(0.0) { self.parts_from(bound) } else { None }
        })
    }

    /// [`lies_below`](Self::lies_below), where it does not matter which of equal values counts.
    fn lies_at_most_at(&self, bound: &Self) -> Option<bool> {
        let below = self.lies_below(bound);
        below.or_else(|| bound.range().is_less(self.range()).map(|above| !above))
    }

    /// [`lies_below`](Self::lies_below) of functions that cross at most once, by their ends.
    fn parts_from(&self, bound: &Self) -> Option<bool> {
        let [left, right] = [0, 1].map(|end| bound.ends[end] - self.ends[end]);
        if left.lower() >= 0.0 && right.lower() >= 0.0 {
            Some(true)
        } else if left.upper() <= 0.0 && right.upper() <= 0.0 {
            Some(false)
        } else {
            None
        }
    }

    /// One of two cases; if it is open which, `undecided` at each end and no slopes in between.
    fn select(
        below: Option<bool>,
        then: Self,
        otherwise: Self,
        undecided: impl Fn([Interval; 2]) -> Interval,
    ) -> Self {
        match below {
            Some(true) => then,
            Some(false) => otherwise,
            None => {
                let at = |end: usize| undecided([then.ends[end], otherwise.ends[end]]);
                let range = undecided([then.range(), otherwise.range()]);
                let series = Jet::select(None, range, then.series, otherwise.series);
                Self { ends: [at(0), at(1)], series }
            }
        }
    }
}

impl Neg for Panel {
    type Output = Self;
    fn neg(self) -> Self {
        Self { ends: self.ends.map(|end| -end), series: -self.series }
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Panel {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ends = [0, 1].map(|end| self.ends[end].$method(other.ends[end]));
                Self::sharpened(ends, self.series.$method(other.series))
            }
        }
    )*};
}

operator!(Add add, Sub sub, Mul mul, Div div);

macro_rules! functions {
    ($($method:ident),*) => {$(
        fn $method(self) -> Self {
            Self::sharpened(self.ends.map(Scalar::$method), self.series.$method())
        }
    )*};
}

impl Scalar for Panel {
    fn constant(value: f64) -> Self {
        Self { ends: [Interval::point(value); 2], series: Jet::constant(value) }
    }

    fn smaller(self, other: Self) -> Self {
        Self::select(self.lies_at_most_at(&other), self, other, |[a, b]| a.smaller(b))
    }

    fn larger(self, other: Self) -> Self {
        Self::select(other.lies_at_most_at(&self), self, other, |[a, b]| a.larger(b))
    }

    fn abs(self) -> Self {
        Self::select(self.lies_at_most_at(&Self::zero()), -self, self, |[_, value]| {
            Scalar::abs(value)
        })
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self::select(self.lies_below(&bound), then, otherwise, |[a, b]| a.hull(b))
    }

    fn pow(self, power: Self) -> Self {
        let ends = [0, 1].map(|end| self.ends[end].pow(power.ends[end]));
        Self::sharpened(ends, self.series.pow(power.series))
    }

    functions!(square, exp, ln, sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, floor);
}
