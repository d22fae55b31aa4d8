#![doc = include_str!("../README.md")]
//!
//! No features. Not here: scenarios and flights (`fspid-tune`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod bfgs;
mod cma_es;
mod cma_strategy;
mod de;
mod eigen;
mod ga;
mod hypervolume;
mod kind;
mod lshade;
mod member;
mod nelder_mead;
mod nsga_ii;
mod progress;
mod pso;
mod random;
mod search;
mod sorting;
mod space;
mod variation;

pub use bfgs::Bfgs;
pub use cma_es::{CmaEs, Restarts};
pub use de::DifferentialEvolution;
pub use ga::Genetic;
pub use hypervolume::hypervolume;
pub use kind::{Kind, Plan, Snapshot, UnsoundState};
pub use lshade::LShade;
pub use nelder_mead::NelderMead;
pub use nsga_ii::{NsgaII, ParetoMember, ParetoOptimiser};
pub use pso::ParticleSwarm;
pub use search::{Budget, Found, polish, search};
pub use space::{Parameter, Scale, Space};

use serde::{Deserialize, Serialize};

/// Where a population begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<'a> {
    /// Anywhere in the cube.
    Anywhere,
    /// At a point, the others normally distributed about it with this standard deviation.
    About(&'a [f64], f64),
}

/// Why a search is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// The evaluations are spent.
    Budget,
    /// The cost wanted was reached.
    Target,
    /// The candidates no longer differ in cost.
    NoProgress,
    /// The candidates no longer differ at all.
    Collapsed,
    /// None of these: what was found so far was taken.
    Taken,
}

/// Proposes candidates in the unit cube and absorbs their costs.
pub trait Optimiser {
    /// The next candidates to be evaluated, the same until they are told; none when there is nothing
    /// left to try.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// Takes the costs of the candidates of the last [`ask`](Self::ask), in their order. Candidates
    /// at the end without a cost count as infinite and as not evaluated.
    fn tell(&mut self, costs: &[f64]);

    /// The best point so far and its cost; an infinite cost before the first answer.
    fn best(&self) -> (&[f64], f64);

    /// Costs it was told.
    fn spent(&self) -> usize;

    /// Why it proposes nothing more, if so.
    fn stop(&self) -> Option<Stop>;

    /// Its whole state.
    fn snapshot(&self) -> Snapshot;
}

/// Asks, evaluates and tells until the optimiser stops, `budget` evaluations are spent or the cost is
/// at most `target`. The last generation is cut to what is left of the budget.
pub fn minimise(
    optimiser: &mut dyn Optimiser,
    budget: usize,
    target: f64,
    mut evaluate: impl FnMut(&[Vec<f64>]) -> Vec<f64>,
) -> Stop {
    loop {
        if optimiser.best().1 <= target {
            return Stop::Target;
        }
        let left = budget.saturating_sub(optimiser.spent());
        if left == 0 {
            return Stop::Budget;
        }
        let mut candidates = optimiser.ask();
        if candidates.is_empty() {
            return optimiser.stop().unwrap_or(Stop::Collapsed);
        }
        candidates.truncate(left);
        optimiser.tell(&evaluate(&candidates));
    }
}

/// A coordinate put back into [0, 1] by reflection at the side it left.
fn reflected(coordinate: f64) -> f64 {
    let folded = coordinate.abs() % 2.0;
    if folded > 1.0 { 2.0 - folded } else { folded }
}
