//! What answers requirements: one controller's flight, its linear loops, and the aircraft alone.

mod aircraft;
mod airframe;
mod flown;
mod frozen;
mod linear;
mod proof;

use std::cell::OnceCell;

use fspid_sim::{Controller, Flyer, NamedController};

use super::{Case, NotEvaluated};
use crate::flight::ControllerResult;
use crate::metrics::Verdict;
use fspid_scenario::file::Study;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::Requirement;
use linear::PlantEvidence;

pub(super) use flown::{check_air, time_that_counts};

/// Everything that is known of one controller of a study. What a flight does not show is computed when it is first
/// asked for.
#[derive(Debug)]
pub struct Evidence<'a> {
    study: &'a Study,
    flyer: Flyer<'a>,
    result: &'a ControllerResult,
    /// Whether the loops are stable, asked of every flight.
    held: OnceCell<Result<(), NotEvaluated>>,
    /// The loops with their margins, which take ten times as long.
    loops: OnceCell<Result<Vec<PlantEvidence>, NotEvaluated>>,
    /// The same with maps of frozen gains, which take a hundred times as long.
    mapped: OnceCell<Result<Vec<PlantEvidence>, NotEvaluated>>,
}

/// Cases of a measure of the linear loop of a study's first controller, without a flight.
pub(super) fn loop_cases(
    study: &Study,
    requirement: &Requirement,
) -> Result<Vec<Case>, NotEvaluated> {
    let Some(named) = study.scenario.controllers.first() else {
        return Err(NotEvaluated::External);
    };
    let is_mapped = requirement.measure.family() == Family::Frozen;
    if is_mapped {
        frozen::require_whole_map(&named.controller)?;
    }
    let points = if is_mapped { MAP_POINTS } else { 0 };
    let loops = linear::loops(&study.scenario, named, points)?;
    match is_mapped {
        true => frozen::cases(&loops, requirement),
        false => linear::rest_cases(&loops, requirement),
    }
}

/// Points along each input of a map of frozen gains.
const MAP_POINTS: usize = 9;

impl<'a> Evidence<'a> {
    /// Evidence of a flight of one of a study's controllers.
    #[must_use]
    pub fn new(study: &'a Study, flyer: Flyer<'a>, result: &'a ControllerResult) -> Self {
        Self {
            study,
            flyer,
            result,
            held: OnceCell::new(),
            loops: OnceCell::new(),
            mapped: OnceCell::new(),
        }
    }

    /// Name of the controller.
    #[must_use]
    pub fn controller(&self) -> &str {
        self.flyer.name()
    }

    /// The controller's equations.
    fn named(&self) -> Result<&'a NamedController, NotEvaluated> {
        match self.flyer {
            Flyer::Own(named) => Ok(named),
            Flyer::External(_) => Err(NotEvaluated::External),
        }
    }

    /// Every case of a requirement's measure: the steps of a flight, the plants, the frozen gains.
    ///
    /// # Errors
    /// [`NotEvaluated`] where one case has no value; the others do not count then.
    pub fn cases(&self, requirement: &Requirement) -> Result<Vec<Case>, NotEvaluated> {
        if requirement.measure == Measure::Saturated && self.flyer.controller().is_none() {
            return Err(NotEvaluated::OwnWord);
        }
        match requirement.measure.family() {
            Family::Step | Family::Flight | Family::Aircraft => {
                // Where the loop says it of each plant, it says of which.
                if self.is_unstable_beyond_fixed_gains() {
                    self.require_stability()?;
                }
                flown::require_measures(self.result)?;
                self.require_stability()?;
                flown::cases(self.study, self.result, requirement)
            }
            Family::Loop => {
                let has_modes = self.study.scenario.autopilot.is_some();
                linear::cases(self.loops()?, (self.result, has_modes), requirement)
            }
            Family::Frozen => {
                frozen::require_whole_map(&self.named()?.controller)?;
                frozen::cases(self.mapped()?, requirement)
            }
            Family::Airframe => airframe::cases(self.study, requirement),
            Family::Proof => {
                linear::require_decided_but_for_gains(self.result)?;
                proof::cases(self.study, self.named()?)
            }
        }
    }

    /// True for the verdict of a loop at rest whose gains move or whose command is limited.
    fn is_unstable_beyond_fixed_gains(&self) -> bool {
        let is_simple = match self.flyer.controller() {
            Some(Controller::Fixed(pid)) => pid.config().is_linear(),
            Some(Controller::SelfTuning(_)) | None => false,
        };
        !is_simple && matches!(self.result.metrics.verdict, Verdict::Unstable { .. })
    }

    /// A flight of a loop that is unstable at rest proves nothing, however calm its window is.
    fn require_stability(&self) -> Result<(), NotEvaluated> {
        let scenario = &self.study.scenario;
        // Without equations there is nothing but the flight; with outer loops the flight is told by their modes.
        let Flyer::Own(named) = self.flyer else { return Ok(()) };
        if scenario.autopilot.is_some() {
            return Ok(());
        }
        let held = self.held.get_or_init(|| linear::require_stability(scenario, named));
        held.clone()
    }

    fn loops(&self) -> Result<&[PlantEvidence], NotEvaluated> {
        self.computed(&self.loops, 0)
    }

    fn mapped(&self) -> Result<&[PlantEvidence], NotEvaluated> {
        self.computed(&self.mapped, MAP_POINTS)
    }

    fn computed<'b>(
        &self,
        cell: &'b OnceCell<Result<Vec<PlantEvidence>, NotEvaluated>>,
        map_points: usize,
    ) -> Result<&'b [PlantEvidence], NotEvaluated> {
        let scenario = &self.study.scenario;
        let named = self.named()?;
        let loops = cell.get_or_init(|| linear::loops(scenario, named, map_points));
        loops.as_deref().map_err(NotEvaluated::clone)
    }
}
