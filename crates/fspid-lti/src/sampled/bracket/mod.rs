//! Peaks and crossings of a loop, proved: what they are at least by evaluation, at most by positive polynomials.
//!
//! Eigenvalues that should lie on a circle or an axis are carried off it by rounding where slow modes crowd at z = 1,
//! and a method that looks for them there then sees nothing. Here nothing is looked for in a place: a level is no
//! peak's before a polynomial has been proved to be positive at every frequency.

mod crossing;
mod heights;
mod number;
mod parts;
mod real;
mod sign;

use core::f64::consts::PI;

use super::reduced::Response;
use crate::ball::Ball;
use crate::complex::modulus;
use crate::wide::WideBall;
use crossing::{changes_around, completed};
use heights::Heights;
use number::Number;
use parts::{Parts, States};
use real::{Real, difference};
use sign::Sign;

/// How far above a peak, relative to it, no other point may lie.
const ABOVE: f64 = 1e-9;
/// The two ends of a bracket count as one up to this share.
const SAME: f64 = 1e-8;
/// Climbs to higher peaks, and attempts with higher levels; one is usual.
const CLIMBS_MAX: usize = 60;
/// How much more room a level gets where rounding hides whether it is reached.
const MORE_ROOM: f64 = 30.0;
/// Rounding of a root and a quotient of plain numbers.
const UP: f64 = 1.0 + 8.0 * f64::EPSILON;
/// Up to this order twice the working precision is enough.
const ORDER_SHORT: usize = 40;
/// And up to this one 512 bits.
const ORDER_LONG: usize = 110;
/// And up to this one it does not take seconds to do without pivots.
const ORDER_WITHOUT_PIVOTS: usize = 64;

/// Rigorous enclosure of a number: proved lower and upper bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bracket {
    /// Reached, by evaluation at a frequency.
    pub at_least: f64,
    /// Not exceeded at any frequency; infinite where nothing is proved.
    pub at_most: f64,
}

impl Bracket {
    /// Whether the two ends are one, to 10⁻⁸. Where they are not, answers are the worse end.
    #[must_use]
    pub fn is_tight(&self) -> bool {
        self.at_most <= self.at_least * (1.0 + SAME)
    }

    /// Whether anything is proved.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.at_least > 0.0 || self.at_most < f64::INFINITY
    }

    /// Nothing is proved.
    pub(crate) fn unknown() -> Self {
        Self { at_least: 0.0, at_most: f64::INFINITY }
    }

    /// The bracket of the inverse.
    #[must_use]
    pub(crate) fn inverse(self) -> Self {
        Self { at_least: 1.0 / self.at_most, at_most: 1.0 / self.at_least }
    }
}

/// Where a peak lies, how high it is, and what is proved of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Top {
    pub(super) angle_rad: f64,
    pub(super) value: f64,
    pub(super) bracket: Bracket,
}

/// A loop whose coefficients are proved.
#[derive(Debug, Clone)]
pub(super) enum Proof {
    /// Coefficients of 256 bits, proofs with twice the working precision.
    Short(Proved<4>),
    /// Each sample of a dead time takes a binary digit or two: 512 bits throughout.
    Long(Proved<8>),
    /// And 1024.
    Longest(Proved<16>),
}

/// The same with so many words of 64 bits.
#[derive(Debug, Clone)]
pub(super) struct Proved<const W: usize> {
    parts: Parts<W>,
    /// Size of the denominator of S and T, squared.
    closed: Vec<WideBall<W>>,
}

impl Proof {
    /// From $A - I$ and b, as sums of two, and c; `None` where nothing can be proved.
    pub(super) fn new(change: &[[f64; 2]], b: &[[f64; 2]], c: &[f64]) -> Option<Self> {
        let order = b.len();
        let found = if order <= ORDER_SHORT {
            Parts::new(States::new(change, b, c)).map(|parts| Self::Short(parts.into()))
        } else if order <= ORDER_LONG {
            Parts::new(States::new(change, b, c)).map(|parts| Self::Long(parts.into()))
        } else {
            Parts::new(States::new(change, b, c)).map(|parts| Self::Longest(parts.into()))
        };
        found.or_else(|| {
            let states = (order <= ORDER_WITHOUT_PIVOTS).then(|| States::new(change, b, c));
            Parts::without_pivots(states?).map(|parts| Self::Long(parts.into()))
        })
    }

    /// The highest point of $|T - t_0|$, from one that was found by other means and its angle.
    ///
    /// The given one comes back as it is if nothing is proved to be higher by more than 10⁻⁹ of it. `None` where no level
    /// is proved to be above.
    pub(super) fn top(&self, centre: f64, found: (f64, f64)) -> Option<Top> {
        match self {
            Self::Short(it) => top(&balls(&it.numerator(centre)), &balls(&it.closed), found),
            Self::Long(it) => top(&it.numerator(centre), &it.closed, found),
            Self::Longest(it) => top(&it.numerator(centre), &it.closed, found),
        }
    }

    /// L at an angle: the response that was computed, if it is proved to 10⁻⁹, or else the proved one.
    pub(super) fn response(&self, angle_rad: f64, computed: Response) -> Response {
        let proved = match self {
            Self::Short(it) => it.response(angle_rad),
            Self::Long(it) => it.response(angle_rad),
            Self::Longest(it) => it.response(angle_rad),
        };
        let (cross, other) = (computed.over * proved.under, proved.over * computed.under);
        if modulus(cross - other) <= ABOVE * modulus(other) { computed } else { proved }
    }

    /// Whether L is proved to cross the real axis at an angle, to 10⁻⁹ of it.
    ///
    /// A pole then crosses the unit circle there as the gain passes the factor that makes L −1: the number of turns around
    /// −1 changes.
    pub(super) fn crosses_at(&self, angle_rad: f64) -> bool {
        match self {
            Self::Short(it) => changes_around(&it.across(), angle_rad),
            Self::Long(it) => changes_around(&it.across(), angle_rad),
            Self::Longest(it) => changes_around(&it.across(), angle_rad),
        }
    }

    /// Angles within two ends at which $|L| = 1$: those given, and those that are proved and not among them.
    pub(super) fn unit_gain_angles(&self, given: Vec<f64>, ends: (f64, f64)) -> Vec<f64> {
        match self {
            Self::Short(it) => completed(given, ends, &balls(&it.above_one())),
            Self::Long(it) => completed(given, ends, &it.above_one()),
            Self::Longest(it) => completed(given, ends, &it.above_one()),
        }
    }

    /// Angles within two ends at which L is real, in the same way.
    pub(super) fn real_angles(&self, given: Vec<f64>, ends: (f64, f64)) -> Vec<f64> {
        match self {
            Self::Short(it) => completed(given, ends, &balls(&it.across())),
            Self::Long(it) => completed(given, ends, &it.across()),
            Self::Longest(it) => completed(given, ends, &it.across()),
        }
    }
}

impl<const W: usize> From<Parts<W>> for Proved<W> {
    fn from(parts: Parts<W>) -> Self {
        let closed = parts.closed().squared();
        Self { parts, closed }
    }
}

impl<const W: usize> Proved<W> {
    /// Numerator of $T - t_0$, squared.
    fn numerator(&self, centre: f64) -> Vec<WideBall<W>> {
        // T − t₀ = ((1 − t₀) N − t₀ D) / (N + D).
        self.parts.over.combined(1.0 - centre, &self.parts.under, -centre).squared()
    }

    fn response(&self, angle_rad: f64) -> Response {
        let [over, under] = [&self.parts.over, &self.parts.under].map(|part| part.at(angle_rad));
        Response { over, under }
    }

    /// $|N|^2 - |D|^2$.
    fn above_one(&self) -> Vec<WideBall<W>> {
        let [over, under] = [&self.parts.over, &self.parts.under].map(Real::squared);
        difference(WideBall::from(1.0), &over, &under)
    }

    /// Imaginary part of $N D^\ast$.
    fn across(&self) -> Vec<WideBall<W>> {
        self.parts.over.across(&self.parts.under)
    }
}

fn balls<const W: usize>(polynomial: &[WideBall<W>]) -> Vec<Ball> {
    polynomial.iter().map(WideBall::ball).collect()
}

/// As [`Proof::top`], of a quotient of two polynomials, squares of sizes.
fn top<T: Number>(over: &[T], under: &[T], (value, angle_rad): (f64, f64)) -> Option<Top> {
    if over.iter().all(|coefficient| coefficient.is_nothing()) {
        let bracket = Bracket { at_least: 0.0, at_most: 0.0 };
        return Some(answer(0.0, bracket, (value, angle_rad)));
    }
    let heights = Heights { over, under };
    let places = [place_of(angle_rad), 0.0, f64::INFINITY].map(|place| heights.at(place));
    let (mut best, mut room) = (places[0].or(places[1]).or(places[2]), ABOVE);
    for _ in 0..CLIMBS_MAX {
        let level = best.bracket.at_most * (1.0 + room);
        let square = T::from(level).product(T::from(level));
        match sign::sign(&difference(square, under, over)) {
            Sign::Positive => {
                let bracket = Bracket { at_most: level * UP, ..best.bracket };
                return Some(answer(best.place, bracket, (value, angle_rad)));
            }
            Sign::Negative(place) => best = heights.climb(place, best),
            Sign::Hidden(place) => {
                best = best.or(heights.at(place));
                room *= MORE_ROOM;
            }
        }
    }
    None
}

/// The given peak if it is proved, or else the end of the bracket that does not promise too much.
fn answer(place: f64, bracket: Bracket, (value, angle_rad): (f64, f64)) -> Top {
    if bracket.at_least * (1.0 - ABOVE) <= value && value <= bracket.at_most && bracket.is_tight() {
        return Top { angle_rad, value, bracket };
    }
    let value = if bracket.is_tight() { bracket.at_least * UP } else { bracket.at_most };
    Top { angle_rad: angle_of(place), value, bracket }
}

/// $w = \tan^2(\omega T / 2)$.
fn place_of(angle_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(0.5 * angle_rad.clamp(0.0, PI));
    let tangent = sin / cos;
    tangent * tangent
}

fn angle_of(place: f64) -> f64 {
    2.0 * libm::atan(place.sqrt())
}
