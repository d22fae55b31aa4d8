//! The trapezoid, also with shoulders that never end.

use super::side::{above, at_least, fall, refuse, rise};
use super::{Param, Range, Shape, Vertex, finite_vertices};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// $\mu(x) = \max\left(0, \min\left(\frac{x - a}{b - a}, 1, \frac{d - x}{d - c}\right)\right)$ with
/// $a$ `left_foot`, $b$ `left_top`, $c$ `right_top`, $d$ `right_foot`
///
/// A side of no width is a jump, and its top belongs to the set. A foot at infinity makes the grade 1 on
/// that side for ever, wherever its top is. The tops may be crossed, $c < b$: the sides then meet below 1.
/// (A set without any end holds NaN too.)
///
/// # Source
/// MATLAB's `trapmf`, fuzzylite's `Trapezoid`.
#[derive(Clone, Copy, Debug)]
pub enum Trapezoid {}

impl Shape for Trapezoid {
    const NAME: &'static str = "trapezoid";
    const PARAMS: &'static [Param] = &[
        Param { name: "left_foot", unit: "variable", range: Range::Extended },
        Param { name: "left_top", unit: "variable", range: Range::Extended },
        Param { name: "right_top", unit: "variable", range: Range::Extended },
        Param { name: "right_foot", unit: "variable", range: Range::Extended },
    ];
    const EXAMPLE: &'static [f64] = &[-2.0, -1.0, 0.0, 2.0];
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let &[left_foot, left_top, right_top, right_foot] = params else { return Ok(()) };
        at_least(left_foot, "left_top", left_top, "a number from left_foot on")?;
        if left_top == f64::INFINITY {
            return refuse("left_top", left_top, "a number below inf, at least left_foot");
        }
        above(f64::NEG_INFINITY, "right_top", right_top, "a number above -inf")?;
        at_least(right_top, "right_foot", right_foot, "a number from right_top on")?;
        above(left_foot, "right_foot", right_foot, "a number above left_foot, at least right_top")
    }

    #[inline]
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let &[left_foot, left_top, right_top, right_foot] = params else { return S::zero() };
        rise(x, left_foot, left_top).smaller(fall(x, right_top, right_foot))
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let &[left_foot, left_top, right_top, right_foot] = params else { return };
        let left_top = if left_foot == f64::NEG_INFINITY { left_foot } else { left_top };
        let right_top = if right_foot == f64::INFINITY { right_foot } else { right_top };
        if left_top <= right_top {
            let tops = [(left_top, 1.0), (right_top, 1.0)];
            return finite_vertices([(left_foot, 0.0), tops[0], tops[1], (right_foot, 0.0)], each);
        }
        let (rise, fall) = (left_top - left_foot, right_foot - right_top);
        let grade = 0.5 * (right_foot - left_foot) / (0.5 * rise + 0.5 * fall);
        let crossing = (left_foot + grade * rise, grade);
        finite_vertices([(left_foot, 0.0), crossing, (right_foot, 0.0)], each);
    }
}
