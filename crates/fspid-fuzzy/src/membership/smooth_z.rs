//! A smooth step down.

use super::side::{fall, near, smooth, smooth_inverse, step_ends};
use super::{Param, Range, Shape};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// 1 up to `shoulder`, two parabolas that meet in the middle, 0 from `foot` on; with
/// $t = \frac{f - x}{f - s}$: $\mu(x) = 1 - 2(1 - t)^2$ for $\frac12 \le t \le 1$ and $2t^2$ for
/// $0 \le t < \frac12$
///
/// If `shoulder` is not below `foot` it is a jump in the middle of the two, and the jump itself has the
/// grade 1.
///
/// # Source
/// MATLAB's `zmf`, fuzzylite's `ZShape`.
#[derive(Clone, Copy, Debug)]
pub enum SmoothZ {}

impl Shape for SmoothZ {
    const NAME: &'static str = "smooth-z";
    const PARAMS: &'static [Param] = &[
        Param { name: "shoulder", unit: "variable", range: Range::Finite },
        Param { name: "foot", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[shoulder, foot] = params else { return Ok(()) };
        near(shoulder, "foot", foot, "a finite number within 1.7e308 of shoulder")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[shoulder, foot] = params else { return S::zero() };
        let (from, to) = step_ends(shoulder, foot);
        smooth(fall(x, from, to))
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        let &[shoulder, foot] = params else { return };
        let (from, to) = step_ends(shoulder, foot);
        [from, 0.5 * from + 0.5 * to, to].into_iter().for_each(each);
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[shoulder, foot] = params else { return None };
        let (from, to) = step_ends(shoulder, foot);
        Some(to - smooth_inverse(grade) * (to - from))
    }
}
