//! The optimisers by name, what each is given, and their states.

use serde::{Deserialize, Serialize};

use super::{
    CmaEs, DifferentialEvolution, Genetic, LShade, NelderMead, Optimiser, ParticleSwarm, Restarts,
    Start, Stop,
};

/// Size of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plan {
    /// Coordinates of a point.
    pub dimension: usize,
    /// Candidates of a generation; raised to what the optimiser needs at least.
    pub population: usize,
    /// Evaluations after which it proposes nothing more.
    pub budget: usize,
    /// Seed of every random number.
    pub seed: u64,
}

impl Plan {
    pub(super) fn over(self, spent: usize) -> Option<Stop> {
        (spent >= self.budget).then_some(Stop::Budget)
    }
}

/// An optimiser of one cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// [`CmaEs`] with growing restarts.
    CmaEs,
    /// [`DifferentialEvolution`].
    De,
    /// [`LShade`].
    LShade,
    /// [`ParticleSwarm`].
    Pso,
    /// [`Genetic`].
    Ga,
    /// [`NelderMead`].
    NelderMead,
}

impl Kind {
    /// Every kind with its name.
    pub const NAMES: [(Self, &'static str); 6] = [
        (Self::CmaEs, "cma-es"),
        (Self::De, "de"),
        (Self::LShade, "l-shade"),
        (Self::Pso, "pso"),
        (Self::Ga, "ga"),
        (Self::NelderMead, "nelder-mead"),
    ];

    /// Its name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(kind, _)| *kind == self).map_or("", |(_, name)| name)
    }

    /// The kind of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, own)| *own == name).map(|(kind, _)| *kind)
    }

    /// Candidates of a generation that served best with a thousand evaluations a dimension, in
    /// `tests/optimisers.rs`.
    #[must_use]
    pub fn usual_population(self, dimension: usize) -> usize {
        let n = dimension.max(1);
        match self {
            // Half as many again as Hansen (2016), equation 48: fewer local minima.
            Self::CmaEs => 3 * (4 + (3.0 * libm::log(n as f64)) as usize) / 2,
            Self::De => (2 * n).max(20),
            // Tanabe and Fukunaga (2014): 18 n.
            Self::LShade => 18 * n,
            Self::Pso => 40,
            Self::Ga => 30,
            // Corners; it has no choice.
            Self::NelderMead => n + 1,
        }
    }

    /// An optimiser at its start.
    #[must_use]
    pub fn start(self, plan: Plan, start: Start<'_>) -> Box<dyn Optimiser> {
        let Plan { dimension, population, budget, seed } = plan;
        match self {
            Self::CmaEs => Box::new(CmaEs::new(plan, Restarts::Growing, start)),
            Self::De => Box::new(DifferentialEvolution::new(plan, start)),
            Self::LShade => Box::new(LShade::new(dimension, population, budget, seed, start)),
            Self::Pso => Box::new(ParticleSwarm::new(plan, start)),
            Self::Ga => Box::new(Genetic::new(plan, start)),
            Self::NelderMead => Box::new(NelderMead::from_unknown(plan, start)),
        }
    }
}

/// The whole state of an optimiser as plain data, candidates on their way included.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Snapshot {
    /// Of [`CmaEs`].
    CmaEs(CmaEs),
    /// Of [`DifferentialEvolution`].
    De(DifferentialEvolution),
    /// Of [`LShade`].
    LShade(LShade),
    /// Of [`ParticleSwarm`].
    Pso(ParticleSwarm),
    /// Of [`Genetic`].
    Ga(Genetic),
    /// Of [`NelderMead`].
    NelderMead(NelderMead),
}

/// A state that no optimiser can have been in: lengths that do not fit, points outside the cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this is not a state of `{optimiser}`: its numbers do not fit together")]
pub struct UnsoundState {
    /// Name of the optimiser whose state it claims to be.
    pub optimiser: &'static str,
}

impl Snapshot {
    /// The optimiser as it was; it asks again for the candidates that were on their way.
    ///
    /// # Errors
    /// [`UnsoundState`] where the numbers do not fit together.
    pub fn resume(self) -> Result<Box<dyn Optimiser>, UnsoundState> {
        match self {
            Self::CmaEs(state) => sound(Kind::CmaEs, state.is_sound(), state),
            Self::De(state) => sound(Kind::De, state.is_sound(), state),
            Self::LShade(state) => sound(Kind::LShade, state.is_sound(), state),
            Self::Pso(state) => sound(Kind::Pso, state.is_sound(), state),
            Self::Ga(state) => sound(Kind::Ga, state.is_sound(), state),
            Self::NelderMead(state) => sound(Kind::NelderMead, state.is_sound(), state),
        }
    }
}

fn sound(
    kind: Kind,
    is_sound: bool,
    state: impl Optimiser + 'static,
) -> Result<Box<dyn Optimiser>, UnsoundState> {
    if is_sound { Ok(Box::new(state)) } else { Err(UnsoundState { optimiser: kind.name() }) }
}
