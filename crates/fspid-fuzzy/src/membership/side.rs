//! What several members are made of: straight sides, the smooth step, and refusals.
//!
//! A NaN lies outside every side: it is taken for the infinity at which the grade is 0.

use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// The smallest positive number. As the least width of a side it changes no width but 0, and
/// keeps a division by it from being 0/0.
const LEAST_WIDTH: f64 = f64::from_bits(1);

/// Straight from 0 at `foot` to 1 at `top` and beyond. A side of no width is a jump whose `top`
/// belongs to the set; a `foot` at $-\infty$ makes the grade 1 everywhere.
#[inline]
pub(super) fn rise<S: Scalar>(x: S, foot: S, top: S) -> S {
    let x = x.larger(S::constant(f64::NEG_INFINITY));
    let share = up_to_one((x - foot) / width(foot, top));
    let side = x.if_less(top, share, S::one());
    // The other way round an enclosure of infinity, which begins at the largest number there is, would be open.
    S::constant(f64::MIN).if_less(foot, side, S::one())
}

/// Straight from 1 up to `top` down to 0 at `foot`: [`rise`] seen in a mirror.
#[inline]
pub(super) fn fall<S: Scalar>(x: S, top: S, foot: S) -> S {
    let x = x.smaller(S::constant(f64::INFINITY));
    let share = up_to_one((foot - x) / width(top, foot));
    let side = top.if_less(x, share, S::one());
    foot.if_less(S::constant(f64::MAX), side, S::one())
}

/// The number moved into `[0, 1]`; NaN becomes 1, unlike [`Scalar::unit`].
#[inline]
pub(super) fn up_to_one<S: Scalar>(share: S) -> S {
    share.smaller(S::one()).larger(S::zero())
}

/// The number, at least 0; NaN becomes infinity.
#[inline]
pub(super) fn beyond<S: Scalar>(distance: S) -> S {
    distance.smaller(S::constant(f64::INFINITY)).larger(S::zero())
}

/// The square root, 0 for numbers below 0. Its slope at 0, which is infinite, counts as 0: there a
/// set begins, and beside it nothing changes.
#[inline]
pub(crate) fn root<S: Scalar>(square: S) -> S {
    let square = square.larger(S::zero());
    S::zero().if_less(square, square.sqrt(), S::zero())
}

/// $\frac{1}{1 + x}$; 0 where $x$ has overflowed, with a slope of 0.
#[inline]
pub(super) fn one_over_one_plus<S: Scalar>(x: S) -> S {
    x.if_less(S::constant(f64::MAX), S::one() / (S::one() + x), S::zero())
}

/// From `lower` to `upper`, never 0.
#[inline]
pub(super) fn width<S: Scalar>(lower: S, upper: S) -> S {
    (upper - lower).larger(S::constant(LEAST_WIDTH))
}

/// Two parabolas from 0 to 1 that meet in the middle:
/// $2t^2$ up to $t = \frac12$, then $1 - 2(1-t)^2$.
#[inline]
pub(crate) fn smooth<S: Scalar>(t: S) -> S {
    let two = S::constant(2.0);
    let low = two * t.smaller(S::half()).square();
    let high = S::one() - two * (S::one() - t.larger(S::half())).square();
    t.if_less(S::half(), low, high)
}

/// The `t` of a [`smooth`] grade in [0, 1].
#[inline]
pub(crate) fn smooth_inverse<S: Scalar>(grade: S) -> S {
    let low = root(S::half() * grade.smaller(S::half()));
    let high = S::one() - root(S::half() * (S::one() - grade.larger(S::half())));
    grade.if_less(S::half(), low, high)
}

/// Where a smooth step begins and ends: its parameters, or their middle twice if the first is not
/// below the second, which makes it a jump.
#[inline]
pub(super) fn step_ends<S: Scalar>(from: S, to: S) -> (S, S) {
    let middle = S::half() * from + S::half() * to;
    (from.smaller(middle), to.larger(middle))
}

/// Says that a parameter is not allowed.
pub(super) const fn refuse(
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), FuzzyError> {
    Err(FuzzyError::Parameter { name, found, allowed })
}

/// Refuses a `found` below `least`, or so far above that their difference overflows.
pub(super) fn at_least(
    least: f64,
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), FuzzyError> {
    let endless = !least.is_finite() || !found.is_finite();
    let near = endless || (found - least).is_finite();
    if found >= least && near { Ok(()) } else { refuse(name, found, allowed) }
}

/// Refuses a `found` that is not above `least`, or so far above that their difference overflows.
pub(super) fn above(
    least: f64,
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), FuzzyError> {
    if found > least { at_least(least, name, found, allowed) } else { refuse(name, found, allowed) }
}

/// Refuses a `found` so far off `other` that their difference overflows.
pub(super) fn near(
    other: f64,
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), FuzzyError> {
    if (found - other).is_finite() { Ok(()) } else { refuse(name, found, allowed) }
}

/// Refuses a `found` that is the same as `other`, or so far off that their difference overflows.
pub(super) fn apart(
    other: f64,
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), FuzzyError> {
    let differ = found < other || other < found;
    if differ { near(other, name, found, allowed) } else { refuse(name, found, allowed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_of_no_width_is_a_jump_whose_top_belongs_to_the_set() {
        assert_eq!([-1.0, 2.0, 3.0].map(|x| rise(x, 2.0, 2.0)), [0.0, 1.0, 1.0]);
        assert_eq!([-1.0, 2.0, 3.0].map(|x| fall(x, 2.0, 2.0)), [1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_foot_at_infinity_makes_a_shoulder() {
        for x in [f64::NEG_INFINITY, -1e308, -1.0, 0.0, 1.0, 1e308, f64::INFINITY] {
            assert_eq!(rise(x, f64::NEG_INFINITY, 0.0), 1.0, "{x}");
            assert_eq!(fall(x, 0.0, f64::INFINITY), 1.0, "{x}");
        }
        assert_eq!(rise(-1.0_f32, f32::NEG_INFINITY, 0.0), 1.0);
        assert_eq!(fall(1.0_f32, 0.0, f32::INFINITY), 1.0);
    }

    #[test]
    fn nan_is_outside_both_sides() {
        assert_eq!(rise(f64::NAN, 0.0, 1.0), 0.0);
        assert_eq!(fall(f64::NAN, 0.0, 1.0), 0.0);
    }

    #[test]
    fn the_smooth_step_and_its_inverse_agree() {
        for k in 0..=1000 {
            let t = f64::from(k) / 1000.0;
            assert!((smooth_inverse(smooth(t)) - t).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn a_step_whose_end_is_not_behind_its_begin_jumps_in_the_middle() {
        assert_eq!(step_ends(1.0, 3.0), (1.0, 3.0));
        assert_eq!(step_ends(3.0, 1.0), (2.0, 2.0));
        assert_eq!(step_ends(2.0, 2.0), (2.0, 2.0));
    }
}
