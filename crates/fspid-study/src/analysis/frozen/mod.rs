//! Margins at every gain that a self-tuner can fly with, the gains standing still.
//!
//! Under the memoryless law gains belong to the supervisor's inputs: a [`FrozenMap`] over these. Under the accumulating law
//! they belong to all that came before: a [`FrozenReach`] over the body of gains that a proof bounds them by.

mod map;
mod reach;

use fspid_core::{Fspid, Gains, Law, Pid};
use fspid_lti::LoopFamily;
use fspid_sim::loop_model::{LoopModel, Memory};
use fspid_sim::{Controller, LinearPlant, Rest, Scenario, SimError};

use super::ages::Asked;
use super::answer::Margins;
use super::loops::verdict_of;
use super::rank::{judged, rank};
use super::stability::Stability;
use super::{BreakPoint, Question};
use crate::metrics::Absent;
pub use map::{FrozenMap, FrozenPoint};
pub use reach::{FrozenGains, FrozenReach};

/// Halvings of the distance of points around the worst one.
const REFINEMENTS: u32 = 4;

/// How many of some gains have this verdict.
pub(super) fn count(all: impl Iterator<Item = Stability>, verdict: Stability) -> usize {
    all.filter(|found| *found == verdict).count()
}

/// The gains of a self-tuner, each standing still.
#[derive(Clone, Debug)]
pub enum Frozen {
    /// Those of a law without memory.
    OfInputs(FrozenMap),
    /// Those that an accumulating law may come to.
    WithinReach(FrozenReach),
}

impl Frozen {
    /// Those of a controller around a plant; none of gains that are fixed, or that nothing bounds, or where none is asked for.
    pub(super) fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
        at_rest: Gains<f64>,
        question: Question,
    ) -> Result<Option<Self>, SimError> {
        let Controller::SelfTuning(fspid) = controller else { return Ok(None) };
        if question.map_points == 0 {
            return Ok(None);
        }
        Ok(match fspid.tuner().settings().law {
            Law::Memoryless => FrozenMap::of(scenario, plant, fspid, question)?.map(Self::OfInputs),
            Law::Accumulating { .. } => {
                let reach = FrozenReach::of(scenario, plant, fspid, at_rest, question)?;
                reach.map(Self::WithinReach)
            }
        })
    }
}

/// The loops of all frozen gains, and how their margins are found.
struct FrozenLoops<'a> {
    scenario: &'a Scenario,
    plant: &'a LinearPlant,
    fspid: &'a Fspid<f64>,
    question: Question,
    /// The loop with all of the memory that the gains it is made with let out.
    model: LoopModel<f64>,
    /// The same for all gains at once, if they differ in its output alone.
    family: Option<LoopFamily>,
}

impl<'a> FrozenLoops<'a> {
    /// The loops, made with some of the gains.
    fn new(
        scenario: &'a Scenario,
        plant: &'a LinearPlant,
        fspid: &'a Fspid<f64>,
        gains: Gains<f64>,
        question: Question,
    ) -> Result<Self, SimError> {
        let config = fspid.config_at(gains);
        let model = LoopModel::of(scenario, plant, &config, Memory::of_gains(gains, &config))?
            .sharpened(scenario, plant)?;
        let family = model.family(question.point)?;
        Ok(Self { scenario, plant, fspid, question, model, family })
    }

    /// Margins of gains, the quick way where that is allowed and sure.
    fn margins(&self, gains: Gains<f64>) -> Result<Result<Margins, Absent>, SimError> {
        let found = match self.quick_margins(gains) {
            Some(margins) => Ok(margins),
            None => self.by_eigenvalues(gains)?,
        };
        self.as_ages_come(gains, found, |_, margins| Ok(Ok(margins)))
    }

    /// Margins that are told, by eigenvalues; behind a sensor whose values change their age those that are borne as they do.
    fn margins_in_full(&self, gains: Gains<f64>) -> Result<Result<Margins, Absent>, SimError> {
        let found = self.by_eigenvalues(gains)?;
        let is_asked = self.question.point == BreakPoint::Command;
        self.as_ages_come(gains, found, |asked, margins| match is_asked {
            true => asked.borne(margins),
            false => Ok(Ok(margins)),
        })
    }

    /// Margins are of the largest age of a sensor's values, which does not stay: whether gains hold the plant is said by the
    /// ages as they come, of a controller that has these gains for good.
    fn as_ages_come(
        &self,
        gains: Gains<f64>,
        found: Result<Margins, Absent>,
        borne: impl FnOnce(&Asked<'_>, Margins) -> Result<Result<Margins, Absent>, SimError>,
    ) -> Result<Result<Margins, Absent>, SimError> {
        if !self.model.has_changing_ages() {
            return Ok(found);
        }
        let Ok(pid) = Pid::new(gains, self.fspid.config_at(gains)) else { return Ok(found) };
        let (rest, controller) = (Rest::still(gains), Controller::Fixed(pid));
        let Self { scenario, plant, .. } = *self;
        if let Err(reason) = verdict_of(scenario, plant, &rest, &controller)? {
            return Ok(Err(reason));
        }
        match found {
            Err(Absent::Unstable { spectral_radius }) => {
                Ok(Err(Absent::OldestAge { spectral_radius }))
            }
            Ok(margins) => {
                let asked = Asked { scenario, plant, rest: &rest, controller: &controller };
                borne(&asked, margins)
            }
            other => Ok(other),
        }
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

    /// Margins of one loop by eigenvalues, with the largest age of what a sensor shows.
    fn by_eigenvalues(&self, gains: Gains<f64>) -> Result<Result<Margins, Absent>, SimError> {
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

/// The first of the worst.
fn worst_of<'a, T: 'a>(
    all: impl Iterator<Item = &'a T>,
    margins: fn(&T) -> &Result<Margins, Absent>,
) -> Option<&'a T> {
    all.min_by(|one, other| rank(margins(one)).total_cmp(&rank(margins(other))))
}
