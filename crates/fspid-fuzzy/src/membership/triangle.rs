//! The symmetric triangle of the paper's outputs.

use super::{Param, Range, Shape, checked};
use crate::error::FuzzyError;
use crate::real::Real;

/// $\mu(x) = \max\left(0, 1 - \frac{|x - c|}{w}\right)$
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<R> {
    centre: R,
    half_width: R,
}

impl<R: Real> Shape<R> for Triangle<R> {
    const NAME: &'static str = "triangle";
    const PARAMS: &'static [Param] = &[
        Param { name: "centre", unit: "variable", range: Range::Finite },
        Param { name: "half_width", unit: "variable", range: Range::Positive },
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 1.0];
    const C: &'static str = "fmax(0.0, 1.0 - fabs(x - centre) / half_width)";

    fn new(params: &[f64]) -> Result<Self, FuzzyError> {
        let [centre, half_width] = checked::<R, Self, 2>(params)?;
        Ok(Self { centre, half_width })
    }

    fn grade(&self, x: R) -> R {
        (R::ONE - (x - self.centre).abs() / self.half_width).larger(R::ZERO)
    }
}
