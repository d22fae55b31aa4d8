//! The logistic step.

use super::side::one_over_one_plus;
use super::{Param, Range, Shape};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \frac{1}{1 + e^{-s(x - c)}}$
///
/// Grade 0.5 at `centre`; it rises if `slope` is above 0 and falls if it is below. The steepest slope is
/// $s/4$.
///
/// # Source
/// MATLAB's `sigmf` (there slope, centre), fuzzylite's `Sigmoid`, jFuzzyLogic's `SIGM`.
#[derive(Clone, Copy, Debug)]
pub enum Sigmoid {}

impl Shape for Sigmoid {
    const NAME: &'static str = "sigmoid";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "slope", unit: "1/variable", range: Range::NonZero },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 2.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[centre, slope] = params else { return S::zero() };
        one_over_one_plus((-slope * (x - centre)).exp())
    }

    /// Infinite for the grades 0 and 1.
    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let &[centre, slope] = params else { return None };
        Some(centre - (S::one() / grade - S::one()).ln() / slope)
    }
}
