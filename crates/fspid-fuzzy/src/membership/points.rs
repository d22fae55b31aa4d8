//! Any piecewise-linear set, from a list of its points.

use super::side::{at_least, refuse, width};
use super::{Param, Range, Shape, Vertex};
use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// Straight from point to point; level before the first and after the last.
///
/// Two points at the same place are a jump, and the place itself has the larger of the two grades.
///
/// # Source
/// IEC 61131-7, terms given by points; fuzzylite's `Discrete`, jFuzzyLogic's piecewise-linear terms.
#[derive(Clone, Copy, Debug)]
pub enum Points {}

impl Shape for Points {
    const NAME: &'static str = "points";
    const PARAMS: &'static [Param] = &[
        Param { name: "at", unit: "variable", range: Range::Finite },
        Param { name: "grade", unit: "1", range: Range::Grade },
    ];
    const EXAMPLE: &'static [f64] = &[-2.0, 0.0, -1.0, 0.8, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0];
    const REPEATS: bool = true;
    const PIECEWISE_LINEAR: bool = true;

    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let places = || params.iter().step_by(2).copied();
        for (before, at) in places().zip(places().skip(1)) {
            at_least(before, "at", at, "a number from the one before to that + 1.7e308")?;
        }
        match places().zip(places().skip(2)).find(|(before, at)| !(before < at)) {
            Some((_, at)) => refuse("at", at, "a number that stands in at most two points"),
            None => Ok(()),
        }
    }

    /// O(points). 0 for NaN.
    fn grade<S: Scalar>(params: &[S], x: S) -> S {
        let Some(&[.., last]) = params.last_chunk::<2>() else { return S::zero() };
        let mut grade = last;
        for segment in params.windows(4).step_by(2).rev() {
            let &[x0, y0, x1, y1] = segment else { continue };
            let between = (y0 + ((x - x0) / width(x0, x1)).unit() * (y1 - y0)).unit();
            // Two grades only at the place itself, so that elsewhere no kink is suspected.
            grade = x.if_less(x1, between, x1.if_less(x, grade, between.larger(grade)));
        }
        let not_nan = x.if_less(S::constant(f64::INFINITY), grade, S::zero());
        S::constant(f64::NEG_INFINITY).if_less(x, grade, not_nan)
    }

    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        for pair in params.chunks_exact(2) {
            let &[x, grade] = pair else { continue };
            each(Vertex { x, grade });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GATE: [f64; 8] = [1.0, 0.0, 1.0, 1.0, 2.0, 1.0, 2.0, 0.25];

    #[test]
    fn a_jump_has_the_larger_of_its_two_grades() {
        let grades = [0.5, 1.0, 1.5, 2.0, 2.5].map(|x| Points::grade(&GATE, x));
        assert_eq!(grades, [0.0, 1.0, 1.0, 1.0, 0.25]);
    }

    #[test]
    fn before_the_first_and_after_the_last_point_the_grade_is_level() {
        let slope = [1.0, 0.25, 3.0, 0.75];
        let grades = [f64::NEG_INFINITY, 0.0, 1.0, 2.0, 3.0, 9.0, f64::INFINITY]
            .map(|x| Points::grade(&slope, x));
        assert_eq!(grades, [0.25, 0.25, 0.25, 0.5, 0.75, 0.75, 0.75]);
    }

    #[test]
    fn a_third_point_at_one_place_and_a_step_back_are_refused() {
        let wrong = |params: &[f64]| {
            matches!(Points::relation(params), Err(FuzzyError::Parameter { name: "at", .. }))
        };
        assert!(wrong(&[1.0, 0.0, 1.0, 1.0, 1.0, 0.0]));
        assert!(wrong(&[1.0, 0.0, 0.5, 1.0]));
        assert!(!wrong(&GATE));
    }
}
