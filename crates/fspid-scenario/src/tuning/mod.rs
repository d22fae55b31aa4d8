//! What a scenario says of its tuning: which numbers are free, what makes a flight good, and on what.
//!
//! Plain data, read and checked with the scenario; `fspid-tune` searches by it.

mod tunable_grid;
mod tunable_numbers;
mod tunable_parameter;

pub use tunable_grid::{Monotone, TunableGrid};
pub use tunable_numbers::TunableNumbers;
pub use tunable_parameter::{Free, TunableNumber, TunableParameter};

use crate::requirement::Requirement;

/// How the costs of many flights become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Over {
    /// Their mean, weighted by case.
    Mean,
    /// The greatest.
    Worst,
    /// The mean of the greatest of them: conditional value at risk.
    Tail {
        /// Which share of the flights counts, above 0 and up to 1.
        share: f64,
    },
}

/// The scenario with some changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What it is called; unique among its kind.
    pub name: String,
    /// What kind of case it is, for people: plants, commands, gusts.
    pub group: String,
    /// The changes, as `--set` takes them.
    pub set: Vec<String>,
    /// How much it counts in a mean.
    pub weight: f64,
    /// Name of the case that this one is the mirror image of; in contests only.
    pub mirror_of: Option<String>,
}

/// A measure that is to become small, or large where its weight is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// The measure with its conditions; its limits only say which side is bad.
    pub requirement: Requirement,
    /// What a unit of the measure costs; not 0.
    pub weight: f64,
    /// A bad value, against which the volume of a Pareto front is counted.
    pub reference: Option<f64>,
}

/// How a scenario is tuned.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuning {
    /// Name of the optimiser, unless the command line says another.
    pub optimiser: String,
    /// Evaluations, unless the command line says others.
    pub budget: usize,
    /// Seed, unless the command line says another.
    pub seed: u64,
    /// Name of the controller, where several have free numbers.
    pub controller: Option<String>,
    /// How flights become one cost.
    pub over: Over,
    /// Draws of the dispersions in each case, the same for every candidate; 0 for the scenario as written.
    pub runs: u64,
    /// Seed of the draws.
    pub run_seed: u64,
    /// The cases; the scenario itself where there are none.
    pub cases: Vec<Case>,
    /// What makes a flight good.
    pub objectives: Vec<Objective>,
    /// Limits of means over all flights, weighted by case.
    pub limits: Vec<Requirement>,
    /// Whether a candidate must take off a constant load, if its controller has an integral.
    pub removes_constant_load: bool,
}

/// On what tuned controllers are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// How many seeds each controller is tuned with.
    pub seeds: u64,
    /// Flights that nobody tuned on.
    pub cases: Vec<Case>,
    /// Draws of the dispersions in each case; 0 for the scenario as written.
    pub runs: u64,
    /// Seed of the draws.
    pub run_seed: u64,
    /// Names of the controllers that the others are compared with; the first one if left out.
    pub against: Option<String>,
}
