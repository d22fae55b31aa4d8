//! Error over travel: of each controller, case and seed, through the rungs of the ladder.

use crate::contest::{Judged, Quantity};

/// Logarithms of travel and error along a ladder, by travel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve(Vec<(f64, f64)>);

impl Curve {
    /// Through travels and errors above zero; none of fewer than two travels.
    pub(super) fn through(points: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let is_there = |it: f64| it > 0.0 && it.is_finite();
        let there = points.filter(|(travel, error)| is_there(*travel) && is_there(*error));
        let mut points: Vec<(f64, f64)> =
            there.map(|(travel, error)| (libm::log(travel), libm::log(error))).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        // Of two efforts of one travel the better one: the other effort bought nothing.
        points.dedup_by(|next, before| {
            let same = next.0 - before.0 <= 1e-9;
            if same {
                before.1 = before.1.min(next.1);
            }
            same
        });
        (points.len() > 1).then_some(Self(points))
    }

    /// Least and most travel.
    pub(super) fn range(&self) -> [f64; 2] {
        let end = |point: Option<&(f64, f64)>| point.map_or(f64::NAN, |point| point.0);
        [end(self.0.first()), end(self.0.last())]
    }

    /// The error at a travel, in a straight line between efforts.
    pub(super) fn at(&self, travel: f64) -> f64 {
        let next = self.0.partition_point(|point| point.0 < travel).clamp(1, self.0.len() - 1);
        let ((x0, y0), (x1, y1)) = (self.0[next - 1], self.0[next]);
        y0 + (y1 - y0) * (travel - x0) / (x1 - x0)
    }
}

/// The curves of a controller in a case, one a seed; none where one of them is none. A point is the mean over the runs of
/// the case on a rung, as the contest has it: what travels more because its draw is harder is no other effort, and would
/// make a curve of its own shape that says nothing of the controller.
pub(super) fn of_case(rungs: &[&Judged], contestant: usize, case: usize) -> Option<Vec<Curve>> {
    let held = || rungs.iter().copied();
    let designs = |judged: &Judged| judged.contestants[contestant].designs.len();
    let seeds = held().map(designs).min().unwrap_or(0);
    let point = |judged: &Judged, seed: usize| {
        let design = &judged.contestants[contestant].designs[seed];
        let [travel, error] =
            [Quantity::ACTIVITY, Quantity::ERROR].map(|it| judged.value(design, case, it));
        Some((travel?, error?))
    };
    (0..seeds).map(|seed| Curve::through(held().filter_map(|it| point(it, seed)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_efforts_a_curve_is_straight_in_logarithms() {
        let curve = Curve(vec![(0.0, 2.0), (1.0, 1.0), (3.0, 0.0)]);
        assert_eq!(
            (curve.at(0.0), curve.at(0.5), curve.at(2.0), curve.at(3.0)),
            (2.0, 1.5, 0.5, 0.0)
        );
        assert_eq!(curve.range(), [0.0, 3.0]);
    }
}
