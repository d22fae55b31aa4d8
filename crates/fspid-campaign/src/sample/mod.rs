//! Points of the unit cube: what run *i* draws.
//!
//! Point *i* is computed from the seed and from *i* alone (Latin hypercubes also need the number
//! of runs), in constant time and memory for each dimension, so that every shard on every machine
//! draws the same and none has to draw what came before.
//!
//! Coordinates are odd multiples of 2⁻⁵³ (quotients of such where there are strata), strictly
//! between 0 and 1.
//!
//! # Random streams
//! ChaCha8 of the campaign's seed: [`STREAM`] and the dimension for coordinates, [`KEY_STREAM`] and
//! the dimension for the keys of permutations and scrambles. Both lie beyond the streams of
//! disturbances, turbulence and sensors in `fspid-sim` (at most 6·2³²), so that a scenario with the
//! seed of its campaign does not share numbers with it.

mod directions;
mod error;
mod key;
mod latin_hypercube;
mod random;
mod sobol;
#[cfg(test)]
mod tests;

pub use error::SampleError;

use serde::Serialize;

use directions::DIRECTIONS;
use key::Key;
use latin_hypercube::Permutation;
use sobol::Sobol;

/// Number of the random stream of the first coordinate.
pub const STREAM: u64 = 1 << 40;
/// Number of the random stream of the first key.
pub const KEY_STREAM: u64 = 2 << 40;

/// Most runs of a campaign: what 32 binary digits can number.
pub const RUNS_LIMIT: u64 = 1 << 32;
/// Most dimensions of random points and Latin hypercubes; far beyond the numbers of a scenario.
pub const DIMENSIONS_LIMIT: usize = 4096;
/// Most dimensions of Sobol's sequence: all primitive polynomials up to degree 10.
pub const SOBOL_DIMENSIONS_LIMIT: usize = DIRECTIONS.len() + 1;

/// How the points of a campaign are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent points: what the formulas of confidence intervals assume.
    #[default]
    Random,
    /// Latin hypercube of McKay, Beckman and Conover (1979): in each dimension, exactly one point in
    /// each of as many strata as there are runs.
    LatinHypercube,
    /// Sobol's sequence with a nested random scramble: even in many dimensions at once, best where
    /// the number of runs is a power of two.
    Sobol,
}

impl Sampling {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Random, Self::LatinHypercube, Self::Sobol];

    /// The words in files.
    pub const NAMES: [&'static str; 3] = ["random", "latin-hypercube", "sobol"];

    /// The word in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// The sampling with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sampling| sampling.name() == name)
    }

    /// Most dimensions that it has.
    #[must_use]
    pub const fn dimensions_limit(self) -> usize {
        match self {
            Self::Random | Self::LatinHypercube => DIMENSIONS_LIMIT,
            Self::Sobol => SOBOL_DIMENSIONS_LIMIT,
        }
    }
}

/// The points of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Cube {
    sampling: Sampling,
    runs: u64,
    seed: u64,
    axes: Vec<Axis>,
}

/// What is prepared for a dimension.
#[derive(Clone, Debug, PartialEq)]
enum Axis {
    /// Nothing: the dimension is the number of the stream.
    Random,
    LatinHypercube(Box<Permutation>),
    Sobol(Box<Sobol>),
}

impl Cube {
    /// Points for so many runs, of so many coordinates each.
    ///
    /// # Errors
    /// [`SampleError`] for no runs or more than [`RUNS_LIMIT`], and for more dimensions than the
    /// sampling has. No dimension at all is allowed: nothing differs then.
    pub fn new(
        sampling: Sampling,
        dimensions: usize,
        runs: u64,
        seed: u64,
    ) -> Result<Self, SampleError> {
        if runs == 0 || runs > RUNS_LIMIT {
            return Err(SampleError::Runs { found: runs, limit: RUNS_LIMIT });
        }
        let limit = sampling.dimensions_limit();
        if dimensions > limit {
            return Err(match sampling {
                Sampling::Sobol => SampleError::SobolDimensions { found: dimensions, limit },
                _ => SampleError::Dimensions { found: dimensions, limit },
            });
        }
        let axis = |dimension: usize| {
            let key = || Key::new(seed, KEY_STREAM + dimension as u64);
            match sampling {
                Sampling::Random => Axis::Random,
                Sampling::LatinHypercube => {
                    Axis::LatinHypercube(Box::new(Permutation::new(runs, key())))
                }
                Sampling::Sobol => Axis::Sobol(Box::new(Sobol::new(dimension, key()))),
            }
        };
        Ok(Self { sampling, runs, seed, axes: (0..dimensions).map(axis).collect() })
    }

    /// How the points are spread.
    #[must_use]
    pub const fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// How many coordinates a point has.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// How many points there are.
    #[must_use]
    pub const fn runs(&self) -> u64 {
        self.runs
    }

    /// The seed of the points.
    #[must_use]
    pub const fn seed(&self) -> u64 {
        self.seed
    }

    /// Writes the coordinates of a run's point, each strictly between 0 and 1.
    ///
    /// Runs count from 0; one that does not exist stands for its remainder modulo the number of
    /// runs. Entries of `into` beyond the number of dimensions are left alone.
    pub fn point(&self, run: u64, into: &mut [f64]) {
        let run = run % self.runs;
        for ((dimension, axis), coordinate) in (0..).zip(&self.axes).zip(into) {
            let stream = STREAM + dimension;
            *coordinate = match axis {
                Axis::Random => random::coordinate(random::bits(self.seed, stream, run)),
                Axis::LatinHypercube(permutation) => {
                    let stratum = permutation.stratum(run);
                    let bits = random::bits(self.seed, stream, run);
                    latin_hypercube::within(stratum, self.runs, bits)
                }
                Axis::Sobol(sobol) => random::coordinate(sobol.bits(run)),
            };
        }
    }
}
