//! Uniform numbers, and numbers whose logarithm is uniform.

use super::error::DispersionError;
use super::normal::finite;

/// All numbers between two limits, equally likely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    lower: f64,
    upper: f64,
}

impl Uniform {
    /// The distribution between two limits.
    ///
    /// # Errors
    /// [`DispersionError`] for limits that are not finite or not in order, or whose difference is
    /// not finite.
    pub fn new(lower: f64, upper: f64) -> Result<Self, DispersionError> {
        ordered(lower, upper)?;
        if !(upper - lower).is_finite() {
            return Err(DispersionError::BeyondRange { what: "uniform distribution" });
        }
        Ok(Self { lower, upper })
    }

    /// Lower limit.
    #[must_use]
    pub const fn lower(&self) -> f64 {
        self.lower
    }

    /// Upper limit.
    #[must_use]
    pub const fn upper(&self) -> f64 {
        self.upper
    }

    /// The value below which a share u of the values lies.
    pub(super) fn quantile(&self, u: f64) -> f64 {
        (self.lower + u * (self.upper - self.lower)).clamp(self.lower, self.upper)
    }
}

/// Numbers between two limits whose logarithm is uniform: as many between 1 and 2 as between 2 and
/// 4. Both limits are above 0, or both are below and the size is what is distributed so.
///
/// $$ x = l (h / l)^u $$
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogUniform {
    lower: f64,
    upper: f64,
    /// Half of $\ln (h / l)$.
    half: f64,
}

impl LogUniform {
    /// The distribution between two limits.
    ///
    /// # Errors
    /// [`DispersionError`] for limits that are not finite, not in order, or 0 or of two signs, and
    /// for limits whose ratio 64-bit numbers do not hold even as a square.
    pub fn new(lower: f64, upper: f64) -> Result<Self, DispersionError> {
        ordered(lower, upper)?;
        if !(lower > 0.0 || upper < 0.0) {
            return Err(DispersionError::TwoSigns { lower, upper });
        }
        let half = 0.5 * (libm::log(upper.abs()) - libm::log(lower.abs()));
        if !(libm::exp(half.abs()).is_finite()) {
            return Err(DispersionError::BeyondRange { what: "logarithmic distribution" });
        }
        Ok(Self { lower, upper, half })
    }

    /// Lower limit.
    #[must_use]
    pub const fn lower(&self) -> f64 {
        self.lower
    }

    /// Upper limit.
    #[must_use]
    pub const fn upper(&self) -> f64 {
        self.upper
    }

    /// The value below which a share u of the values lies.
    pub(super) fn quantile(&self, u: f64) -> f64 {
        // In two steps, so that no ratio overflows.
        let step = libm::exp(u * self.half);
        (self.lower * step * step).clamp(self.lower, self.upper)
    }
}

/// Refuses limits that are not finite or not in order.
fn ordered(lower: f64, upper: f64) -> Result<(), DispersionError> {
    finite("lower limit", lower)?;
    finite("upper limit", upper)?;
    if lower < upper { Ok(()) } else { Err(DispersionError::EmptyRange { lower, upper }) }
}
