//! Margins at the gains that an accumulating law may come to.

use fspid_core::{Fspid, Gains};
use fspid_numeric::scalar::Interval;
use fspid_proof::gain_set::{GainSet, IncrementMap};
use fspid_sim::{LinearPlant, Scenario, SimError};

use super::{FrozenLoops, REFINEMENTS, count, worst_of};
use crate::analysis::Question;
use crate::analysis::answer::Margins;
use crate::analysis::rank::rank;
use crate::analysis::stability::Stability;
use crate::metrics::Absent;

/// Cells along each input of the supervisor over which its increments are bounded: their borders are those of its sets.
const DIVISIONS: usize = 12;

/// Gains and their margins.
#[derive(Clone, Debug, PartialEq)]
pub struct FrozenGains {
    /// The gains.
    pub gains: Gains<f64>,
    /// Their margins.
    pub margins: Result<Margins, Absent>,
}

/// Margins over the body of gains that holds all that an accumulating law comes to.
///
/// The body is the one that certificates speak of, a bound from outside: what it holds need not be reached.
#[derive(Clone, Debug, PartialEq)]
pub struct FrozenReach {
    /// The gains at rest, the corners of the body, and a grid within it.
    pub points: Vec<FrozenGains>,
    /// The worst gains found, among these or between them.
    pub worst: FrozenGains,
}

impl FrozenReach {
    /// That of a controller whose law accumulates, with a plant; none where nothing bounds the gains.
    pub(in crate::analysis) fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        fspid: &Fspid<f64>,
        at_rest: Gains<f64>,
        question: Question,
    ) -> Result<Option<Self>, SimError> {
        let tuner = fspid.tuner();
        let Ok(map) = IncrementMap::of(tuner, DIVISIONS) else { return Ok(None) };
        let set = map.sampled_every(fspid.config().dt_s).gains(1.0);
        let loops = FrozenLoops::new(scenario, plant, fspid, fspid.tuner().nominal(), question)?;
        Search { loops, set }.reach(at_rest)
    }

    /// Every gain that was looked at.
    pub fn all(&self) -> impl Iterator<Item = &FrozenGains> + Clone {
        self.points.iter().chain([&self.worst])
    }

    /// Whether every gain that was looked at holds the plant.
    #[must_use]
    pub fn stability(&self) -> Stability {
        Stability::of_all(self.all().map(FrozenGains::stability))
    }

    /// How many of the points have this verdict.
    #[must_use]
    pub fn count(&self, verdict: Stability) -> usize {
        count(self.points.iter().map(FrozenGains::stability), verdict)
    }
}

impl FrozenGains {
    /// Whether the gains hold the plant.
    #[must_use]
    pub fn stability(&self) -> Stability {
        Stability::of(&self.margins)
    }
}

/// Looks through a body of gains.
struct Search<'a> {
    loops: FrozenLoops<'a>,
    set: GainSet,
}

impl Search<'_> {
    fn reach(&self, at_rest: Gains<f64>) -> Result<Option<FrozenReach>, SimError> {
        let bounds = self.set.bounds();
        let side = grid_side(self.loops.question.map_points);
        let mut all = vec![at_rest];
        all.extend(self.corners());
        all.extend(grid(bounds, side).filter(|gains| self.set.contains(*gains)));
        let points = all.into_iter().map(|gains| self.point(gains));
        let points = points.collect::<Result<Vec<_>, _>>()?;
        let Some(worst) = worst_of(points.iter(), |it| &it.margins) else { return Ok(None) };
        let mut worst = self.refined(worst.clone(), bounds, 2.0 / side.max(2) as f64)?;
        worst.margins = self.loops.margins_in_full(worst.gains)?;
        Ok(Some(FrozenReach { points, worst }))
    }

    /// The corners of the body, or of the box where no more is known.
    fn corners(&self) -> Vec<Gains<f64>> {
        match &self.set.reached {
            // Each is no wider than rounding, or a box that was not told apart: its middle stands for it.
            Some(reached) => {
                reached.corners.iter().map(|it| gains(it.map(Interval::midpoint))).collect()
            }
            None => self.set.corners().map(|(_, corner)| corner).collect(),
        }
    }

    /// Looks around gains, nearer and nearer, for worse ones; the distance in halves of the bounds.
    fn refined(
        &self,
        mut worst: FrozenGains,
        bounds: [Interval; 3],
        mut distance: f64,
    ) -> Result<FrozenGains, SimError> {
        for _ in 0..REFINEMENTS {
            distance *= 0.5;
            let Gains { kp, ki, kd } = worst.gains;
            let from = [kp, ki, kd];
            for (gain, way) in [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0)] {
                let mut near = from;
                let side: Interval = bounds[gain];
                near[gain] =
                    (from[gain] + way * distance * side.radius()).clamp(side.lower(), side.upper());
                let stays = near[gain].to_bits() == from[gain].to_bits();
                if stays || !self.set.contains(gains(near)) {
                    continue;
                }
                let point = self.point(gains(near))?;
                if rank(&point.margins) < rank(&worst.margins) {
                    worst = point;
                }
            }
        }
        Ok(worst)
    }

    fn point(&self, gains: Gains<f64>) -> Result<FrozenGains, SimError> {
        Ok(FrozenGains { gains, margins: self.loops.margins(gains)? })
    }
}

/// Points along each of three gains, about as many in all as a map over two inputs has.
fn grid_side(map_points: usize) -> usize {
    let on_map = map_points.saturating_mul(map_points);
    (1..).find(|side: &usize| side.saturating_pow(3) >= on_map).unwrap_or(1)
}

/// A grid over a box; a gain that does not move has one point.
fn grid(bounds: [Interval; 3], side: usize) -> impl Iterator<Item = Gains<f64>> {
    let along = |bound: Interval| -> Vec<f64> {
        if bound.is_point() || side == 1 {
            return vec![bound.midpoint()];
        }
        let part = |index: usize| index as f64 / (side - 1) as f64;
        (0..side)
            .map(|index| bound.lower() + part(index) * (bound.upper() - bound.lower()))
            .map(|gain| gain.min(bound.upper()))
            .collect()
    };
    let [kp, ki, kd] = bounds.map(along);
    kp.into_iter().flat_map(move |kp| {
        let kd = kd.clone();
        ki.clone()
            .into_iter()
            .flat_map(move |ki| kd.clone().into_iter().map(move |kd| Gains { kp, ki, kd }))
    })
}

fn gains([kp, ki, kd]: [f64; 3]) -> Gains<f64> {
    Gains { kp, ki, kd }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_about_as_many_points_as_a_map_and_its_ends_are_the_bounds() {
        assert_eq!([1, 2, 9, 41].map(grid_side), [1, 2, 5, 12]);
        let bounds =
            [Interval::between(1.0, 3.0), Interval::point(0.5), Interval::between(-1.0, 0.1)];
        let found: Vec<Gains<f64>> = grid(bounds, 5).collect();
        assert_eq!(found.len(), 25);
        assert!(found.iter().all(|it| (1.0..=3.0).contains(&it.kp) && it.kd <= 0.1));
        let ends = [found[0], found[24]].map(|it| [it.kp, it.ki, it.kd]);
        assert_eq!(ends, [[1.0, 0.5, -1.0], [3.0, 0.5, 0.1]]);
        assert_eq!(grid(bounds, 1).count(), 1);
    }
}
