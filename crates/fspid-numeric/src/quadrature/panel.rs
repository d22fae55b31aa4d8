//! What a function does on a panel: its values at both ends and its Taylor coefficients in between.
//!
//! The ends sharpen what the coefficients say. A function with a slope of one sign lies between its
//! values at the ends; two functions whose difference has a slope of one sign and the same sign at
//! both ends do not cross inside, so a comparison of them is decided although their ranges overlap.
//! At most at one end they may be equal there: for an integral that point does not count, so a panel
//! may end on a kink or a jump.
//!
//! Two rules with one consequent compare a function with itself, whose ranges never part. That it is
//! itself is told by a fingerprint of 64 bits of how it was computed.

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
    fingerprint: u64,
}

/// The fingerprint of a text: FNV-1a (Fowler, Noll and Vo).
const fn text(text: &str) -> u64 {
    let (bytes, mut hash, mut index) = (text.as_bytes(), 0xCBF2_9CE4_8422_2325_u64, 0);
    while index < bytes.len() {
        hash = (hash ^ bytes[index] as u64).wrapping_mul(0x0000_0100_0000_01B3);
        index += 1;
    }
    hash
}

/// The fingerprint of an operation on operands: the finaliser of `SplitMix64` (Steele, Lea and Flood
/// 2014) after each.
fn fingerprint(operation: u64, operands: &[u64]) -> u64 {
    operands.iter().fold(operation, |hash, &operand| {
        let mut mixed = hash.rotate_left(23) ^ operand.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    })
}

impl Panel {
    /// The variable itself.
    pub(super) fn variable(lower: f64, upper: f64) -> Self {
        let ends = [lower, upper].map(Interval::point);
        let series = Jet::variable(Interval::between(lower, upper));
        Self { ends, series, fingerprint: fingerprint(const { text("variable") }, &[0]) }
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
    fn sharpened(ends: [Interval; 2], series: Series, fingerprint: u64) -> Self {
        let slope = series.coefficients()[1];
        let turns = slope.lower() < 0.0 && slope.upper() > 0.0;
        // A range without bounds may hide a pole.
        if turns || !series.value().is_bounded() {
            return Self { ends, series, fingerprint };
        }
        let [left, right] = ends;
        let range = series.value().intersection(left.hull(right)).unwrap_or(series.value());
        Self { ends, series: series.with_value(range), fingerprint }
    }

    /// Whether the function lies below `bound` on all of the panel, but for one point.
    fn lies_below(&self, bound: &Self) -> Option<bool> {
        if self.fingerprint == bound.fingerprint {
            return Some(false);
        }
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

    /// The fingerprint of an operation on two functions.
    fn with(self, other: Self, operation: u64) -> u64 {
        fingerprint(operation, &[self.fingerprint, other.fingerprint])
    }

    /// One of two cases; if it is open which, `undecided` at each end and no slopes in between.
    fn select(
        below: Option<bool>,
        then: Self,
        otherwise: Self,
        fingerprint: u64,
        undecided: impl Fn([Interval; 2]) -> Interval,
    ) -> Self {
        match below {
            Some(true) => then,
            Some(false) => otherwise,
            None => {
                let at = |end: usize| undecided([then.ends[end], otherwise.ends[end]]);
                let range = undecided([then.range(), otherwise.range()]);
                let series = Jet::select(None, range, then.series, otherwise.series);
                Self { ends: [at(0), at(1)], series, fingerprint }
            }
        }
    }
}

impl Neg for Panel {
    type Output = Self;
    fn neg(self) -> Self {
        let fingerprint = fingerprint(const { text("neg") }, &[self.fingerprint]);
        Self { ends: self.ends.map(|end| -end), series: -self.series, fingerprint }
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Panel {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ends = [0, 1].map(|end| self.ends[end].$method(other.ends[end]));
                let series = self.series.$method(other.series);
                Self::sharpened(ends, series, self.with(other, const { text(stringify!($method)) }))
            }
        }
    )*};
}

operator!(Add add, Sub sub, Mul mul, Div div);

macro_rules! functions {
    ($($method:ident),*) => {$(
        fn $method(self) -> Self {
            let fingerprint = fingerprint(const { text(stringify!($method)) }, &[self.fingerprint]);
            Self::sharpened(self.ends.map(Scalar::$method), self.series.$method(), fingerprint)
        }
    )*};
}

impl Scalar for Panel {
    fn constant(value: f64) -> Self {
        let fingerprint = fingerprint(const { text("constant") }, &[value.to_bits()]);
        Self { ends: [Interval::point(value); 2], series: Jet::constant(value), fingerprint }
    }

    fn smaller(self, other: Self) -> Self {
        let (below, fingerprint) =
            (self.lies_at_most_at(&other), self.with(other, const { text("smaller") }));
        Self::select(below, self, other, fingerprint, |[a, b]| a.smaller(b))
    }

    fn larger(self, other: Self) -> Self {
        let (above, fingerprint) =
            (other.lies_at_most_at(&self), self.with(other, const { text("larger") }));
        Self::select(above, self, other, fingerprint, |[a, b]| a.larger(b))
    }

    fn abs(self) -> Self {
        let negative = self.lies_at_most_at(&Self::zero());
        let fingerprint = self.with(self, const { text("abs") });
        Self::select(negative, -self, self, fingerprint, |[_, value]| Scalar::abs(value))
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let operands = [self, bound, then, otherwise].map(|operand| operand.fingerprint);
        let fingerprint = fingerprint(const { text("if_less") }, &operands);
        Self::select(self.lies_below(&bound), then, otherwise, fingerprint, |[a, b]| a.hull(b))
    }

    fn pow(self, power: Self) -> Self {
        let ends = [0, 1].map(|end| self.ends[end].pow(power.ends[end]));
        Self::sharpened(
            ends,
            self.series.pow(power.series),
            self.with(power, const { text("pow") }),
        )
    }

    functions!(square, exp, ln, sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, floor);
}
