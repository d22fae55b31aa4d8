//! The triangle, also lopsided, and with a vertical side where two corners meet.

use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use crate::scalar::Scalar;

/// Rises from `left` to 1 at `peak` and falls to `right`:
/// $\mu(x) = \max\left(0, \min\left(\frac{x - l}{p - l}, \frac{r - x}{r - p}\right)\right)$
///
/// A side of no width is a jump; the peak itself belongs to the set.
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
    const C: &'static str = "x < peak ? fmax(0.0, (x - left) / (peak - left)) : \
                             peak < x ? fmax(0.0, (right - x) / (right - peak)) : 1.0";
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[left, peak, right] = params else { return Ok(()) };
        let wrong = |name, found, allowed| Err(FuzzyError::Parameter { name, found, allowed });
        if left > peak {
            return wrong("peak", peak, "a finite number, at least left");
        }
        if peak > right {
            return wrong("right", right, "a finite number, at least peak");
        }
        if left < right { Ok(()) } else { wrong("right", right, "a finite number above left") }
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left, peak, right] = params else { return S::zero() };
        let rise = ((x - left) / (peak - left)).larger(S::zero());
        let fall = ((right - x) / (right - peak)).larger(S::zero());
        x.if_less(peak, rise, peak.if_less(x, fall, S::one()))
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[left, peak, right] = params else { return };
        each(Vertex { x: left, grade: 0.0 });
        each(Vertex { x: peak, grade: 1.0 });
        each(Vertex { x: right, grade: 0.0 });
    }
}
