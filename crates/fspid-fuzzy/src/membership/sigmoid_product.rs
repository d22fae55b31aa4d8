//! The product of two logistic steps.

use super::{Param, Range, Shape, Sigmoid};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \frac{1}{1 + e^{-s_l(x - c_l)}} \cdot \frac{1}{1 + e^{-s_r(x - c_r)}}$
///
/// For a hump the left slope is above 0 and the right one below.
///
/// # Source
/// MATLAB's `psigmf` (there slope, centre, slope, centre), fuzzylite's `SigmoidProduct` (there left,
/// rising, falling, right).
#[derive(Clone, Copy, Debug)]
pub enum SigmoidProduct {}

impl Shape for SigmoidProduct {
    const NAME: &'static str = "sigmoid-product";
    const PARAMS: &'static [Param] = &[
        Param { name: "left_centre", unit: "variable", range: Range::Finite },
        Param { name: "left_slope", unit: "1/variable", range: Range::NonZero },
        Param { name: "right_centre", unit: "variable", range: Range::Finite },
        Param { name: "right_slope", unit: "1/variable", range: Range::NonZero },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 10.0, 1.0, -10.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left_centre, left_slope, right_centre, right_slope] = params else {
            return S::zero();
        };
        let left = Sigmoid::grade(&[left_centre, left_slope], x);
        left * Sigmoid::grade(&[right_centre, right_slope], x)
    }
}
