//! The triangle, also lopsided, and with a vertical side where two corners meet.

use super::side::{above, at_least, fall, rise};
use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// Rises from `left` to 1 at `peak` and falls to `right`:
/// $\mu(x) = \max\left(0, \min\left(\frac{x - l}{p - l}, \frac{r - x}{r - p}\right)\right)$
///
/// A side of no width is a jump; the peak itself belongs to the set.
///
/// # Source
/// MATLAB's `trimf`, fuzzylite's `Triangle`, jFuzzyLogic's `TRIAN`.
#[derive(Clone, Copy, Debug)]
pub enum Triangle {}

impl Shape for Triangle {
    const NAME: &'static str = "triangle";
    const PARAMS: &'static [Param] = &[
        Param { name: "left", unit: "variable", range: Range::Finite },
        Param { name: "peak", unit: "variable", range: Range::Finite },
        Param { name: "right", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 0.0, 2.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[left, peak, right] = params else { return Ok(()) };
        at_least(left, "peak", peak, "a number from left on")?;
        at_least(peak, "right", right, "a number from peak on")?;
        above(left, "right", right, "a number above left, at most left + 1.7e308")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left, peak, right] = params else { return S::zero() };
        rise(x, left, peak).smaller(fall(x, peak, right))
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[left, peak, right] = params else { return };
        each(Vertex { x: left, grade: 0.0 });
        each(Vertex { x: peak, grade: 1.0 });
        each(Vertex { x: right, grade: 0.0 });
    }
}
