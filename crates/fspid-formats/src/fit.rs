//! Straight pieces in place of a curve.

use fspid_fuzzy::membership::{Range, ShapeKind};

/// Largest difference of a grade that is aimed at.
const AIM: f64 = 1e-3;
/// Pieces that every curve is first cut into.
const FIRST: u32 = 8;
/// How often a piece may be halved.
const HALVINGS: u32 = 14;
/// Places in a piece at which it is compared with the curve.
const SAMPLES: u32 = 16;
/// A side that is narrower than this share of the range is cut at its centre.
const NARROW: f64 = 1.0 / 128.0;
/// Widths around a centre at which a curve is compared too.
const MULTIPLES: [f64; 9] = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 8.0];

/// Points on a curve, and the largest difference of a grade that was found between them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fit {
    /// Places and grades, one after the other.
    pub(crate) points: Vec<f64>,
    pub(crate) error: f64,
}

/// Where something happens on a curve, however narrow it is, so that it is not stepped over.
#[derive(Clone, Debug, Default)]
pub(crate) struct Landmarks {
    /// Where it bends, in any order.
    pub(crate) corners: Vec<f64>,
    /// The centres of its sides, and how wide the narrowest one is.
    centres: Vec<f64>,
    narrowest: f64,
    /// Where it is compared: multiples of its widths around them, in ascending order.
    pub(crate) marks: Vec<f64>,
}

impl Landmarks {
    /// Those of a shape.
    pub(crate) fn of(kind: ShapeKind, params: &[f64]) -> Self {
        let (mut corners, mut centres, mut widths) = (Vec::new(), Vec::new(), Vec::new());
        kind.corners(params, &mut |x| corners.push(x));
        for (param, &value) in kind.params().iter().zip(params).filter(|_| !kind.repeats()) {
            match (param.unit, param.range) {
                ("variable", Range::Positive | Range::NonZero) => widths.push(value.abs()),
                ("1/variable", _) => widths.push(value.recip().abs()),
                ("variable", _) => centres.push(value),
                _ => {}
            }
        }
        let around = |&centre: &f64| {
            let multiples =
                |width: f64| MULTIPLES.map(|n| [centre - n * width, centre + n * width]);
            widths.iter().copied().flat_map(multiples).flatten().collect::<Vec<_>>()
        };
        let places = || corners.iter().chain(&centres);
        let mut marks: Vec<f64> = places().flat_map(around).chain(places().copied()).collect();
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        let narrowest = widths.iter().copied().fold(f64::INFINITY, f64::min);
        Self { corners, centres, narrowest, marks }
    }

    /// Where a curve over so long a range is cut: at the centre of what halving may not find, too.
    fn cuts(&self, span: f64) -> impl Iterator<Item = f64> + '_ {
        let narrow = self.narrowest < NARROW * span;
        let centres = self.centres.iter().filter(move |_| narrow);
        self.corners.iter().chain(centres).copied()
    }
}

/// Fits a curve from `lower` to `upper`.
pub(crate) fn fit(
    grade: impl Fn(f64) -> f64,
    lower: f64,
    upper: f64,
    landmarks: &Landmarks,
) -> Fit {
    let cut = |k| lower + (upper - lower) * f64::from(k) / f64::from(FIRST);
    let inside = landmarks.cuts(upper - lower).filter(|x| lower < *x && *x < upper);
    let mut places: Vec<f64> = (1..FIRST).map(cut).chain(inside).chain([lower, upper]).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut fit = Fit { points: vec![lower, grade(lower)], error: 0.0 };
    for pair in places.windows(2) {
        let &[from, to] = pair else { continue };
        let curve = Curve { grade: &grade, marks: &landmarks.marks };
        fit.piece(&curve, [from, to], HALVINGS);
    }
    fit
}

impl Fit {
    /// Appends the pieces from `from`, which is the last point, to `to`.
    fn piece(&mut self, curve: &Curve<'_>, [from, to]: [f64; 2], halvings: u32) {
        let error = curve.difference(from, to);
        let middle = 0.5 * from + 0.5 * to;
        if error > AIM && halvings > 0 && from < middle && middle < to {
            self.piece(curve, [from, middle], halvings - 1);
            self.piece(curve, [middle, to], halvings - 1);
        } else {
            self.error = self.error.max(error);
            self.points.extend([to, (curve.grade)(to)]);
        }
    }
}

struct Curve<'c> {
    grade: &'c dyn Fn(f64) -> f64,
    marks: &'c [f64],
}

impl Curve<'_> {
    /// Largest difference found between the curve and the straight line through two of its points.
    fn difference(&self, from: f64, to: f64) -> f64 {
        let (first, last) = ((self.grade)(from), (self.grade)(to));
        let even = (1..SAMPLES).map(|k| from + f64::from(k) / f64::from(SAMPLES) * (to - from));
        let begin = self.marks.partition_point(|&x| x <= from);
        let marks = self.marks.iter().skip(begin).copied().take_while(|&x| x < to);
        let at = |x: f64| {
            let line = first + (x - from) / (to - from) * (last - first);
            ((self.grade)(x) - line).abs()
        };
        even.chain(marks).map(at).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::membership::ShapeKind;

    #[test]
    fn a_bell_curve_is_met_within_a_thousandth_everywhere() {
        let kind = ShapeKind::Gaussian;
        let grade = |x: f64| kind.grade(&[0.0, 0.7], x);
        let fit = fit(grade, -5.0, 5.0, &Landmarks::of(kind, &[0.0, 0.7]));
        assert!(fit.error <= AIM);
        assert_eq!(ShapeKind::Points.check(&fit.points), Ok(()));
        for x in (-5000..=5000).map(|n| f64::from(n) * 1e-3) {
            let error = (grade(x) - ShapeKind::Points.grade(&fit.points, x)).abs();
            assert!(error <= 1.05 * AIM, "{error} at {x}");
        }
        assert!(fit.points.len() < 2 * 120, "{} points", fit.points.len() / 2);
    }

    #[test]
    fn a_jump_is_met_as_near_as_can_be_and_its_error_is_told() {
        let fit = fit(|x| if x < 0.3 { 0.0 } else { 1.0 }, 0.0, 1.0, &Landmarks::default());
        assert!(fit.error > 0.1);
    }

    #[test]
    fn a_curve_that_is_narrower_than_a_thousandth_of_its_range_is_not_stepped_over() {
        let kind = ShapeKind::Gaussian;
        for sigma in [0.1, 0.004, 1e-5] {
            let params = [3.242, sigma];
            let grade = |x: f64| kind.grade(&params, x);
            let fit = fit(grade, 0.0, 10.0, &Landmarks::of(kind, &params));
            let off = |n: i32| {
                let x = 3.242 + 0.05 * f64::from(n) * sigma;
                (grade(x) - ShapeKind::Points.grade(&fit.points, x)).abs()
            };
            let found = (-200..=200).map(off).fold(0.0, f64::max);
            assert!(found <= 1.2 * fit.error.max(AIM), "{sigma}: {found} {}", fit.error);
            assert!(ShapeKind::Points.grade(&fit.points, 3.242) > 1.0 - AIM);
        }
    }
}
