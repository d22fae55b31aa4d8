//! Discontinuities in the slope of winds and gusts, and step-size limits so that an integration step ends on each of them.

use crate::air::{AirPlace, Wind};

/// How near to a corner a place is on it, m or s.
const NEAR: f64 = 1e-9;

/// A corner: a distance flown, a height above the ground, or a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Corner {
    /// Distance flown through the air since the start, m.
    Distance(f64),
    /// Height above the ground, m.
    Height(f64),
    /// Time since the start, s.
    Time(f64),
}

/// All corners of the winds, each list in rising order.
#[derive(Clone, Debug, Default)]
pub(super) struct Corners {
    distance_m: Vec<f64>,
    height_m: Vec<f64>,
    time_s: Vec<f64>,
}

impl Corners {
    pub(super) fn of(winds: &[Wind]) -> Self {
        let mut all = Self::default();
        for corners in winds.iter().map(Wind::corners) {
            all.distance_m.extend(corners.distance_m);
            all.height_m.extend(corners.height_m);
            all.time_s.extend(corners.time_s);
        }
        for list in [&mut all.distance_m, &mut all.height_m, &mut all.time_s] {
            list.sort_by(f64::total_cmp);
        }
        all
    }

    /// These and others: times, s, and a height, m.
    pub(super) fn with(mut self, times_s: Vec<f64>, height_m: Option<f64>) -> Self {
        self.time_s.extend(times_s);
        self.height_m.extend(height_m);
        for list in [&mut self.height_m, &mut self.time_s] {
            list.sort_by(f64::total_cmp);
        }
        self
    }

    /// The one that a straight way from a place to another meets first, if it is not at the first place.
    pub(super) fn first_between(&self, from: &AirPlace, to: &AirPlace) -> Option<Corner> {
        let along = next(&self.distance_m, from.distance_m, to.distance_m).map(Corner::Distance);
        let up = next(&self.height_m, from.height_m, to.height_m).map(Corner::Height);
        let later = next(&self.time_s, from.time_s, to.time_s).map(Corner::Time);
        let met = [along, up, later].into_iter().flatten();
        let met = met.map(|corner| {
            let (before, after) = (corner.past(from), corner.past(to));
            (before / (before - after), corner)
        });
        met.min_by(|(first, _), (second, _)| first.total_cmp(second)).map(|(_, corner)| corner)
    }
}

/// The first of some corners on the way from one value to another, at neither end.
fn next(corners: &[f64], from: f64, to: f64) -> Option<f64> {
    let found = if to > from {
        corners.get(corners.partition_point(|at| *at <= from + NEAR))
    } else {
        corners
            .partition_point(|at| *at < from - NEAR)
            .checked_sub(1)
            .and_then(|at| corners.get(at))
    };
    let is_before = |at: &f64| if to > from { *at < to - NEAR } else { *at > to + NEAR };
    found.copied().filter(is_before)
}

impl Corner {
    /// How far a place is past it, m or s.
    pub(super) fn past(self, place: &AirPlace) -> f64 {
        match self {
            Self::Distance(at_m) => place.distance_m - at_m,
            Self::Height(at_m) => place.height_m - at_m,
            Self::Time(at_s) => place.time_s - at_s,
        }
    }

    /// True at the corner.
    pub(super) fn is_at(self, place: &AirPlace) -> bool {
        self.past(place).abs() <= NEAR
    }
}

#[cfg(test)]
mod tests {
    use super::next;

    #[test]
    fn the_next_corner_is_the_nearest_on_the_way_and_none_at_its_ends() {
        let corners = [1.0, 2.0, 2.0, 5.0];
        for (from, to, found) in [
            (0.0, 6.0, Some(1.0)),
            (1.0, 6.0, Some(2.0)),
            (2.0, 5.0, None),
            (6.0, 0.0, Some(5.0)),
            (5.0, 1.0, Some(2.0)),
            (2.0, 1.0, None),
            (3.0, 3.0, None),
            (f64::NAN, 3.0, None),
        ] {
            assert_eq!(next(&corners, from, to), found, "{from} to {to}");
        }
    }
}
