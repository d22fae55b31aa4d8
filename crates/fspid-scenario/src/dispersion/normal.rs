//! Normal numbers, truncated or not.

use super::error::DispersionError;
use super::standard_normal::{LEAST_INSIDE, above, below, quantile};

/// Standard deviations beyond which no number goes: the probability of one that does, 5e-308, is
/// about the smallest that has all its digits.
const FARTHEST: f64 = 37.5;

/// A normal distribution, with a limit on either side if asked for: what lies beyond does not
/// come, and the rest comes in the same proportions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    mean: f64,
    standard_deviation: f64,
    /// Limits, infinite where there is none.
    lower: f64,
    upper: f64,
    /// Shares of the whole distribution below, between and above the limits.
    below: f64,
    inside: f64,
    above: f64,
}

impl Normal {
    /// The distribution with this mean and standard deviation, without limits.
    ///
    /// # Errors
    /// [`DispersionError`] for numbers that are not finite, a standard deviation that is not
    /// positive, and values that 64-bit numbers do not hold.
    pub fn new(mean: f64, standard_deviation: f64) -> Result<Self, DispersionError> {
        finite("mean", mean)?;
        finite("standard deviation", standard_deviation)?;
        if !(standard_deviation > 0.0) {
            return Err(DispersionError::StandardDeviation { value: standard_deviation });
        }
        if !(mean.abs() + FARTHEST * standard_deviation).is_finite() {
            return Err(DispersionError::BeyondRange { what: "normal distribution" });
        }
        let (lower, upper) = (f64::NEG_INFINITY, f64::INFINITY);
        Ok(Self { mean, standard_deviation, lower, upper, below: 0.0, inside: 1.0, above: 0.0 })
    }

    /// The same distribution between limits; `None` leaves its side open.
    ///
    /// # Errors
    /// [`DispersionError`] for limits that are not finite or not in order, and for limits between
    /// which less than 1e-300 of the distribution lies.
    pub fn truncated(
        self,
        lower: Option<f64>,
        upper: Option<f64>,
    ) -> Result<Self, DispersionError> {
        let limit = |what, limit: Option<f64>, open| limit.map_or(Ok(open), |at| finite(what, at));
        let lower = limit("lower limit", lower, f64::NEG_INFINITY)?;
        let upper = limit("upper limit", upper, f64::INFINITY)?;
        if !(lower < upper) {
            return Err(DispersionError::EmptyRange { lower, upper });
        }
        let [a, b] = [lower, upper].map(|limit| (limit - self.mean) / self.standard_deviation);
        // On the side where the shares are small, so that they keep their digits.
        let inside = if a > 0.0 {
            above(a) - above(b)
        } else if b < 0.0 {
            below(b) - below(a)
        } else {
            1.0 - below(a) - above(b)
        };
        if !(inside >= LEAST_INSIDE) {
            let Self { mean, standard_deviation, .. } = self;
            return Err(DispersionError::NothingInside {
                mean,
                standard_deviation,
                lower,
                upper,
                probability: inside,
            });
        }
        Ok(Self { lower, upper, below: below(a), inside, above: above(b), ..self })
    }

    /// Mean without the limits.
    #[must_use]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation without the limits.
    #[must_use]
    pub const fn standard_deviation(&self) -> f64 {
        self.standard_deviation
    }

    /// Lower limit, if there is one.
    #[must_use]
    pub fn lower(&self) -> Option<f64> {
        self.lower.is_finite().then_some(self.lower)
    }

    /// Upper limit, if there is one.
    #[must_use]
    pub fn upper(&self) -> Option<f64> {
        self.upper.is_finite().then_some(self.upper)
    }

    /// The value below which a share u of the values lies, never outside the limits.
    pub(super) fn quantile(&self, u: f64) -> f64 {
        if self.is_open() { self.at(quantile(u)) } else { self.between(u, 1.0 - u) }
    }

    /// The value that stands where z stands in the standard normal distribution.
    ///
    /// $$ F^{-1}(\Phi(z)) $$
    pub(super) fn at(&self, z: f64) -> f64 {
        let z = z.clamp(-FARTHEST, FARTHEST);
        if self.is_open() {
            self.mean + self.standard_deviation * z
        } else {
            self.between(below(z), above(z))
        }
    }

    /// The limits, or three standard deviations from the mean where a side is open.
    pub(super) fn ends(&self) -> [f64; 2] {
        let end = |limit: Option<f64>, z| limit.unwrap_or_else(|| self.at(z));
        [end(self.lower(), -3.0), end(self.upper(), 3.0)]
    }

    /// Whether there is no limit.
    fn is_open(&self) -> bool {
        self.lower().is_none() && self.upper().is_none()
    }

    /// The value with shares p of the values below and q above it, $p + q = 1$.
    ///
    /// $$ \Phi^{-1}(\Phi(a) + p P), \qquad -\Phi^{-1}(Q(b) + q P) $$
    ///
    /// with the limits a and b in standard deviations, the share P between them, and
    /// $Q = 1 - \Phi$. Of these the one with the smaller probability is taken: it has all its
    /// digits, however far out the limits are.
    fn between(&self, p: f64, q: f64) -> f64 {
        let lower_tail = self.below + p * self.inside;
        let upper_tail = self.above + q * self.inside;
        let z = if lower_tail <= upper_tail { quantile(lower_tail) } else { -quantile(upper_tail) };
        let z = z.clamp(-FARTHEST, FARTHEST);
        (self.mean + self.standard_deviation * z).clamp(self.lower, self.upper)
    }
}

/// The number, if it is finite.
pub(super) fn finite(what: &'static str, value: f64) -> Result<f64, DispersionError> {
    if value.is_finite() { Ok(value) } else { Err(DispersionError::NotFinite { what, value }) }
}
