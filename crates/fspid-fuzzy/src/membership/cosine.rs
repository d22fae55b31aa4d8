//! One period of a raised cosine.

use super::{Param, Range, Shape};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \frac12\left(1 + \cos\frac{2\pi(x - c)}{w}\right)$ for $|x - c| < \frac w2$, else 0
///
/// Written as $\cos^2\frac{\pi(x - c)}{w}$, which is the same and cannot leave [0, 1].
///
/// # Source
/// fuzzylite's `Cosine`; jFuzzyLogic's `COSINE` with half the width.
#[derive(Clone, Copy, Debug)]
pub enum Cosine {}

impl Shape for Cosine {
    const NAME: &'static str = "cosine";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "width", unit: "variable", range: Range::Positive },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 2.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[centre, width] = params else { return S::zero() };
        let periods = ((x - centre).abs() / width).smaller(S::half());
        let inside = (S::constant(core::f64::consts::PI) * periods).cos().square();
        periods.if_less(S::half(), inside, S::zero())
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        let &[centre, width] = params else { return };
        each(centre - 0.5 * width);
        each(centre + 0.5 * width);
    }
}
