//! Centre of gravity of an output set: exact, or as other tools sample it.
//!
//! The output set is the union of seven triangles, one spacing $d$ apart and crossing at one half,
//! each cut at the firing strength $s_i$ of its label, over the universe from the first peak to the
//! last. All functions here work in units of the spacing, with the peaks at $-3, -2, \dots, 3$.

use crate::defuzzifier::Defuzzifier;
use crate::label::LABEL_COUNT;
use crate::lanes::Lanes;
use crate::real::Real;

/// Number of spacings from the middle peak to the last.
const HALF_SPAN: usize = (LABEL_COUNT - 1) / 2;

/// The rule of a [`Defuzzifier`] for one output a lane, answered in spacings.
///
/// The strengths must lie in [0, 1] and in each lane one must be at least `R::MIN_POSITIVE`.
#[inline(always)]
pub(crate) fn centroid<L: Lanes>(rule: Defuzzifier, strengths: &[L; LABEL_COUNT]) -> L {
    let (none, half, one) = (L::Number::ZERO, L::Number::HALF, L::Number::ONE);
    match rule {
        Defuzzifier::Exact => exact(strengths),
        Defuzzifier::Endpoints(samples) => sampled(strengths, samples, samples - 1, none, one),
        Defuzzifier::Midpoint(cells) => sampled(strengths, cells, cells, half, one),
        Defuzzifier::Trapezoid(samples) => sampled(strengths, samples, samples - 1, none, half),
    }
}

/// The centre of gravity in closed form.
///
/// A triangle of half width 1 cut at $s$ has the area $2 (s - s^2/2)$ about its peak. Two
/// neighbours, cut at $a$ and $b$, overlap in a shape that is symmetric about the middle between
/// their peaks; with $h = \min(a, b, \frac12)$ its area is $h - h^2$. No third set reaches the gap
/// between two peaks, so the union is the sum of the cut triangles less the six overlaps:
///
/// $$ A = \sum_{|i|<3} 2 (s_i - \tfrac12 s_i^2) + \sum_{i=\pm 3} (s_i - \tfrac12 s_i^2)
///        - \sum_{i=-3}^{2} (h_i - h_i^2) $$
/// $$ M = \sum_{|i|<3} 2 i (s_i - \tfrac12 s_i^2)
///        + \sum_{i=\pm 3} \pm \left( 3 (s_i - \tfrac12 s_i^2) - g(s_i) \right)
///        - \sum_{i=-3}^{2} (i + \tfrac12)(h_i - h_i^2), \qquad
///    g(s) = \tfrac12 s - \tfrac12 s^2 + \tfrac16 s^3 $$
///
/// where $g$ is the moment of half a cut triangle about its own peak (the universe ends at the
/// outer peaks). The answer is $M / A$. Own derivation; agrees with a 40-digit polygon to 4e-15.
#[inline(always)]
pub(crate) fn exact<L: Lanes>(strengths: &[L; LABEL_COUNT]) -> L {
    let [first, .., last] = *strengths;
    let c = |value| first.same(value);
    let (half, one) = (L::Number::HALF, L::Number::ONE);
    // Half of each triangle lies in a gap; both halves and the overlap at once.
    let mut halves = *strengths;
    for strength in &mut halves {
        *strength = *strength - c(half) * *strength * *strength;
    }
    let gap = |left: usize| {
        let position = L::Number::from_f64(left as f64 - HALF_SPAN as f64);
        let (left_half, right_half) = (halves[left], halves[left + 1]);
        let overlap_height = strengths[left].smaller(strengths[left + 1]).smaller(c(half));
        let overlap = overlap_height - overlap_height * overlap_height;
        let area = left_half + right_half - overlap;
        let moment =
            c(position) * left_half + c(position + one) * right_half - c(position + half) * overlap;
        (area, moment)
    };
    let (mut area, mut moment) = (c(L::Number::ZERO), c(L::Number::ZERO));
    for (gap_area, gap_moment) in [gap(0), gap(1), gap(2), gap(3), gap(4), gap(5)] {
        area = area + gap_area;
        moment = moment + gap_moment;
    }
    // The halves' own moments cancel at inner peaks; at the outer ones only one half is there.
    moment = moment + (inner_moment(first) - inner_moment(last));
    moment / area
}

/// Moment of half a triangle cut at `s` about its own peak: $\frac12 s - \frac12 s^2 + \frac16 s^3$.
#[inline(always)]
fn inner_moment<L: Lanes>(s: L) -> L {
    let (half, sixth) = (s.same(L::Number::HALF), s.same(L::Number::from_f64(1.0 / 6.0)));
    s * (half - s * (half - s * sixth))
}

/// $\sum x_n \mu(x_n) / \sum \mu(x_n)$ over `samples` points, the first `offset` cells from the
/// lower end, `cells` cells in all, the two end samples counted with `end_weight`.
#[inline(always)]
fn sampled<L: Lanes>(
    strengths: &[L; LABEL_COUNT],
    samples: u32,
    cells: u32,
    offset: L::Number,
    end_weight: L::Number,
) -> L {
    let c = |value| strengths[0].same(value);
    let half_span = L::Number::from_f64(HALF_SPAN as f64);
    let cell = (half_span + half_span) / L::Number::from_f64(f64::from(cells));
    let (mut area, mut moment) = (c(L::Number::ZERO), c(L::Number::ZERO));
    for n in 0..samples {
        let is_end = n == 0 || n == samples - 1;
        let weight = if is_end { end_weight } else { L::Number::ONE };
        let x = (L::Number::from_f64(f64::from(n)) + offset) * cell - half_span;
        let grade = c(weight) * union_grade(strengths, x);
        area = area + grade;
        moment = moment + c(x) * grade;
    }
    moment / area
}

/// Grade of the union of the cut triangles at `x` spacings from the middle peak.
#[inline(always)]
fn union_grade<L: Lanes>(strengths: &[L; LABEL_COUNT], x: L::Number) -> L {
    let mut grade = strengths[0].same(L::Number::ZERO);
    let mut peak = -L::Number::from_f64(HALF_SPAN as f64);
    for &strength in strengths {
        let triangle = L::Number::ONE - (x - peak).abs();
        grade = grade.larger(strength.same(triangle).smaller(strength));
        peak += L::Number::ONE;
    }
    grade
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;

    fn exact(strengths: &[f64; LABEL_COUNT]) -> f64 {
        centroid(Defuzzifier::Exact, strengths)
    }

    fn centroid(rule: Defuzzifier, strengths: &[f64; LABEL_COUNT]) -> f64 {
        super::centroid(rule, &strengths.map(One)).0
    }

    const RULES: [Defuzzifier; 3] = [
        Defuzzifier::Endpoints(60_001),
        Defuzzifier::Midpoint(60_000),
        Defuzzifier::Trapezoid(60_001),
    ];

    #[test]
    fn a_single_full_label_answers_the_centroid_of_its_triangle() {
        let mut strengths = [0.0; LABEL_COUNT];
        strengths[4] = 1.0;
        assert!((exact(&strengths) - 1.0).abs() < 1e-15);
        // Half a triangle at the upper end: a third of the way from the peak.
        assert!((exact(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]) - (3.0 - 1.0 / 3.0)).abs() < 1e-15);
        assert!((exact(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) + (3.0 - 1.0 / 3.0)).abs() < 1e-15);
    }

    #[test]
    fn strengths_of_any_size_are_answered_with_full_relative_accuracy() {
        let strengths = [0.0, 0.0, 1e-300, 0.0, 0.0, 1e-300, 0.0];
        assert!((exact(&strengths) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn every_sampled_rule_tends_to_the_exact_centroid() {
        let strengths = [0.9, 0.3, 0.55, 0.7, 0.1, 0.0, 0.62];
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
