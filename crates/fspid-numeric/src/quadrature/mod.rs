//! Certified integrals: area and first moment of a curve with bounds that hold, rounding included.
//!
//! Output sets with curved sides have no centroid in closed form. Here their area and moment are
//! integrated adaptively, without a heap, and come with an error bound that is proved by interval
//! arithmetic rather than estimated from two rules:
//!
//! - where the curve is smooth, ten points of Gauss and Legendre, evaluated in intervals, plus their
//!   remainder from an enclosure of the 20th Taylor coefficient over the whole panel;
//! - around a kink or a jump, a short panel whose integral lies between its width times the least
//!   and the greatest value.
//!
//! Where kinks lie is guessed with floats, which costs nothing if wrong but more panels. A kink
//! enclosed in a panel of width $w$ adds an error of the order $w^2$.
//!
//! The bounds rest on what [`Interval`] rests on, and on a fingerprint of 64 bits that tells when two
//! cases of a maximum are the same function. Where two different sets touch without crossing, many
//! panels are needed; when they run out the bounds are wide, and the answer says so.
//!
//! ```
//! use fspid_numeric::quadrature::{Curve, Quadrature};
//! use fspid_numeric::scalar::Scalar;
//!
//! /// A bell cut at one half.
//! struct Clipped;
//! impl Curve for Clipped {
//!     fn at<S: Scalar>(&self, x: S) -> S {
//!         (-(x - S::one()).square()).exp().smaller(S::half())
//!     }
//! }
//!
//! let over = Quadrature::new(-9.0, 11.0).expect("finite and in order");
//! let centroid = over.integrate(&Clipped).centroid().expect("some area");
//! assert!(centroid.contains(1.0) && centroid.width() < 1e-12);
//! ```
//!
//! # Source
//! W. Tucker, *Validated Numerics*, Princeton 2011, section 5.3; Corliss and Rall, *Adaptive,
//! self-validating numerical quadrature*, SIAM J. Sci. Stat. Comput. 8 (1987) 831.

mod adaptive;
mod bisector;
mod gauss;
mod panel;
mod piece;
mod span;

use crate::scalar::{Interval, Scalar};
use adaptive::Work;
use span::{Moments, Span};

/// A function of one variable, written once for all kinds of numbers.
pub trait Curve {
    /// The value at `x`.
    fn at<S: Scalar>(&self, x: S) -> S;
}

/// Attempts, each with half of the panels that are left and what was learnt from the one before.
const ATTEMPTS: u32 = 5;
/// How much coarser the next attempt is if the panels did not suffice.
const COARSER: f64 = 1e3;
/// Samples of the first guess of the area, which the relative tolerance refers to.
const GUESS_SAMPLES: u32 = 64;

/// What bound is aimed at, and how much work may be done for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Error of the area as a share of the area; of the moment, as that of half the domain's width.
    pub relative: f64,
    /// An error of the area that is small enough at any rate.
    pub absolute: f64,
    /// Panels after which the rest is enclosed coarsely.
    pub panels: u32,
}

impl Accuracy {
    /// What is aimed at unless said otherwise.
    pub const USUAL: Self = Self { relative: 1e-13, absolute: f64::MIN_POSITIVE, panels: 10_000 };
}

impl Default for Accuracy {
    fn default() -> Self {
        Self::USUAL
    }
}

/// A domain to integrate over.
#[derive(Clone, Copy, Debug)]
pub struct Quadrature<'a> {
    lower: f64,
    upper: f64,
    corners: &'a [f64],
    accuracy: Accuracy,
}

/// The integrals of a curve: intervals that hold the true values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrals {
    /// $\int f(x) \ dx$
    pub area: Interval,
    /// $\int (x - a) f(x) \ dx$ about the middle $a$ of the domain.
    pub moment: Interval,
    /// The point $a$.
    pub about: f64,
    /// Panels looked at.
    pub panels: u32,
    /// True if the bounds are as narrow as was asked for; they hold in any case.
    pub complete: bool,
}

impl Integrals {
    /// Before anything was looked at.
    const UNKNOWN: Self = Self {
        area: Interval::ENTIRE,
        moment: Interval::ENTIRE,
        about: 0.0,
        panels: 0,
        complete: false,
    };

    /// The centre of gravity; `None` if the area may be zero.
    #[must_use]
    pub fn centroid(&self) -> Option<Interval> {
        let some = !self.area.contains(0.0);
        some.then(|| Interval::point(self.about) + self.moment / self.area)
    }

    /// $\int x f(x) \ dx$; wider than [`moment`](Self::moment) where the domain is far from zero.
    #[must_use]
    pub fn moment_about_zero(&self) -> Interval {
        self.moment + Interval::point(self.about) * self.area
    }
}

impl<'a> Quadrature<'a> {
    /// Integrals from `lower` to `upper`; `None` unless both are finite and in order.
    #[must_use]
    pub const fn new(lower: f64, upper: f64) -> Option<Self> {
        if !(lower <= upper && lower.is_finite() && (upper - lower).is_finite()) {
            return None;
        }
        Some(Self { lower, upper, corners: &[], accuracy: Accuracy::USUAL })
    }

    /// Hints where the curve has kinks or jumps, in ascending order. Those outside of the domain are
    /// passed over; wrong ones cost a little time.
    #[must_use]
    pub const fn with_corners(self, corners: &'a [f64]) -> Self {
        Self { corners, ..self }
    }

    /// With another aim.
    #[must_use]
    pub const fn with_accuracy(self, accuracy: Accuracy) -> Self {
        Self { accuracy, ..self }
    }

    /// Area and first moment of a curve.
    #[must_use]
    pub fn integrate<C: Curve>(&self, curve: &C) -> Integrals {
        let (mut tolerance, mut best) = (self.tolerance(curve), Integrals::UNKNOWN);
        for _ in 0..ATTEMPTS {
            let panels = (self.accuracy.panels - best.panels).div_ceil(2);
            let next = self.attempt(curve, tolerance, panels);
            best = self.common(next, best);
            if best.complete || best.panels == self.accuracy.panels {
                break;
            }
            tolerance *= if next.panels == panels {
                COARSER
            } else {
                // Many kinks together, or a first guess of the area that was too high.
                0.5 * (self.allowed(best.area) / best.area.radius()).smaller(1.0)
            };
        }
        best
    }

    /// The error allowed for the area, from a guess of it.
    fn tolerance<C: Curve>(&self, curve: &C) -> f64 {
        let step = (self.upper - self.lower) / f64::from(GUESS_SAMPLES);
        let sample = |k: u32| curve.at(self.lower + (f64::from(k) + 0.5) * step);
        let guess = (0..GUESS_SAMPLES).map(sample).fold(0.0, |sum, value| sum + step * value.abs());
        self.accuracy.absolute.larger(self.accuracy.relative * guess)
    }

    /// The error allowed for the area, by its enclosure.
    fn allowed(&self, area: Interval) -> f64 {
        self.accuracy.absolute.larger(self.accuracy.relative * area.magnitude())
    }

    /// Whether the integrals are as good as was asked for.
    fn is_complete(&self, sums: Moments) -> bool {
        let allowed = self.allowed(sums.area);
        let by_width = 0.5 * allowed * (self.upper - self.lower);
        let narrow = sums.area.radius() <= allowed && sums.moment.radius() <= by_width;
        narrow && sums.area.is_bounded()
    }

    /// The integrals with that error in mind for the area and at most so many panels.
    fn attempt<C: Curve>(&self, curve: &C, tolerance: f64, panels: u32) -> Integrals {
        let width = self.upper - self.lower;
        let about = Interval::between(self.lower, self.upper).midpoint();
        let sum = Moments::NONE;
        let mut work = Work { curve, tolerance, width, panels_left: panels, sum };
        let mut lower = self.lower;
        for &corner in self.corners.iter().chain(&[self.upper]) {
            let upper = corner.smaller(self.upper);
            if lower < upper {
                work.add(Span { lower, upper, about });
                lower = upper;
            }
        }
        let (sum, panels) = (work.sum, panels - work.panels_left);
        let complete = self.is_complete(sum);
        Integrals { area: sum.area, moment: sum.moment, about, panels, complete }
    }

    /// What two results say together.
    fn common(&self, one: Integrals, other: Integrals) -> Integrals {
        let area = one.area.intersection(other.area).unwrap_or(other.area);
        let moment = one.moment.intersection(other.moment).unwrap_or(other.moment);
        let complete = self.is_complete(Moments { area, moment });
        Integrals { area, moment, panels: one.panels + other.panels, complete, ..one }
    }
}
