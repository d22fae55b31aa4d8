//! Linear analysis of a study's loops: margins as sampled, and the frozen gains of a self-tuning
//! controller.
//!
//! What is analysed is the loop around rest: exact zero-order hold of plant and actuator, delays,
//! scale and delay of sensors, the controller as it is implemented; no limit at work. The loop is
//! broken at a named point, the others stay closed. A loop that is unstable has no margins.
//!
//! A self-tuning controller is analysed at the gains that it has at rest. That its gains move is not
//! in these numbers: see the frozen-gain map for every gain it can have while they stand still.

mod ages;
mod answer;
mod around;
mod at_rest;
mod equilibrium;
mod externals;
pub(crate) mod figures;
mod flights;
mod flown;
mod frozen;
mod json;
mod loops;
mod modes;
mod nonlinear_parts;
mod rank;
mod stability;
mod step;
mod text;
mod too_large;

use fspid_plot::Svg;
use fspid_sim::{Scenario, SimError};

use fspid_scenario::file::Study;

pub use answer::{Margins, decibels};
pub use around::Around;
pub use at_rest::{AtRest, RestGains, held_in_words};
pub use equilibrium::{Equilibrium, equilibrium};
pub use externals::FlownExternal;
pub use flights::Flights;
pub use flown::flown_inputs;
pub use frozen::{Frozen, FrozenGains, FrozenMap, FrozenPoint, FrozenReach};
pub use fspid_sim::loop_model::BreakPoint;
pub use loops::{AnalysedLoop, PlantLoop, RestLoop, lasting_plants};
pub(crate) use loops::{asked_plants, held_at_rest};
pub use modes::AnalysedMode;
pub use nonlinear_parts::not_in_the_linear_loop;
pub use stability::Stability;
pub(crate) use step::step_responses;
pub(crate) use too_large::too_large;

/// What to analyse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// Where the loop is broken.
    pub point: BreakPoint,
    /// Points along each input of the frozen-gain map; none for 0.
    pub map_points: usize,
    /// Ask every point of the map in full, one by one, in place of the quick way for many gains: its
    /// numbers are those of the gains as fixed ones, to the bit.
    pub every_point_in_full: bool,
    /// Fly as well: margins by flying, limit cycles, small signals along the way.
    pub fly: bool,
}

impl Question {
    /// True if flights are asked for. A page asks for none, and what they need is not even compiled for it.
    #[inline(always)]
    const fn flies(&self) -> bool {
        self.fly && !cfg!(target_family = "wasm")
    }
}

impl Default for Question {
    fn default() -> Self {
        Self { point: BreakPoint::Command, map_points: 9, every_point_in_full: false, fly: false }
    }
}

/// The loops of a study, analysed.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Name of the scenario.
    pub scenario: String,
    /// What was asked.
    pub question: Question,
    /// One for each controller, in the file's order.
    pub loops: Vec<AnalysedLoop>,
    /// Controllers that have no loop.
    pub externals: Vec<FlownExternal>,
    /// What acts in flight and is not in the linear loop.
    pub left_out: Vec<String>,
}

/// Columns by name, which ends in the unit.
pub type Columns = Vec<(&'static str, Vec<f64>)>;

impl Analysis {
    /// Analyses every controller of a study.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model or cannot be sampled.
    pub fn of(study: &Study, question: Question) -> Result<Self, SimError> {
        let mut analysis = Self::of_scenario(&study.scenario, question)?;
        for (found, named) in analysis.loops.iter_mut().zip(&study.scenario.controllers) {
            found.doubt_flight(&study.scenario, named);
        }
        Ok(analysis)
    }

    /// Analyses every controller of a scenario.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn of_scenario(scenario: &Scenario, question: Question) -> Result<Self, SimError> {
        scenario.plant.require_equations()?;
        let loops = scenario
            .controllers
            .iter()
            .map(|named| {
                AnalysedLoop::of(scenario, named, question).map_err(|error| too_large(error, named))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let flown = |named| FlownExternal::of(scenario, named, &question, &loops);
        let externals = scenario.externals.iter().map(flown).collect::<Result<_, _>>()?;
        let left_out = not_in_the_linear_loop(scenario);
        Ok(Self { scenario: scenario.name.clone(), question, loops, externals, left_out })
    }

    /// The open loop of each controller in the worst plant over frequency (rad/s), 600 points in five decades up to the
    /// Nyquist frequency: value, gain (dB), phase (deg), sensitivity and complementary sensitivity (dB). The phase is continuous and begins between -270 and 90 deg.
    /// Loops without margins to be read off have their curve as well; those of external controllers have none.
    #[must_use]
    pub fn open_loops(&self) -> Vec<(String, Columns)> {
        figures::LoopFigures::of(self).columns()
    }

    /// Poles and zeros of the sampled loop of each controller in the worst plant, in the z-plane: those of the closed
    /// loop, of the open one, and its zeros, real and imaginary parts.
    ///
    /// # Errors
    /// Eigenvalues that are not found.
    pub fn poles(&self) -> Result<Vec<(String, Columns)>, SimError> {
        figures::LoopFigures::of(self).pole_columns()
    }

    /// Bode, Nyquist and Nichols diagram and the sensitivities of all loops, drawn as a report draws them; none where no
    /// controller has a loop.
    #[must_use]
    pub fn response_figures(&self) -> Vec<(&'static str, Svg)> {
        figures::LoopFigures::of(self).named()
    }

    /// Whether every loop is stable at rest and at every gain of its map, with margins or without; undecided where a
    /// controller without a loop was seen to fail in flight.
    #[must_use]
    pub fn stability(&self) -> Stability {
        let plants = self.loops.iter().flat_map(|found| &found.plants);
        let around = self.loops.iter().map(AnalysedLoop::around);
        let loops = plants.map(PlantLoop::stability_at_every_gain).chain(around);
        let loops = Stability::of_all(loops);
        match self.externals.iter().all(FlownExternal::is_held) {
            true => loops,
            false => Stability::of_all([loops, Stability::Undecided]),
        }
    }

    /// True if every loop is held with margins that are proved, at every gain of its map too, and no flight of a
    /// controller without a loop was seen to fail.
    #[must_use]
    pub fn all_held(&self) -> bool {
        self.loops.iter().all(AnalysedLoop::is_held)
            && self.externals.iter().all(FlownExternal::is_held)
    }
}
