//! A crisp set with its ends.

use super::side::{above, refuse};
use super::{Param, Range, Shape, Vertex, finite_vertices};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = 1$ for $s \le x \le e$, else 0
///
/// Both ends belong to the set; either may be infinite. (A set without any end holds NaN too.)
///
/// # Source
/// fuzzylite's `Rectangle`.
#[derive(Clone, Copy, Debug)]
pub enum Rectangle {}

impl Shape for Rectangle {
    const NAME: &'static str = "rectangle";
    const PARAMS: &'static [Param] = &[
        Param { name: "start", unit: "variable", range: Range::Extended },
        Param { name: "end", unit: "variable", range: Range::Extended },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[start, end] = params else { return Ok(()) };
        if start == f64::INFINITY {
            return refuse("start", start, "a number below inf");
        }
        above(f64::NEG_INFINITY, "end", end, "a number above -inf, at least start")?;
        if start <= end {
            Ok(())
        } else {
            refuse("end", end, "a number above -inf, at least start")
        }
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[start, end] = params else { return S::zero() };
        let from_below = x.larger(S::constant(f64::NEG_INFINITY));
        let from_above = x.smaller(S::constant(f64::INFINITY));
        let below_end = end.if_less(from_above, S::zero(), S::one());
        from_below.if_less(start, S::zero(), below_end)
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[start, end] = params else { return };
        finite_vertices([(start, 0.0), (start, 1.0), (end, 1.0), (end, 0.0)], each);
    }
}
