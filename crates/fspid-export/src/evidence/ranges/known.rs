//! What a value may be while a program runs.

use crate::program::{Operator, Precision, Value};

/// Which numbers a real may be: an interval, whether it may be no number, and whether it may be the negative zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::evidence) struct Range {
    pub(in crate::evidence) low: f64,
    pub(in crate::evidence) high: f64,
    pub(in crate::evidence) nan: bool,
    pub(in crate::evidence) minus_zero: bool,
}

/// What a value may be.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::evidence) enum Known {
    Real(Range),
    Reals(Vec<Range>),
    Bytes(Vec<u8>),
    Whole([i32; 2]),
    /// `None` for any.
    Byte(Option<u8>),
    Truth(Truth),
}

/// Which truths it may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::evidence) struct Truth {
    pub(in crate::evidence) yes: bool,
    pub(in crate::evidence) no: bool,
}

impl Truth {
    pub(super) const ANY: Self = Self { yes: true, no: true };

    pub(super) const fn of(is: bool) -> Self {
        Self { yes: is, no: !is }
    }

    pub(super) const fn negated(self) -> Self {
        Self { yes: self.no, no: self.yes }
    }

    /// The truth, where it can only be one.
    pub(in crate::evidence) fn constant(self) -> Option<bool> {
        (self.yes != self.no).then_some(self.yes)
    }
}

impl Range {
    pub(in crate::evidence) const ANY: Self =
        Self { low: f64::NEG_INFINITY, high: f64::INFINITY, nan: true, minus_zero: true };

    pub(super) const fn between(low: f64, high: f64) -> Self {
        Self { low, high, nan: false, minus_zero: false }
    }

    pub(in crate::evidence) fn point(value: f64) -> Self {
        let minus_zero = value == 0.0 && value.is_sign_negative();
        Self { minus_zero, ..Self::between(value, value) }
    }

    fn is_empty(&self) -> bool {
        self.low > self.high
    }

    /// True if it may be a zero of either sign.
    pub(in crate::evidence) fn has_zero(&self) -> bool {
        self.low <= 0.0 && 0.0 <= self.high
    }

    fn has_infinity(&self) -> bool {
        self.low == f64::NEG_INFINITY || self.high == f64::INFINITY
    }

    pub(in crate::evidence) fn is_finite(&self) -> bool {
        !self.nan && !self.has_infinity()
    }

    /// The number, where it can only be one, and which zero is known.
    pub(in crate::evidence) fn constant(&self) -> Option<f64> {
        let is_one = self.low.to_bits() == self.high.to_bits();
        (is_one && !self.nan && self.low != 0.0).then_some(self.low)
    }

    pub(in crate::evidence) fn joined(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            nan: self.nan || other.nan,
            minus_zero: self.minus_zero || other.minus_zero,
        }
    }

    pub(super) fn cut(self, low: f64, high: f64) -> Self {
        Self { low: self.low.max(low), high: self.high.min(high), nan: false, ..self }
    }

    pub(in crate::evidence) fn negative(self) -> Self {
        let minus_zero = self.has_zero();
        Self { low: -self.high, high: -self.low, minus_zero, ..self }
    }

    pub(super) fn magnitude(self) -> Self {
        let most = self.low.abs().max(self.high.abs());
        let least = if self.has_zero() { 0.0 } else { self.low.abs().min(self.high.abs()) };
        Self { low: least, high: most, minus_zero: false, ..self }
    }

    /// The square of one number.
    pub(super) fn squared(self, precision: Precision) -> Self {
        let Self { low, high, nan, .. } = self.magnitude();
        let [low, high] = [low * low, high * high].map(|it| rounded(precision, it));
        Self { low, high, nan, minus_zero: false }
    }

    /// Rounding never changes an order, so that the ends are rounded as the program rounds.
    pub(in crate::evidence) fn computed(
        self,
        operator: Operator,
        other: Self,
        precision: Precision,
    ) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self { nan: true, ..self };
        }
        let ends = [self.low, self.high].map(|left| {
            [other.low, other.high].map(|right| match operator {
                Operator::Add => left + right,
                Operator::Subtract => left - right,
                Operator::Multiply => left * right,
                _ => left / right,
            })
        });
        let infinite = self.has_infinity() || other.has_infinity();
        let by_zero = operator == Operator::Divide && other.has_zero();
        let unclear = ends.iter().flatten().any(|end| end.is_nan());
        let sums = matches!(operator, Operator::Add | Operator::Subtract);
        if by_zero || unclear || (infinite && !sums) {
            return Self::ANY;
        }
        let ends = ends.as_flattened().iter().map(|end| rounded(precision, *end));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
            (low.min(end), high.max(end))
        });
        let opposite = match operator {
            Operator::Add => opposed(self, other),
            Operator::Subtract => opposed(self, other.negative()),
            _ => false,
        };
        let plain = |it: Self| it.low >= 0.0 && !it.minus_zero;
        let minus_zero = match operator {
            Operator::Add => self.minus_zero && other.minus_zero,
            Operator::Subtract => self.minus_zero && other.has_zero(),
            _ => !(plain(self) && plain(other)),
        };
        Self { low, high, nan: self.nan || other.nan || opposite, minus_zero }
    }

    pub(in crate::evidence) fn less(self, other: Self, or_equal: bool) -> Truth {
        let nan = self.nan || other.nan;
        if self.is_empty() || other.is_empty() {
            return Truth { yes: false, no: true };
        }
        if or_equal {
            Truth { yes: self.low <= other.high, no: nan || self.high > other.low }
        } else {
            Truth { yes: self.low < other.high, no: nan || self.high >= other.low }
        }
    }

    pub(super) fn is_within(&self, other: &Self) -> bool {
        (self.is_empty() || other.low <= self.low && self.high <= other.high)
            && (other.nan || !self.nan)
            && (other.minus_zero || !self.minus_zero)
    }
}

/// True where infinities of both signs may meet.
fn opposed(left: Range, right: Range) -> bool {
    left.high == f64::INFINITY && right.low == f64::NEG_INFINITY
        || left.low == f64::NEG_INFINITY && right.high == f64::INFINITY
}

/// As the program rounds: twice the digits and two more are known before, so that rounding twice is rounding once.
#[allow(clippy::cast_possible_truncation, reason = "this is the rounding")]
pub(in crate::evidence) fn rounded(precision: Precision, value: f64) -> f64 {
    match precision {
        Precision::Single => f64::from(value as f32),
        Precision::Double => value,
    }
}

/// The next number above, in the program's precision.
#[allow(clippy::cast_possible_truncation, reason = "a number of the program")]
pub(in crate::evidence) fn above(precision: Precision, value: f64) -> f64 {
    match precision {
        Precision::Single => f64::from((value as f32).next_up()),
        Precision::Double => value.next_up(),
    }
}

impl Known {
    /// What a member of the configuration is.
    pub(super) fn exactly(value: &Value, precision: Precision) -> Self {
        let point = |value: &f64| Range::point(rounded(precision, *value));
        match value {
            Value::Real(value) => Self::Real(point(value)),
            Value::Reals(values) => Self::Reals(values.iter().map(point).collect()),
            Value::Bytes(bytes) => Self::Bytes(bytes.clone()),
            Value::Byte(byte) => Self::Byte(Some(*byte)),
            Value::Truth(truth) => Self::Truth(Truth::of(*truth)),
        }
    }

    /// Anything that a member like it can be.
    pub(super) fn anything(value: &Value) -> Self {
        match value {
            Value::Real(_) => Self::Real(Range::ANY),
            Value::Reals(values) => Self::Reals(vec![Range::ANY; values.len()]),
            Value::Bytes(bytes) => Self::Bytes(bytes.clone()),
            Value::Byte(_) => Self::Byte(None),
            Value::Truth(_) => Self::Truth(Truth::ANY),
        }
    }

    pub(super) fn joined(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Real(a), Self::Real(b)) => Self::Real(a.joined(*b)),
            (Self::Reals(a), Self::Reals(b)) => {
                Self::Reals(a.iter().zip(b).map(|(a, b)| a.joined(*b)).collect())
            }
            (Self::Whole(a), Self::Whole(b)) => Self::Whole([a[0].min(b[0]), a[1].max(b[1])]),
            (Self::Byte(a), Self::Byte(b)) => Self::Byte(if a == b { *a } else { None }),
            (Self::Truth(a), Self::Truth(b)) => {
                Self::Truth(Truth { yes: a.yes || b.yes, no: a.no || b.no })
            }
            _ => self.clone(),
        }
    }

    pub(super) fn is_within(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Real(a), Self::Real(b)) => a.is_within(b),
            (Self::Byte(a), Self::Byte(b)) => b.is_none() || a == b,
            (Self::Truth(a), Self::Truth(b)) => (b.yes || !a.yes) && (b.no || !a.no),
            _ => self == other,
        }
    }

    /// Joined with what has grown out of it, and further out to a power of two, so that growing ends.
    pub(super) fn widened(&self, other: &Self) -> Self {
        let (Self::Real(a), Self::Real(b)) = (self, other) else { return self.joined(other) };
        let out = |it: f64| if it > 0.0 { it.log2().ceil().exp2().max(it) } else { it };
        let joined = a.joined(*b);
        let low = if b.low < a.low { -out(-b.low) } else { joined.low };
        let high = if b.high > a.high { out(b.high) } else { joined.high };
        Self::Real(Range { low, high, ..joined })
    }
}
