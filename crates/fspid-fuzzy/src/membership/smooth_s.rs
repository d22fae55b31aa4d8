//! A smooth step up.

use super::side::{near, rise, smooth, smooth_inverse, step_ends};
use super::{Param, Range, Shape};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// 0 up to `foot`, two parabolas that meet in the middle, 1 from `shoulder` on; with
/// $t = \frac{x - f}{s - f}$: $\mu(x) = 2t^2$ for $0 \le t < \frac12$ and $1 - 2(1 - t)^2$ for
/// $\frac12 \le t \le 1$
///
/// If `foot` is not below `shoulder` it is a jump in the middle of the two, and the jump itself has the
/// grade 1.
///
/// # Source
/// MATLAB's `smf`, fuzzylite's `SShape`.
#[derive(Clone, Copy, Debug)]
pub enum SmoothS {}

impl Shape for SmoothS {
    const NAME: &'static str = "smooth-s";
    const PARAMS: &'static [Param] = &[
        Param { name: "foot", unit: "variable", range: Range::Finite },
        Param { name: "shoulder", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[foot, shoulder] = params else { return Ok(()) };
        near(foot, "shoulder", shoulder, "a finite number within 1.7e308 of foot")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[foot, shoulder] = params else { return S::zero() };
        let (from, to) = step_ends(foot, shoulder);
        smooth(rise(x, from, to))
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        let &[foot, shoulder] = params else { return };
        let (from, to) = step_ends(foot, shoulder);
        [from, 0.5 * from + 0.5 * to, to].into_iter().for_each(each);
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[foot, shoulder] = params else { return None };
        let (from, to) = step_ends(foot, shoulder);
        Some(from + smooth_inverse(grade) * (to - from))
    }
}
