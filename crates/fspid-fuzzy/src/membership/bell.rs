//! The generalised bell.

use super::side::one_over_one_plus;
use super::{Param, Range, Shape};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \frac{1}{1 + \left|\frac{x - c}{w}\right|^{2s}}$
///
/// Grade 0.5 at $c \pm w$; a `slope` below 0 turns the bell upside down.
///
/// # Source
/// MATLAB's `gbellmf` (there width, slope, centre), fuzzylite's `Bell`; Jang, *ANFIS*, 1993.
#[derive(Clone, Copy, Debug)]
pub enum Bell {}

impl Shape for Bell {
    const NAME: &'static str = "bell";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "width", unit: "variable", range: Range::NonZero },
        Param { name: "slope", unit: "1", range: Range::NonZero },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 1.0, 2.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[centre, width, slope] = params else { return S::zero() };
        let distance = ((x - centre) / width).abs();
        one_over_one_plus(distance.pow(S::constant(2.0) * slope))
    }

    /// The centre: smooth there only if $2s$ is a whole even number.
    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.first().into_iter().for_each(|&centre| each(centre));
    }
}
