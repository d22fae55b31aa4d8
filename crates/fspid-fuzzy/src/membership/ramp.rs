//! A straight step in either direction.

use super::side::apart;
use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// 0 at `start` and before, straight to 1 at `end`, 1 beyond:
/// $\mu(x) = \max\left(0, \min\left(1, \frac{x - s}{e - s}\right)\right)$
///
/// It rises if `start` is below `end` and falls if it is above.
///
/// # Source
/// fuzzylite's `Ramp`.
#[derive(Clone, Copy, Debug)]
pub enum Ramp {}

impl Shape for Ramp {
    const NAME: &'static str = "ramp";
    const PARAMS: &'static [Param] = &[
        Param { name: "start", unit: "variable", range: Range::Finite },
        Param { name: "end", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[start, end] = params else { return Ok(()) };
        apart(start, "end", end, "a number other than start, within 1.7e308 of it")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[start, end] = params else { return S::zero() };
        ((x - start) / (end - start)).unit()
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[start, end] = params else { return };
        let (low, high) = (Vertex { x: start, grade: 0.0 }, Vertex { x: end, grade: 1.0 });
        let [left, right] = if start < end { [low, high] } else { [high, low] };
        each(left);
        each(right);
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[start, end] = params else { return None };
        Some(start + grade * (end - start))
    }
}
