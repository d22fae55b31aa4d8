//! Random numbers that depend on a seed, a generation and a member, and on nothing else.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words set aside for one member of a generation.
const WORDS: u128 = 1 << 16;

/// The random numbers of one member in one generation.
pub(super) struct Random(ChaCha8Rng);

impl Random {
    pub(super) fn of(seed: u64, generation: u64, member: usize) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(generation);
        generator.set_word_pos(member as u128 * WORDS);
        Self(generator)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// In 0..`count`; 0 for a count of 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "less than count"
        )]
        let index = (self.unit() * count as f64) as usize;
        index
    }

    /// Normally distributed, mean 0, standard deviation 1.
    pub(super) fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit()));
        radius * libm::cos(std::f64::consts::TAU * self.unit())
    }

    /// Cauchy distributed, location 0, scale 1.
    pub(super) fn cauchy(&mut self) -> f64 {
        libm::tan(std::f64::consts::PI * (self.unit() - 0.5))
    }
}
