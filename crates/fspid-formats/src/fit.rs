//! Straight pieces in place of a curve.

/// Largest difference of a grade that is aimed at.
const AIM: f64 = 1e-3;
/// Pieces that every curve is first cut into.
const FIRST: u32 = 8;
/// How often a piece may be halved.
const HALVINGS: u32 = 14;
/// Places in a piece at which it is compared with the curve.
const SAMPLES: u32 = 16;

/// Points on a curve, and the largest difference of a grade that was found between them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fit {
    /// Places and grades, one after the other.
    pub(crate) points: Vec<f64>,
    pub(crate) error: f64,
}

/// Fits a curve from `lower` to `upper`. `corners` are where it bends, in any order.
pub(crate) fn fit(
    grade: impl Fn(f64) -> f64,
    lower: f64,
    upper: f64,
    corners: impl IntoIterator<Item = f64>,
) -> Fit {
    let cut = |k| lower + (upper - lower) * f64::from(k) / f64::from(FIRST);
    let inside = corners.into_iter().filter(|x| lower < *x && *x < upper);
    let mut places: Vec<f64> = (1..FIRST).map(cut).chain(inside).chain([lower, upper]).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut fit = Fit { points: vec![lower, grade(lower)], error: 0.0 };
    for pair in places.windows(2) {
        let &[from, to] = pair else { continue };
        fit.piece(&grade, from, to, HALVINGS);
    }
    fit
}

impl Fit {
    /// Appends the pieces from `from`, which is the last point, to `to`.
    fn piece(&mut self, grade: &impl Fn(f64) -> f64, from: f64, to: f64, halvings: u32) {
        let error = difference(grade, from, to);
        let middle = 0.5 * from + 0.5 * to;
        if error > AIM && halvings > 0 && from < middle && middle < to {
            self.piece(grade, from, middle, halvings - 1);
            self.piece(grade, middle, to, halvings - 1);
        } else {
            self.error = self.error.max(error);
            self.points.extend([to, grade(to)]);
        }
    }
}

/// Largest difference found between a curve and the straight line through two of its points.
fn difference(grade: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (first, last) = (grade(from), grade(to));
    let at = |k: u32| {
        let share = f64::from(k) / f64::from(SAMPLES);
        let line = first + share * (last - first);
        (grade(from + share * (to - from)) - line).abs()
    };
    (1..SAMPLES).map(at).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::membership::ShapeKind;

    #[test]
    fn a_bell_curve_is_met_within_a_thousandth_everywhere() {
        let kind = ShapeKind::Gaussian;
        let grade = |x: f64| kind.grade(&[0.0, 0.7], x);
        let fit = fit(grade, -5.0, 5.0, [0.0]);
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
        let fit = fit(|x| if x < 0.3 { 0.0 } else { 1.0 }, 0.0, 1.0, []);
        assert!(fit.error > 0.1);
    }
}
