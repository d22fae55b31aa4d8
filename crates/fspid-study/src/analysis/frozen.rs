//! Margins at every gain that a supervisor can produce, the gains standing still.

use fspid_core::{Fspid, Gains, Law};
use fspid_lti::LoopFamily;
use fspid_proof::gain_set::producible;
use fspid_sim::loop_model::{LoopModel, Memory};
use fspid_sim::{LinearPlant, Scenario, SimError};

use super::Question;
use super::answer::Margins;
use super::rank::{judged, rank};
use super::stability::Stability;
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

/// Halvings of the distance of points around the worst one.
const REFINEMENTS: u32 = 4;

impl FrozenMap {
    /// The map of a self-tuning controller with a plant; none for gains that remember.
    pub(super) fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        fspid: &Fspid<f64>,
        question: Question,
    ) -> Result<Option<Self>, SimError> {
        if fspid.tuner().settings().law != Law::Memoryless {
            return Ok(None);
        }
        Mapper::new(scenario, plant, fspid, question)?.map()
    }

    /// Every gain that was looked at: on the map, at the cells, and the worst of the search.
    pub fn all(&self) -> impl Iterator<Item = &FrozenPoint> {
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
        count(&self.points, Stability::Unstable)
    }

    /// Gains of the cells that do not hold the plant.
    #[must_use]
    pub fn unstable_nodes(&self) -> usize {
        count(&self.nodes, Stability::Unstable)
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

/// How many of some gains have this verdict.
pub(super) fn count(points: &[FrozenPoint], verdict: Stability) -> usize {
    points.iter().filter(|point| point.stability() == verdict).count()
}

/// The loops of all frozen gains, and how their margins are found.
struct Mapper<'a> {
    scenario: &'a Scenario,
    plant: &'a LinearPlant,
    fspid: &'a Fspid<f64>,
    question: Question,
    /// The loop with all of the memory that the gains at rest let out.
    model: LoopModel<f64>,
    /// The same for all gains at once, if they differ in its output alone.
    family: Option<LoopFamily>,
}

impl<'a> Mapper<'a> {
    fn new(
        scenario: &'a Scenario,
        plant: &'a LinearPlant,
        fspid: &'a Fspid<f64>,
        question: Question,
    ) -> Result<Self, SimError> {
        let rest = producible(fspid.tuner(), 0.0, 0.0);
        let config = fspid.config_at(rest);
        let model = LoopModel::of(scenario, plant, &config, Memory::of_gains(rest, &config))?
            .sharpened(scenario, plant)?;
        let family = model.family(question.point)?;
        Ok(Self { scenario, plant, fspid, question, model, family })
    }

    fn map(&self) -> Result<Option<FrozenMap>, SimError> {
        let side = self.question.map_points;
        let range = self.fspid.tuner().supervisor().range();
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
        let Some(worst) = worst_of(points.iter().chain(&nodes)) else { return Ok(None) };
        let mut worst = self.refined(worst.clone(), range, 2.0 * range / side.max(2) as f64)?;
        worst.margins = self.margins(worst.gains)?;
        let beside = self.fspid.tuner().settings().second_input.beside();
        Ok(Some(FrozenMap { beside, side, points, nodes, worst }))
    }

    /// Inputs at the numbers themselves, where rules conclude some: between them the gains are mixtures, so
    /// that the largest and the smallest of each are there.
    fn nodes(&self) -> Vec<[f64; 2]> {
        let tuner = self.fspid.tuner();
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
        let gains = producible(self.fspid.tuner(), input[0], input[1]);
        let margins = match self.quick_margins(gains) {
            Some(margins) => Ok(margins),
            None => self.margins(gains)?,
        };
        Ok(FrozenPoint { input, gains, margins })
    }

    /// Margins by the family, where it is sure of them and the gains let out the memory that it has.
    fn quick_margins(&self, gains: Gains<f64>) -> Option<Margins> {
        if self.question.every_point_in_full {
            return None;
        }
        if !self.has_the_config_at(gains)
            || Memory::of_gains(gains, self.fspid.config()) != self.model.settings().memory
        {
            return None;
        }
        let found = self.family.as_ref()?.margins(&[gains.kp, gains.ki, gains.kd])?;
        Some(Margins::of(&found))
    }

    /// Whether the loop at these gains is the model's but for the gains: nothing follows them, or they are
    /// where the model was made.
    fn has_the_config_at(&self, gains: Gains<f64>) -> bool {
        self.fspid.config_at(gains) == self.model.settings().config
    }

    /// Margins of one loop by eigenvalues.
    fn margins(&self, gains: Gains<f64>) -> Result<Result<Margins, Absent>, SimError> {
        let config = self.fspid.config_at(gains);
        let memory = Memory::of_gains(gains, &config);
        let open = if self.has_the_config_at(gains) && memory == self.model.settings().memory {
            self.model.open(gains, self.question.point)?
        } else {
            let own = LoopModel::of(self.scenario, self.plant, &config, memory)?
                .sharpened(self.scenario, self.plant)?;
            own.open(gains, self.question.point)?
        };
        let margins = judged(&open)?.as_deref().map(Margins::of).map_err(|reason| *reason);
        Ok(margins)
    }
}

fn worst_of<'a>(points: impl Iterator<Item = &'a FrozenPoint>) -> Option<&'a FrozenPoint> {
    points.min_by(|one, other| rank(&one.margins).total_cmp(&rank(&other.margins)))
}
