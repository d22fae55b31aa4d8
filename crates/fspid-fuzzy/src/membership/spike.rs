//! An exponential on either side of a peak.

use super::{Param, Range, Shape};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = e^{-10\left|\frac{x - c}{w}\right|}$
///
/// Grade $e^{-5} = 0.0067$ at the ends of a band of `width` around `centre`.
///
/// # Source
/// fuzzylite's `Spike`.
#[derive(Clone, Copy, Debug)]
pub enum Spike {}

impl Shape for Spike {
    const NAME: &'static str = "spike";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "width", unit: "variable", range: Range::NonZero },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 4.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[centre, width] = params else { return S::zero() };
        (-(S::constant(10.0) * ((x - centre) / width)).abs()).exp()
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.first().into_iter().for_each(|&centre| each(centre));
    }
}
