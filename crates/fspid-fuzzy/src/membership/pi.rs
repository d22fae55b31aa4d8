//! A smooth step up, a plateau, a smooth step down.

use super::side::at_least;
use super::{Param, Range, Shape, SmoothS, SmoothZ};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// The product of a [`SmoothS`](super::SmoothS) from `left_foot` to `left_top` and a
/// [`SmoothZ`](super::SmoothZ) from `right_top` to `right_foot`.
///
/// The tops may be crossed; the grade then stays below 1.
///
/// # Source
/// MATLAB's `pimf`, fuzzylite's `PiShape`.
#[derive(Clone, Copy, Debug)]
pub enum Pi {}

impl Shape for Pi {
    const NAME: &'static str = "pi";
    const PARAMS: &'static [Param] = &[
        Param { name: "left_foot", unit: "variable", range: Range::Finite },
        Param { name: "left_top", unit: "variable", range: Range::Finite },
        Param { name: "right_top", unit: "variable", range: Range::Finite },
        Param { name: "right_foot", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-2.0, -1.0, 0.0, 2.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[left_foot, left_top, right_top, right_foot] = params else { return Ok(()) };
        at_least(left_foot, "left_top", left_top, "a number from left_foot on")?;
        at_least(right_top, "right_foot", right_foot, "a number from right_top on")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left_foot, left_top, right_top, right_foot] = params else { return S::zero() };
        SmoothS::grade(&[left_foot, left_top], x) * SmoothZ::grade(&[right_top, right_foot], x)
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.chunks_exact(2).for_each(|ends| SmoothS::corners(ends, each));
    }
}
