//! Peaks and crossings of a loop, proved: what they are at least by evaluation, at most by positive polynomials.
//!
//! Eigenvalues that should lie on a circle or an axis are carried off it by rounding where slow modes crowd at z = 1,
//! and a method that looks for them there then sees nothing. Here nothing is looked for in a place: a level is no
//! peak's before a polynomial has been proved to be positive at every frequency.

mod parts;
mod real;
mod sign;

use core::f64::consts::PI;

use super::family::bowl;
use super::reduced::Response;
use crate::ball::Ball;
use crate::complex::modulus;
use crate::wide::WideBall;
use parts::Parts;
use real::{Real, difference};
use sign::{Between, Sign};

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
/// Halvings of the place of a crossing.
const HALVINGS: usize = 80;
/// Crossings whose angles differ by less than this share are one.
const SAME_PLACE: f64 = 1e-6;

/// What is proved of a number: it lies between these two.
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
pub(super) struct Proof {
    parts: Parts,
    closed: Vec<Ball>,
}

impl Proof {
    /// From $A - I$, b and c; `None` where nothing can be proved.
    pub(super) fn new(change: &[WideBall], b: &[WideBall], c: &[f64]) -> Option<Self> {
        let parts = Parts::new(change, b, c)?;
        let closed = parts.closed().squared();
        Some(Self { parts, closed })
    }

    /// The highest point of $|T - t_0|$, from one that was found by other means and its angle.
    ///
    /// The given one comes back as it is if nothing is proved to be higher by more than 10⁻⁹ of it.
    /// `None` where no level is proved to be above.
    pub(super) fn top(&self, centre: f64, (value, angle_rad): (f64, f64)) -> Option<Top> {
        let numerator = self.numerator(centre);
        if numerator.iter().all(|coefficient| coefficient.is_zero()) {
            let bracket = Bracket { at_least: 0.0, at_most: 0.0 };
            return Some(answer(0.0, bracket, (value, angle_rad)));
        }
        let heights = Heights { over: &numerator, under: &self.closed };
        let given = heights.at(place_of(angle_rad));
        let mut best = [0.0, f64::INFINITY].map(|place| heights.at(place)).into_iter().fold(
            given,
            |best, other| if other.bracket.at_least > best.bracket.at_least { other } else { best },
        );
        let mut room = ABOVE;
        for _ in 0..CLIMBS_MAX {
            let level = best.bracket.at_most * (1.0 + room);
            let square = Ball::from(level).times(Ball::from(level));
            match sign::sign(&difference(square, heights.under, heights.over)) {
                Sign::Positive => {
                    let bracket = Bracket { at_most: level * UP, ..best.bracket };
                    return Some(answer(best.place, bracket, (value, angle_rad)));
                }
                Sign::Negative(place) => best = heights.climb(place, best),
                Sign::Hidden(place) => {
                    let there = heights.at(place);
                    if there.bracket.at_least > best.bracket.at_least {
                        best = there;
                    }
                    room *= MORE_ROOM;
                }
            }
        }
        None
    }

    /// Numerator of $T - t_0$, squared.
    fn numerator(&self, centre: f64) -> Vec<Ball> {
        // T − t₀ = ((1 − t₀) N − t₀ D) / (N + D).
        self.parts.over.combined(1.0 - centre, &self.parts.under, -centre).squared()
    }

    /// L at an angle: the response that was computed, if it is proved to 10⁻⁹, or else the proved one.
    pub(super) fn response(&self, angle_rad: f64, computed: Response) -> Response {
        let [over, under] = [&self.parts.over, &self.parts.under].map(|part| part.at(angle_rad));
        let (cross, other) = (computed.over * under, over * computed.under);
        if modulus(cross - other) <= ABOVE * modulus(other) {
            return computed;
        }
        Response { over, under }
    }

    /// Whether L is proved to cross the real axis at an angle, to 10⁻⁹ of it.
    ///
    /// A pole then crosses the unit circle there as the gain passes the factor that makes L −1: the number of turns around
    /// −1 changes.
    pub(super) fn crosses_at(&self, angle_rad: f64) -> bool {
        changes_around(&self.parts.over.across(&self.parts.under), angle_rad)
    }

    /// Angles within two ends at which $|L| = 1$: those given, and those that are proved and not among them.
    pub(super) fn unit_gain_angles(&self, given: Vec<f64>, ends: (f64, f64)) -> Vec<f64> {
        let [over, under] = [&self.parts.over, &self.parts.under].map(Real::squared);
        completed(given, ends, &difference(Ball::from(1.0), &over, &under))
    }

    /// Angles within two ends at which L is real, in the same way.
    pub(super) fn real_angles(&self, given: Vec<f64>, ends: (f64, f64)) -> Vec<f64> {
        completed(given, ends, &self.parts.over.across(&self.parts.under))
    }
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

/// A quotient of two polynomials, squares of sizes.
struct Heights<'a> {
    over: &'a [Ball],
    under: &'a [Ball],
}

/// The height at a place.
#[derive(Debug, Clone, Copy)]
struct Height {
    place: f64,
    bracket: Bracket,
}

impl Heights<'_> {
    fn square(&self, place: f64) -> Option<Ball> {
        value_at(self.over, place).over(value_at(self.under, place))
    }

    fn at(&self, place: f64) -> Height {
        let bracket = match self.square(place) {
            Some(square) => Bracket {
                at_least: square.at_least().sqrt() / UP,
                at_most: square.at_most().sqrt() * UP,
            },
            None => Bracket { at_least: 0.0, at_most: f64::INFINITY },
        };
        Height { place, bracket }
    }

    /// From a place that is higher than the best one to the top of its peak.
    fn climb(&self, place: f64, best: Height) -> Height {
        let start = self.at(place);
        if !(place > 0.0 && place.is_finite()) {
            return start;
        }
        let depth = |logarithm: f64| {
            let square = self.square(libm::exp(logarithm)).map_or(0.0, Ball::rounded);
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
        let found =
            bowl::lowest(|at| depth(at).1, [side(-1.0), middle, side(1.0)], f64::NEG_INFINITY);
        let top = self.at(libm::exp(found.0));
        let higher = |one: Height, other: Height| {
            if other.bracket.at_least > one.bracket.at_least { other } else { one }
        };
        higher(best, higher(start, top))
    }
}

/// Angles of zeros of a polynomial: those given, those that are proved and not among them, and in place of given ones
/// that are off by more than 10⁻⁹ those that are proved.
fn completed(mut given: Vec<f64>, ends: (f64, f64), polynomial: &[Ball]) -> Vec<f64> {
    let near = |angle_rad: f64, other: f64| (angle_rad - other).abs() <= SAME_PLACE * other;
    for between in sign::zeros(polynomial) {
        let [low, high] = [between.low, between.high].map(angle_of);
        let mut known = given.iter_mut().filter(|known| {
            low * (1.0 - SAME_PLACE) <= **known && **known <= high * (1.0 + SAME_PLACE)
        });
        let (first, second) = (known.next(), known.next());
        if let (Some(known), None) = (first, second) {
            if !changes_around(polynomial, *known) {
                let angle_rad = angle_of(zero(polynomial, between));
                // Another zero that lies beside is not this one.
                if near(*known, angle_rad) {
                    *known = angle_rad;
                } else if ends.0 <= angle_rad && angle_rad <= ends.1 {
                    given.push(angle_rad);
                }
            }
            continue;
        }
        let angle_rad = angle_of(zero(polynomial, between));
        let inside = ends.0 <= angle_rad && angle_rad <= ends.1;
        if inside && !given.iter().any(|&known| near(angle_rad, known)) {
            given.push(angle_rad);
        }
    }
    given.sort_by(f64::total_cmp);
    given
}

/// Value at a place, over a power of it where it is beyond 1.
fn value_at(polynomial: &[Ball], place: f64) -> Ball {
    if place <= 1.0 {
        real::value(polynomial.iter().rev(), place)
    } else {
        real::value(polynomial.iter(), 1.0 / place)
    }
}

/// Whether a polynomial is proved to change its sign within 10⁻⁹ of an angle.
fn changes_around(polynomial: &[Ball], angle_rad: f64) -> bool {
    let [before, after] = [1.0 - ABOVE, 1.0 + ABOVE]
        .map(|share| value_at(polynomial, place_of((angle_rad * share).min(PI))));
    before.is_positive() && after.is_negative() || before.is_negative() && after.is_positive()
}

/// The zero between two places, by halving; the middle where no sign is told.
fn zero(polynomial: &[Ball], Between { mut low, mut high }: Between) -> f64 {
    let rises = value_at(polynomial, low).is_negative();
    for _ in 0..HALVINGS {
        let middle = super::scan::middle(low, high);
        if !(low < middle && middle < high) {
            break;
        }
        let there = value_at(polynomial, middle);
        if !(there.is_positive() || there.is_negative()) {
            return middle;
        }
        if there.is_negative() == rises { low = middle } else { high = middle }
    }
    super::scan::middle(low, high)
}
