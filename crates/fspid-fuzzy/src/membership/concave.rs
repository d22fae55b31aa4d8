//! A hyperbola that rises to a shoulder, or falls from one.

use super::side::{apart, beyond};
use super::{Param, Range, Shape};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \frac{1}{1 + \max\left(0, \frac{e - x}{e - i}\right)}$
///
/// Grade 0.5 at `inflection`, 1 at `end` and beyond; it rises if `inflection` is below `end` and falls
/// if it is above. The grade comes near 0 but does not reach it.
///
/// # Source
/// fuzzylite's `Concave`, $\frac{e - i}{2e - i - x}$ there.
#[derive(Clone, Copy, Debug)]
pub enum Concave {}

impl Shape for Concave {
    const NAME: &'static str = "concave";
    const PARAMS: &'static [Param] = &[
        Param { name: "inflection", unit: "variable", range: Range::Finite },
        Param { name: "end", unit: "variable", range: Range::Finite },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0];

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[inflection, end] = params else { return Ok(()) };
        apart(inflection, "end", end, "a number other than inflection, within 1.7e308 of it")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[inflection, end] = params else { return S::zero() };
        S::one() / (S::one() + beyond((end - x) / (end - inflection)))
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.last().into_iter().for_each(|&end| each(end));
    }

    /// Infinite for a grade of 0.
    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[inflection, end] = params else { return None };
        Some(end - (end - inflection) * (S::one() / grade - S::one()))
    }
}
