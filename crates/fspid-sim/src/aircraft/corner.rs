//! Where winds are not smooth, and how far a step may go so that it ends there.

use crate::air::{AirPlace, Wind};

/// How near to a corner a place is on it, m.
const NEAR_M: f64 = 1e-9;

/// A corner: a distance flown, or a height above the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Corner {
    /// Distance flown through the air since the start, m.
    Distance(f64),
    /// Height above the ground, m.
    Height(f64),
}

/// All corners of the winds.
#[derive(Clone, Debug, Default)]
pub(super) struct Corners(Vec<Corner>);

impl Corners {
    pub(super) fn of(winds: &[Wind]) -> Self {
        let corners = winds.iter().map(Wind::corners);
        let all = corners.flat_map(|corners| {
            let along = corners.distance_m.into_iter().flatten().map(Corner::Distance);
            along.chain(corners.height_m.into_iter().flatten().map(Corner::Height))
        });
        Self(all.collect())
    }

    /// The one that a straight way from a place to another meets first, if it is not at the first place.
    pub(super) fn first_between(&self, from: &AirPlace, to: &AirPlace) -> Option<Corner> {
        let share = |corner: &Corner| {
            let (before_m, after_m) = (corner.past_m(from), corner.past_m(to));
            let crossed = before_m.abs() > NEAR_M
                && after_m.abs() > NEAR_M
                && (before_m < 0.0) != (after_m < 0.0);
            crossed.then(|| before_m / (before_m - after_m))
        };
        let met = self.0.iter().filter_map(|corner| Some((share(corner)?, *corner)));
        met.min_by(|(first, _), (second, _)| first.total_cmp(second)).map(|(_, corner)| corner)
    }
}

impl Corner {
    /// How far a place is past it, m.
    pub(super) fn past_m(self, place: &AirPlace) -> f64 {
        match self {
            Self::Distance(at_m) => place.distance_m - at_m,
            Self::Height(at_m) => place.height_m - at_m,
        }
    }

    /// True at the corner.
    pub(super) fn is_at(self, place: &AirPlace) -> bool {
        self.past_m(place).abs() <= NEAR_M
    }
}
