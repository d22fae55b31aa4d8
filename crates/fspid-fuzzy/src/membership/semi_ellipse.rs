//! The upper half of an ellipse.

use super::side::{above, root};
use super::{Param, Range, Shape};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \sqrt{1 - z^2}, \quad z = \frac{x - c}{r}, \quad c = \frac{s + e}{2}, \quad
/// r = \frac{e - s}{2}$ for $|z| < 1$, else 0
///
/// # Source
/// fuzzylite's `SemiEllipse`.
#[derive(Clone, Copy, Debug)]
pub enum SemiEllipse {}

impl Shape for SemiEllipse {
    const NAME: &'static str = "semi-ellipse";
    const PARAMS: &'static [Param] = &[
        Param { name: "start", unit: "variable", range: Range::Finite },
        Param { name: "end", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[start, end] = params else { return Ok(()) };
        above(start, "end", end, "a number above start, at most start + 1.7e308")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[start, end] = params else { return S::zero() };
        let centre = S::half() * start + S::half() * end;
        let z = ((x - centre).abs() / (S::half() * (end - start))).smaller(S::one());
        root(S::one() - z.square())
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.iter().for_each(|&end| each(end));
    }
}
