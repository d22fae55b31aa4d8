//! A quarter of an ellipse, rising or falling.

use super::side::{apart, root, up_to_one};
use super::{Param, Range, Shape};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// From 0 at `start` along a quarter of an ellipse to 1 at `end`, level beyond both:
/// $\mu(x) = \sqrt{1 - z^2}, \quad z = \min\left(1, \max\left(0, \frac{e - x}{e - s}\right)\right)$
///
/// It rises if `start` is below `end` and falls if it is above.
///
/// # Source
/// fuzzylite's `Arc`, with centre $c = e$ and radius $r = e - s$ there.
#[derive(Clone, Copy, Debug)]
pub enum Arc {}

impl Shape for Arc {
    const NAME: &'static str = "arc";
    const PARAMS: &'static [Param] = &[
        Param { name: "start", unit: "variable", range: Range::Finite },
        Param { name: "end", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[start, end] = params else { return Ok(()) };
        apart(start, "end", end, "a number other than start, within 1.7e308 of it")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[start, end] = params else { return S::zero() };
        let z = up_to_one((end - x) / (end - start));
        root(S::one() - z.square())
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.iter().for_each(|&end| each(end));
    }

    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[start, end] = params else { return None };
        Some(end - (end - start) * root(S::one() - grade.square()))
    }
}
