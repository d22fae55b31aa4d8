//! The two kinds of numbers that proofs are made of.

use crate::ball::Ball;
use crate::wide::WideBall;

/// A real number with a bound of its error.
pub(super) trait Number: Copy + From<f64> {
    const ZERO: Self;

    fn sum(self, other: Self) -> Self;
    fn less(self, other: Self) -> Self;
    fn product(self, other: Self) -> Self;
    /// `None` where the divisor may be 0.
    fn quotient(self, divisor: Self) -> Option<Self>;
    /// Times a power of two, given by its exponent.
    fn shifted(self, exponent: i32) -> Self;
    /// A plain number near it, and how far it may be from that.
    fn plain(self) -> (f64, f64);

    fn is_nothing(self) -> bool {
        self.plain() == (0.0, 0.0)
    }

    fn positive(self) -> bool {
        let (value, radius) = self.plain();
        value > radius
    }

    fn negative(self) -> bool {
        let (value, radius) = self.plain();
        -value > radius
    }

    /// Half the sum: a point between two neighbours.
    fn between(self, other: Self) -> Self {
        self.sum(other).shifted(-1)
    }
}

impl Number for Ball {
    const ZERO: Self = Self::ZERO;

    fn sum(self, other: Self) -> Self {
        self.plus(other)
    }

    fn less(self, other: Self) -> Self {
        self.minus(other)
    }

    fn product(self, other: Self) -> Self {
        self.times(other)
    }

    fn quotient(self, divisor: Self) -> Option<Self> {
        self.over(divisor)
    }

    fn shifted(self, exponent: i32) -> Self {
        self.scaled(exponent)
    }

    fn plain(self) -> (f64, f64) {
        (self.rounded(), self.radius())
    }

    fn between(self, other: Self) -> Self {
        self.middle(other)
    }
}

impl<const W: usize> Number for WideBall<W> {
    const ZERO: Self = Self::ZERO;

    fn sum(self, other: Self) -> Self {
        self.plus(&other)
    }

    fn less(self, other: Self) -> Self {
        self.minus(&other)
    }

    fn product(self, other: Self) -> Self {
        self.times(&other)
    }

    fn quotient(self, divisor: Self) -> Option<Self> {
        self.over(&divisor)
    }

    fn shifted(self, exponent: i32) -> Self {
        self.scaled(exponent)
    }

    fn plain(self) -> (f64, f64) {
        (self.rounded(), self.radius())
    }
}
