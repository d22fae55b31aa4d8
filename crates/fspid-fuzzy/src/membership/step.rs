//! A crisp set with one end.

use super::{Param, Range, Shape, Vertex};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = 1$ for $d(x - t) \ge 0$, else 0
///
/// Everything from `threshold` upwards if `direction` is 1, downwards if it is -1; `threshold` belongs
/// to the set.
///
/// # Source
/// fuzzylite's `Binary` (there with the directions `inf` and `-inf`).
#[derive(Clone, Copy, Debug)]
pub enum Step {}

impl Shape for Step {
    const NAME: &'static str = "step";
    const PARAMS: &'static [Param] = &[
        Param { name: "threshold", unit: "variable", range: Range::Finite },
        Param { name: "direction", unit: "1", range: Range::Sign },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 1.0];
    const PIECEWISE_LINEAR: bool = true;

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[threshold, direction] = params else { return S::zero() };
        let inside = (direction * (x - threshold)).larger(S::constant(f64::NEG_INFINITY));
        inside.if_less(S::zero(), S::zero(), S::one())
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[threshold, direction] = params else { return };
        let left = if direction < 0.0 { 1.0 } else { 0.0 };
        each(Vertex { x: threshold, grade: left });
        each(Vertex { x: threshold, grade: 1.0 - left });
    }
}
