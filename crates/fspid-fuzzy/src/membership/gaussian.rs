//! The bell curve of the paper's inputs.

use super::{Param, Range, Shape};
use fspid_numeric::lanes::Lanes;
use fspid_numeric::scalar::Scalar;

/// Width of Gaussian sets, as a fraction of their spacing, at which neighbours cross at 0.5:
/// $1 / (2 \sqrt{2 \ln 2})$.
pub(crate) const SIGMA_PER_SPACING: f64 = 0.424_660_900_144_009_53;

/// $\mu(x) = e^{-\frac12 \left(\frac{x - c}{\sigma}\right)^2}$
#[derive(Clone, Copy, Debug)]
pub enum Gaussian {}

impl Gaussian {
    /// What the exponential is taken of, in each lane: as in [`grade`](Shape::grade).
    #[inline(always)]
    pub(crate) fn exponent<L: Lanes>([centre, sigma]: [L::Number; 2], x: L) -> L {
        let z = (x - x.same(centre)) / x.same(sigma);
        x.same(-<L::Number as fspid_numeric::Real>::HALF) * (z * z)
    }
}

impl Shape for Gaussian {
    const NAME: &'static str = "gaussian";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "sigma", unit: "variable", range: Range::Positive },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 1.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[centre, sigma] = params else { return S::zero() };
        let z = (x - centre) / sigma;
        (-S::half() * z.square()).exp()
    }
}
