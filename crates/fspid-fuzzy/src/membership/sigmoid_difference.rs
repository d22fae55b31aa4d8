//! How far two logistic steps are apart.

use super::{Param, Range, Shape, Sigmoid};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \left|\frac{1}{1 + e^{-s_l(x - c_l)}} - \frac{1}{1 + e^{-s_r(x - c_r)}}\right|$
///
/// The right step is subtracted, so for a hump both slopes have the same sign.
///
/// # Source
/// MATLAB's `dsigmf` (there slope, centre, slope, centre), fuzzylite's `SigmoidDifference` (there left,
/// rising, falling, right), jFuzzyLogic's `DSIGM`. Documented there without the magnitude; where that
/// makes a difference the documented grade would be below 0.
#[derive(Clone, Copy, Debug)]
pub enum SigmoidDifference {}

impl Shape for SigmoidDifference {
    const NAME: &'static str = "sigmoid-difference";
    const PARAMS: &'static [Param] = &[
        Param { name: "left_centre", unit: "variable", range: Range::Finite },
        Param { name: "left_slope", unit: "1/variable", range: Range::NonZero },
        Param { name: "right_centre", unit: "variable", range: Range::Finite },
        Param { name: "right_slope", unit: "1/variable", range: Range::NonZero },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 10.0, 1.0, 10.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left_centre, left_slope, right_centre, right_slope] = params else {
            return S::zero();
        };
        let left = Sigmoid::grade(&[left_centre, left_slope], x);
        (left - Sigmoid::grade(&[right_centre, right_slope], x)).abs()
    }

    /// Where the two steps cross, if they do.
    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        let &[left_centre, left_slope, right_centre, right_slope] = params else { return };
        let share = right_slope / (left_slope - right_slope);
        let crossing = left_centre + share * (left_centre - right_centre);
        if crossing.is_finite() {
            each(crossing);
        }
    }
}
