//! A straight step up.

use super::side::{at_least, rise};
use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// 0 up to `foot`, straight to 1 at `shoulder`, 1 beyond:
/// $\mu(x) = \max\left(0, \min\left(1, \frac{x - f}{s - f}\right)\right)$
///
/// If the two are equal it is a jump, and the jump itself has the grade 1.
///
/// # Source
/// MATLAB's `linsmf`.
#[derive(Clone, Copy, Debug)]
pub enum LinearS {}

impl Shape for LinearS {
    const NAME: &'static str = "linear-s";
    const PARAMS: &'static [Param] = &[
        Param { name: "foot", unit: "variable", range: Range::Finite },
        Param { name: "shoulder", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[foot, shoulder] = params else { return Ok(()) };
        at_least(foot, "shoulder", shoulder, "a number from foot on")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[foot, shoulder] = params else { return S::zero() };
        rise(x, foot, shoulder)
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[foot, shoulder] = params else { return };
        each(Vertex { x: foot, grade: 0.0 });
        each(Vertex { x: shoulder, grade: 1.0 });
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[foot, shoulder] = params else { return None };
        Some(foot + grade * (shoulder - foot))
    }
}
