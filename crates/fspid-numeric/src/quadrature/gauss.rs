//! Gauss and Legendre's rule of ten points on a panel, with its remainder.
//!
//! $$ \int_{-h}^{h} f(m + t) \ dt = h \sum_i w_i f(m + h t_i) + R, \quad
//!    R = \frac{(n!)^4 (2h)^{2n+1}}{(2n+1) ((2n)!)^2} \cdot \frac{f^{(2n)}(\xi)}{(2n)!} $$
//!
//! Nodes and weights are irrational; here they are intervals of two neighbouring floats. They were
//! made by `oracles/make_gauss.py`.
//!
//! # Source
//! Davis and Rabinowitz, *Methods of Numerical Integration*, 2nd ed. 1984, section 2.7.

use crate::scalar::{Interval, Scalar};

use super::{Curve, Moments, Span};

/// Nodes and weights of one half, rounded down.
const RULE: [(f64, f64); 5] = [
    (0.973_906_528_517_171_6, 0.066_671_344_308_688_12),
    (0.865_063_366_688_984_4, 0.149_451_349_150_580_6),
    (0.679_409_568_299_024, 0.219_086_362_515_982_04),
    (0.433_395_394_129_247_16, 0.269_266_719_309_996_35),
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
];
/// $(n!)^4 / ((2n + 1) ((2n)!)^2)$, rounded down.
const REMAINDER: f64 = 1.395_030_179_375_452_9e-12;
/// Twice the number of points: the order of the derivative in the remainder.
pub(super) const ORDER: usize = 20;

/// The number between a float and the next.
const fn rounded_down(value: f64) -> Interval {
    Interval::between(value, value.next_up())
}

/// The integrals of the rule over a span, without the remainder.
pub(super) fn rule<C: Curve>(curve: &C, span: Span) -> Moments {
    let [middle, half] = span.middle_and_half();
    let mut sums = Moments::NONE;
    for (node, weight) in RULE {
        let (distance, weight) = (half * rounded_down(node), rounded_down(weight));
        for offset in [-distance, distance] {
            let x = middle + offset;
            let share = weight * curve.at(x);
            sums = sums + Moments { area: share, moment: share * (x - span.about()) };
        }
    }
    Moments { area: half * sums.area, moment: half * sums.moment }
}

/// The remainder for a function with these two Taylor coefficients of order 19 and 20 on the span.
pub(super) fn remainder(span: Span, before: Interval, last: Interval) -> Moments {
    let width = span.width();
    let squared = width.square();
    let fourth = squared.square();
    let power = fourth.square().square() * fourth * width;
    let factor = rounded_down(REMAINDER) * power;
    // The coefficient of (x - about) f(x).
    let of_moment = span.hull_about() * last + before;
    Moments { area: factor * last, moment: factor * of_moment }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A power of x.
    struct Power(i32);

    impl Curve for Power {
        fn at<S: Scalar>(&self, x: S) -> S {
            x.pow(S::constant(f64::from(self.0)))
        }
    }

    #[test]
    fn the_rule_is_exact_below_its_order_and_its_remainder_at_it() {
        let span = Span::new(0.0, 1.0, 0.0);
        for power in 0_u8..=20 {
            let sums = rule(&Power(power.into()), span);
            let exact = Interval::ONE / Interval::point(f64::from(power) + 1.0);
            let fits = |sum: Interval| sum.intersection(exact).is_some() && sum.width() < 1e-15;
            let last = Interval::constant(f64::from(u8::from(power == 20)));
            let with_remainder = sums.area + remainder(span, Interval::ZERO, last).area;
            // x^20 needs the remainder, 1.4e-12.
            assert_eq!(fits(sums.area), power < 20, "{power}: {:?}", sums.area);
            assert!(fits(with_remainder), "{power}: {with_remainder:?}");
        }
    }
}
