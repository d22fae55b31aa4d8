//! What flights say of a loop: how much gain, delay and lag they bear, limit cycles under limits, and the
//! small signals along the way. None of it is a proof.

mod json;
mod text;

pub(super) use json::empirical_json;
pub(super) use text::empirical_lines;

use fspid_sim::describing::{LimitCycles, Search, limit_cycles};
use fspid_sim::flown::empirical::{EmpiricalAnswer, EmpiricalOptions, empirical_margins};
use fspid_sim::flown::trajectory::{TrajectoryLinearisation, linearise_along};
use fspid_sim::{Controller, Scenario, SimError};

/// Points at which a trajectory is looked at, at most.
const POINTS: usize = 400;

/// What flights say of one controller.
#[derive(Clone, Debug)]
pub struct Flights {
    /// How much gain, delay and lag the scenario's flight bears.
    pub empirical: EmpiricalAnswer,
    /// Limit cycles that describing functions predict at the gains at rest.
    pub limit_cycles: LimitCycles,
    /// The loop linearised along its flight; of self-tuning controllers only whose supervisor sees the
    /// error and its change through even sets, and of which nothing but the gains moves.
    pub along: Option<TrajectoryLinearisation>,
}

impl Flights {
    /// Flies a controller.
    ///
    /// # Errors
    /// [`SimError`] where the scenario cannot be flown.
    pub(super) fn of(scenario: &Scenario, controller: &Controller) -> Result<Self, SimError> {
        let dt_s = scenario.timing.dt_s();
        let every = scenario.timing.rows().div_ceil(POINTS);
        let along = match controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(_) => match linearise_along(scenario, controller, every) {
                Err(SimError::Structure) => None,
                along => Some(along?),
            },
        };
        Ok(Self {
            empirical: empirical_margins(scenario, controller, &EmpiricalOptions::default())?,
            limit_cycles: limit_cycles(scenario, controller, &Search::sampled_every(dt_s))?,
            along,
        })
    }
}
