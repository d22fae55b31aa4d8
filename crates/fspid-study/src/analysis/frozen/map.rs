//! Margins at every gain that a supervisor can produce under a law without memory.

use fspid_core::{Fspid, Gains};
use fspid_proof::gain_set::producible;
use fspid_sim::{LinearPlant, Scenario, SimError};

use super::{FrozenLoops, REFINEMENTS, count, worst_of};
use crate::analysis::Question;
use crate::analysis::answer::Margins;
use crate::analysis::rank::rank;
use crate::analysis::stability::Stability;
use crate::metrics::Absent;

/// A gain triple and its margins.
#[derive(Clone, Debug, PartialEq)]
pub struct FrozenPoint {
    /// Error and change that it belongs to, in the supervisor's units.
    pub input: [f64; 2],
    /// The gains.
    pub gains: Gains<f64>,
    /// Their margins.
    pub margins: Result<Margins, Absent>,
}

/// Margins over the supervisor's inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct FrozenMap {
    /// What the supervisor sees beside the error, in words.
    pub beside: &'static str,
    /// Points along each input.
    pub side: usize,
    /// Row after row: the error rises from row to row, the change within one.
    pub points: Vec<FrozenPoint>,
    /// Gains at the cells themselves, row after row, where rules conclude numbers; empty for labels.
    pub nodes: Vec<FrozenPoint>,
    /// The worst gain found, on the grid, at a cell or between them.
    pub worst: FrozenPoint,
}

impl FrozenMap {
    /// The map of a self-tuning controller with a plant, whose law has no memory; none where no point is asked for.
    pub(in crate::analysis) fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        fspid: &Fspid<f64>,
        question: Question,
    ) -> Result<Option<Self>, SimError> {
        let rest = producible(fspid.tuner(), 0.0, 0.0);
        let loops = FrozenLoops::new(scenario, plant, fspid, rest, question)?;
        Mapper { loops }.map()
    }

    /// Every gain that was looked at: on the map, at the cells, and the worst of the search.
    pub fn all(&self) -> impl Iterator<Item = &FrozenPoint> + Clone {
        self.points.iter().chain(&self.nodes).chain([&self.worst])
    }

    /// Whether every gain that was looked at holds the plant.
    #[must_use]
    pub fn stability(&self) -> Stability {
        Stability::of_all(self.all().map(FrozenPoint::stability))
    }

    /// Gains of the points of the map that do not hold the plant.
    #[must_use]
    pub fn unstable(&self) -> usize {
        Self::count(&self.points, Stability::Unstable)
    }

    /// Gains of the cells that do not hold the plant.
    #[must_use]
    pub fn unstable_nodes(&self) -> usize {
        Self::count(&self.nodes, Stability::Unstable)
    }

    /// How many of some of its points have this verdict.
    pub(in crate::analysis) fn count(points: &[FrozenPoint], verdict: Stability) -> usize {
        count(points.iter().map(FrozenPoint::stability), verdict)
    }

    /// True if every gain that was looked at holds the plant with margins that are proved.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.all().all(|point| point.margins.is_ok())
    }
}

impl FrozenPoint {
    /// Whether the gains hold the plant.
    #[must_use]
    pub fn stability(&self) -> Stability {
        Stability::of(&self.margins)
    }
}

/// Makes a map of loops.
struct Mapper<'a> {
    loops: FrozenLoops<'a>,
}

impl Mapper<'_> {
    fn map(&self) -> Result<Option<FrozenMap>, SimError> {
        let side = self.loops.question.map_points;
        let range = self.loops.fspid.tuner().supervisor().range();
        let place = |index: usize| match side {
            1 => 0.0,
            _ => range * (2.0 * index as f64 / (side - 1) as f64 - 1.0),
        };
        let inputs = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
        let points = inputs
            .map(|(row, column)| self.point([place(row), place(column)]))
            .collect::<Result<Vec<_>, _>>()?;
        let nodes = self.nodes().into_iter().map(|input| self.point(input));
        let nodes = nodes.collect::<Result<Vec<_>, _>>()?;
        let Some(worst) = worst_of(points.iter().chain(&nodes), |it| &it.margins) else {
            return Ok(None);
        };
        let mut worst = self.refined(worst.clone(), range, 2.0 * range / side.max(2) as f64)?;
        worst.margins = self.loops.margins_in_full(worst.gains)?;
        let beside = self.loops.fspid.tuner().settings().second_input.beside();
        Ok(Some(FrozenMap { beside, side, points, nodes, worst }))
    }

    /// Inputs at the numbers themselves, where rules conclude some: between them the gains are mixtures, so
    /// that the largest and the smallest of each are there.
    fn nodes(&self) -> Vec<[f64; 2]> {
        let tuner = self.loops.fspid.tuner();
        if tuner.supervisor().numbers().is_none() {
            return Vec::new();
        }
        let (range, sets) = (tuner.supervisor().range(), tuner.settings().input_sets);
        let [errors, changes] = [sets.error, sets.change].map(|places| {
            let [small, medium] =
                places.map_or([1.0 / 3.0, 2.0 / 3.0], |it| [it.small(), it.medium()]);
            [-1.0, -medium, -small, 0.0, small, medium, 1.0].map(|part| part * range)
        });
        errors.into_iter().flat_map(|error| changes.map(|change| [error, change])).collect()
    }

    /// Looks around a point, nearer and nearer, for a worse one.
    fn refined(
        &self,
        mut worst: FrozenPoint,
        range: f64,
        mut distance: f64,
    ) -> Result<FrozenPoint, SimError> {
        for _ in 0..REFINEMENTS {
            distance *= 0.5;
            let [error, change] = worst.input;
            for (by_error, by_change) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
                let near = |value: f64, by: f64| (value + by * distance).clamp(-range, range);
                let point = self.point([near(error, by_error), near(change, by_change)])?;
                if rank(&point.margins) < rank(&worst.margins) {
                    worst = point;
                }
            }
        }
        Ok(worst)
    }

    fn point(&self, input: [f64; 2]) -> Result<FrozenPoint, SimError> {
        let gains = producible(self.loops.fspid.tuner(), input[0], input[1]);
        Ok(FrozenPoint { input, gains, margins: self.loops.margins(gains)? })
    }
}
