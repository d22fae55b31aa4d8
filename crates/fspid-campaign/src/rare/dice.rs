//! Counter-based random numbers, keyed by their place in the search: independent of order and of threads.

use fspid_scenario::dispersion::{SEED_LIMIT, standard_normal};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The highest bit of the number of a stream: campaigns, flights and sensors have theirs below.
const STREAM: u64 = 1 << 63;
/// 2⁻⁵³.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;

/// Where numbers are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Which team, below 128.
    pub(super) team: u64,
    /// On which rung, below 64.
    pub(super) rung: u64,
    /// At which step there, below 2¹⁸.
    pub(super) step: u64,
    /// For whom, below 2³².
    pub(super) member: u64,
}

/// The numbers of a place, one after the other.
pub(super) struct Dice {
    generator: ChaCha8Rng,
}

impl Dice {
    pub(super) fn at(seed: u64, place: Place) -> Self {
        let Place { team, rung, step, member } = place;
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(STREAM | team << 56 | rung << 50 | step << 32 | member);
        Self { generator }
    }

    /// Strictly between 0 and 1.
    pub(super) fn uniform(&mut self) -> f64 {
        ((self.generator.next_u64() >> 12) * 2 + 1) as f64 * UNIT
    }

    pub(super) fn normal(&mut self) -> f64 {
        standard_normal::quantile(self.uniform())
    }

    /// A seed as scenarios take it.
    pub(super) fn seed(&mut self) -> u64 {
        self.generator.next_u64() % SEED_LIMIT
    }

    /// The numbers below `count` in an order of its own.
    pub(super) fn shuffled(&mut self, count: usize) -> Vec<usize> {
        let mut keyed: Vec<(u64, usize)> =
            (0..count).map(|number| (self.generator.next_u64(), number)).collect();
        keyed.sort_unstable();
        keyed.into_iter().map(|(_, number)| number).collect()
    }
}
