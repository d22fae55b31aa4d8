//! A single point.

use super::{Param, Range, Shape, Vertex};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = 1$ for $x = v$, else 0
///
/// A set without area: its use is on the output, where methods for singletons weigh `value` itself.
///
/// # Source
/// IEC 61131-7, singleton terms; jFuzzyLogic's `SINGLETON`.
#[derive(Clone, Copy, Debug)]
pub enum Singleton {}

impl Shape for Singleton {
    const NAME: &'static str = "singleton";
    const PARAMS: &'static [Param] =
        &[Param { name: "value", unit: "variable", range: Range::Finite }];
    const EXAMPLE: &'static [f64] = &[0.0];
    const PIECEWISE_LINEAR: bool = true;

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[value] = params else { return S::zero() };
        let x = x.smaller(S::constant(f64::INFINITY));
        x.if_less(value, S::zero(), value.if_less(x, S::zero(), S::one()))
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[value] = params else { return };
        [0.0, 1.0, 0.0].into_iter().for_each(|grade| each(Vertex { x: value, grade }));
    }
}
