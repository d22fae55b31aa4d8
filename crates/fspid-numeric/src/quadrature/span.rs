//! Part of a domain, and the integrals over it.

use core::ops::Add;

use crate::scalar::{Interval, Scalar};

/// Area and first moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) area: Interval,
    pub(super) moment: Interval,
}

impl Moments {
    pub(super) const NONE: Self = Self { area: Interval::ZERO, moment: Interval::ZERO };
}

impl Add for Moments {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { area: self.area + other.area, moment: self.moment + other.moment }
    }
}

/// Part of the domain, and the point that moments are about.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) about: f64,
}

impl Span {
    #[cfg(test)]
    pub(super) const fn new(lower: f64, upper: f64, about: f64) -> Self {
        Self { lower, upper, about }
    }

    pub(super) fn hull(self) -> Interval {
        Interval::between(self.lower, self.upper)
    }

    pub(super) fn about(self) -> Interval {
        Interval::point(self.about)
    }

    /// The distance of any point inside from the centre of moments.
    pub(super) fn hull_about(self) -> Interval {
        self.hull() - self.about()
    }

    pub(super) fn width(self) -> Interval {
        Interval::point(self.upper) - Interval::point(self.lower)
    }

    pub(super) fn middle_and_half(self) -> [Interval; 2] {
        let sum = Interval::point(self.lower) + Interval::point(self.upper);
        [sum * Interval::half(), self.width() * Interval::half()]
    }

    /// The integrals of a function of which only the range is known.
    pub(super) fn enclosed(self, range: Interval) -> Moments {
        let area = self.width() * range;
        Moments { area, moment: area * self.hull_about() }
    }
}
