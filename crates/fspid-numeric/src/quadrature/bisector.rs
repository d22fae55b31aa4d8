//! The point that halves an area.

use super::{Curve, Quadrature};
use crate::scalar::{Interval, Scalar};

/// Steps of Newton's method; beyond them the bracket is answered as it is.
const STEPS: u32 = 60;

/// A bracket is brought in from a side up to this share of the domain: the area known to 1e-13 of itself tells the sides of a
/// point apart up to some 1e-7 where the curve vanishes in proportion to the distance.
const SIDE_SHARE: f64 = 1e-9;

/// Where the bisector may be, and a point of which the area on its left is known.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    lower: f64,
    upper: f64,
    at: f64,
    /// Half the area less the area on the left of `at`.
    missing: Interval,
}

impl Bracket {
    /// The bracket cut at its point, or `None` if it is open on which side of it the bisector lies.
    fn cut(self) -> Option<Self> {
        if self.missing.lower() > 0.0 {
            Some(Self { lower: self.at, ..self })
        } else if self.missing.upper() < 0.0 {
            Some(Self { upper: self.at, ..self })
        } else {
            None
        }
    }

    /// The next point to look at: Newton's, or the middle where that leads outside.
    fn next(self, height: f64) -> f64 {
        let newton = self.at + self.missing.midpoint() / height;
        let inside = self.lower < newton && newton < self.upper;
        if inside { newton } else { Interval::between(self.lower, self.upper).midpoint() }
    }
}

impl Quadrature<'_> {
    /// $\int_{lower}^{x} f$; for an `x` outside of the domain, that up to its end.
    #[must_use]
    pub fn area_up_to<C: Curve>(&self, curve: &C, x: f64) -> Interval {
        let upper = x.smaller(self.upper).larger(self.lower);
        self.part(curve, self.lower, upper, self.tolerance(curve))
    }

    /// Every point that halves the area under a curve that is nowhere negative; `None` if the area
    /// may be zero. Wide where the curve vanishes between two halves, or its integral is wide.
    #[must_use]
    pub fn bisector<C: Curve>(&self, curve: &C) -> Option<Interval> {
        let tolerance = self.tolerance(curve);
        let area = self.part(curve, self.lower, self.upper, tolerance);
        if !(area.lower() > 0.0) {
            return None;
        }
        let missing = area * Interval::half();
        let whole = Bracket { lower: self.lower, upper: self.upper, at: self.lower, missing };
        Some(self.narrowed(curve, tolerance, whole))
    }

    fn part<C: Curve>(&self, curve: &C, lower: f64, upper: f64, tolerance: f64) -> Interval {
        let part = Self { lower, upper, ..*self };
        part.attempt(curve, tolerance, self.accuracy.panels).area
    }

    fn narrowed<C: Curve>(&self, curve: &C, tolerance: f64, whole: Bracket) -> Interval {
        let mut bracket = whole;
        for _ in 0..STEPS {
            let next = bracket.next(curve.at(bracket.at));
            bracket = self.moved(curve, tolerance, bracket, next);
            match bracket.cut() {
                Some(cut) if (cut.lower, cut.upper) != (bracket.lower, bracket.upper) => {
                    bracket = cut;
                }
                _ => break,
            }
        }
        self.enclosed(curve, bracket).unwrap_or_else(|| self.brought_in(curve, tolerance, bracket))
    }

    /// The bracket with its point elsewhere.
    fn moved<C: Curve>(&self, curve: &C, tolerance: f64, bracket: Bracket, to: f64) -> Bracket {
        let (at, missing) = (bracket.at, bracket.missing);
        let missing = if to > at {
            missing - self.part(curve, at, to, tolerance)
        } else {
            missing + self.part(curve, to, at, tolerance)
        };
        Bracket { at: to, missing, ..bracket }
    }

    /// The bracket, cut to the points that the curve's least height around its point allows: the
    /// area missing is at least that height times the distance. `None` where the curve may vanish there.
    fn enclosed<C: Curve>(&self, curve: &C, bracket: Bracket) -> Option<Interval> {
        let Bracket { lower, upper, at, missing } = bracket;
        let whole = Interval::between(lower, upper);
        let reach = Interval::point(4.0 * missing.magnitude() / curve.at(at)).upper();
        let around = Interval::point(at) + Interval::between(-reach, reach);
        let height = curve.at(around.intersection(whole)?).lower();
        let distance = (Interval::point(missing.magnitude()) / Interval::point(height)).upper();
        if !(height > 0.0 && distance <= reach) {
            return None;
        }
        let near = Interval::point(at) + Interval::between(-distance, distance);
        near.intersection(whole)
    }

    /// The bracket, brought in from both of its ends up to where nobody knows any more on which side of a point the bisector
    /// lies: around a gap between two halves, or a point where the curve vanishes.
    fn brought_in<C: Curve>(&self, curve: &C, tolerance: f64, bracket: Bracket) -> Interval {
        let near = SIDE_SHARE * (self.upper - self.lower);
        let side = |end: f64| {
            let (mut known, mut open) = (end, bracket.at);
            for _ in 0..STEPS {
                if (open - known).abs() <= near {
                    break;
                }
                let middle = 0.5 * known + 0.5 * open;
                match self.moved(curve, tolerance, bracket, middle).cut() {
                    Some(_) => known = middle,
                    None => open = middle,
                }
            }
            known
        };
        Interval::between(side(bracket.lower), side(bracket.upper))
    }
}
