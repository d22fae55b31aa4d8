//! A straight step down.

use super::side::{at_least, up_to_one, width};
use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// 1 up to `shoulder`, straight to 0 at `foot`, 0 beyond:
/// $\mu(x) = \max\left(0, \min\left(1, \frac{f - x}{f - s}\right)\right)$
///
/// If the two are equal it is a jump, and the jump itself has the grade 0: the members
/// [`LinearS`](super::LinearS) and `LinearZ` of the same parameters always add up to 1.
///
/// # Source
/// MATLAB's `linzmf`.
#[derive(Clone, Copy, Debug)]
pub enum LinearZ {}

impl Shape for LinearZ {
    const NAME: &'static str = "linear-z";
    const PARAMS: &'static [Param] = &[
        Param { name: "shoulder", unit: "variable", range: Range::Finite },
        Param { name: "foot", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[shoulder, foot] = params else { return Ok(()) };
        at_least(shoulder, "foot", foot, "a number from shoulder on")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[shoulder, foot] = params else { return S::zero() };
        let share = up_to_one((foot - x) / width(shoulder, foot));
        x.if_less(foot, share, S::zero())
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[shoulder, foot] = params else { return };
        each(Vertex { x: shoulder, grade: 1.0 });
        each(Vertex { x: foot, grade: 0.0 });
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[shoulder, foot] = params else { return None };
        Some(foot - grade * (foot - shoulder))
    }
}
