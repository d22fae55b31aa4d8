//! Half a bell curve on each side, a plateau between.

use super::side::beyond;
use super::{Param, Range, Shape};
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = e^{-\frac12 (l^2 + r^2)}, \quad l = \max\left(0, \frac{c_l - x}{\sigma_l}\right), \quad
/// r = \max\left(0, \frac{x - c_r}{\sigma_r}\right)$
///
/// The product of a Gaussian left of `left_centre` and one right of `right_centre`, each 1 on its other
/// side. The grade is 1 between the centres; if they are crossed it stays below 1.
///
/// # Source
/// fuzzylite's `GaussianProduct`; MATLAB's `gauss2mf` (there sigma before centre), whose documentation
/// says that the maximum is below 1 when $c_1 > c_2$.
#[derive(Clone, Copy, Debug)]
pub enum GaussianProduct {}

impl Shape for GaussianProduct {
    const NAME: &'static str = "gaussian-product";
    const PARAMS: &'static [Param] = &[
        Param { name: "left_centre", unit: "variable", range: Range::Finite },
        Param { name: "left_sigma", unit: "variable", range: Range::Positive },
        Param { name: "right_centre", unit: "variable", range: Range::Finite },
        Param { name: "right_sigma", unit: "variable", range: Range::Positive },
    ];
    const EXAMPLE: &'static [f64] = &[-1.0, 1.0, 1.0, 2.0];

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left_centre, left_sigma, right_centre, right_sigma] = params else {
            return S::zero();
        };
        let left = beyond((left_centre - x) / left_sigma);
        let right = beyond((x - right_centre) / right_sigma);
        (-S::half() * (left.square() + right.square())).exp()
    }

    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        params.iter().step_by(2).for_each(|&centre| each(centre));
    }
}
