//! Magnitude of a frequency response at a given frequency, bracketed, and the local maximum near it.

use super::number::Number;
use super::real::value_at;
use super::{Bracket, UP};
use crate::sampled::family::bowl;

/// A quotient of two polynomials, squares of sizes.
pub(super) struct Heights<'a, T> {
    pub(super) over: &'a [T],
    pub(super) under: &'a [T],
}

/// The height at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub(super) place: f64,
    pub(super) bracket: Bracket,
}

impl Height {
    /// Of two the one that is proved to be higher.
    pub(super) fn or(self, other: Self) -> Self {
        if other.bracket.at_least > self.bracket.at_least { other } else { self }
    }
}

impl<T: Number> Heights<'_, T> {
    fn square(&self, place: f64) -> Option<T> {
        value_at(self.over, place).quotient(value_at(self.under, place))
    }

    pub(super) fn at(&self, place: f64) -> Height {
        let bracket = match self.square(place).map(T::plain) {
            Some((square, radius)) => Bracket {
                at_least: (square - radius).max(0.0).sqrt() / UP,
                at_most: (square + radius).sqrt() * UP,
            },
            None => Bracket { at_least: 0.0, at_most: f64::INFINITY },
        };
        Height { place, bracket }
    }

    /// From a place that is higher than the best one to the top of its peak.
    pub(super) fn climb(&self, place: f64, best: Height) -> Height {
        let start = self.at(place).or(best);
        if !(place > 0.0 && place.is_finite()) {
            return start;
        }
        let depth = |logarithm: f64| {
            let square = self.square(libm::exp(logarithm)).map_or(0.0, |it| it.plain().0);
            (logarithm, -square)
        };
        let middle = depth(libm::log(place));
        let side = |direction: f64| {
            let mut step = 1e-6;
            let mut last = depth(middle.0 + direction * step);
            while last.1 <= middle.1 && step < 2.0 {
                step *= 2.0;
                last = depth(middle.0 + direction * step);
            }
            last
        };
        let ends = [side(-1.0), middle, side(1.0)];
        let found = bowl::lowest(|at| depth(at).1, ends, f64::NEG_INFINITY);
        start.or(self.at(libm::exp(found.0)))
    }
}
