//! Error over travel: of each controller, case and seed, through the rungs of the ladder.

use super::Rung;
use crate::contest::{Flight, Quantity};

/// Logarithms of travel and error of the flights of one case and seed, by travel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve(Vec<(f64, f64)>);

impl Curve {
    /// Through flights that are not lost; none of fewer than two travels.
    pub(super) fn of<'a>(flights: impl Iterator<Item = &'a Flight>) -> Option<Self> {
        let measure = |flight: &Flight, quantity: Quantity| match quantity {
            Quantity::Measure(index) => flight.measures.get(index).copied().flatten(),
            Quantity::Cost => None,
        };
        Self::through(flights.filter_map(|flight| {
            let travel = measure(flight, Quantity::ACTIVITY)?;
            Some((travel, measure(flight, Quantity::ERROR)?))
        }))
    }

    /// Through travels and errors above zero; none of fewer than two travels.
    pub(super) fn through(points: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let there = points.filter(|(travel, error)| *travel > 0.0 && *error > 0.0);
        let mut points: Vec<(f64, f64)> =
            there.map(|(travel, error)| (libm::log(travel), libm::log(error))).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        // Of two flights of one travel the better one: the other effort bought nothing.
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

    /// The error at a travel, in a straight line between flights.
    pub(super) fn at(&self, travel: f64) -> f64 {
        let next = self.0.partition_point(|point| point.0 < travel).clamp(1, self.0.len() - 1);
        let ((x0, y0), (x1, y1)) = (self.0[next - 1], self.0[next]);
        y0 + (y1 - y0) * (travel - x0) / (x1 - x0)
    }
}

/// The curves of a controller in a case, one a seed; none where one of them is none.
pub(super) fn of_case(rungs: &[Rung], contestant: usize, case: usize) -> Option<Vec<Curve>> {
    let contestants = || rungs.iter().map(|rung| &rung.outcome.judged.contestants[contestant]);
    let seeds = contestants().map(|it| it.designs.len()).min().unwrap_or(0);
    let place = flights_of(rungs, case);
    (0..seeds)
        .map(|seed| {
            let flights = contestants()
                .flat_map(|it| it.designs[seed].flights.get(place.clone()).unwrap_or_default());
            Curve::of(flights)
        })
        .collect()
}

/// Where the flights of a case are among all flights of a design.
fn flights_of(rungs: &[Rung], case: usize) -> std::ops::Range<usize> {
    let cases = rungs.first().map_or(&[][..], |rung| rung.outcome.judged.cases.as_slice());
    let before: usize = cases.iter().take(case).map(|it| it.runs).sum();
    before..before + cases.get(case).map_or(0, |it| it.runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_flights_a_curve_is_straight_in_logarithms() {
        let curve = Curve(vec![(0.0, 2.0), (1.0, 1.0), (3.0, 0.0)]);
        assert_eq!(
            (curve.at(0.0), curve.at(0.5), curve.at(2.0), curve.at(3.0)),
            (2.0, 1.5, 0.5, 0.0)
        );
        assert_eq!(curve.range(), [0.0, 3.0]);
    }
}
