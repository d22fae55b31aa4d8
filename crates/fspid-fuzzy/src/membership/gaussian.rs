//! The bell curve of the paper's inputs.

use super::{Param, Range, Shape, checked};
use crate::error::FuzzyError;
use crate::lanes::{Lanes, One};
use crate::real::Real;

/// Width of Gaussian sets, as a fraction of their spacing, at which neighbours cross at 0.5:
/// $1 / (2 \sqrt{2 \ln 2})$.
pub(crate) const SIGMA_PER_SPACING: f64 = 0.424_660_900_144_009_53;

/// $\mu(x) = e^{-\frac12 \left(\frac{x - c}{\sigma}\right)^2}$
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaussian<R> {
    centre: R,
    sigma: R,
}

impl<R: Real> Gaussian<R> {
    /// The set whose equal neighbours, `spacing` away on each side, cross it at a grade of 0.5.
    pub(crate) fn spaced(centre: R, spacing: R) -> Self {
        Self { centre, sigma: spacing * R::from_f64(SIGMA_PER_SPACING) }
    }

    /// What the exponential is taken of, in each lane.
    #[inline(always)]
    pub(crate) fn exponent<L: Lanes<Number = R>>(&self, x: L) -> L {
        let z = (x - x.same(self.centre)) / x.same(self.sigma);
        x.same(-R::HALF) * (z * z)
    }
}

impl<R: Real> Shape<R> for Gaussian<R> {
    const NAME: &'static str = "gaussian";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "sigma", unit: "variable", range: Range::Positive },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 1.0];
    const C: &'static str = "exp(-0.5 * ((x - centre) / sigma) * ((x - centre) / sigma))";

    fn new(params: &[f64]) -> Result<Self, FuzzyError> {
        let [centre, sigma] = checked::<R, Self, 2>(params)?;
        Ok(Self { centre, sigma })
    }

    fn grade(&self, x: R) -> R {
        let One(exponent) = self.exponent(One(x));
        exponent.exp()
    }
}
