//! Independent numbers from a counter.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words that one number takes from its stream.
const WORDS: u128 = 2;

/// 2⁻⁵³.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;

/// The 64 bits number `k` of a stream, by ChaCha8.
pub(super) fn bits(seed: u64, stream: u64, k: u64) -> u64 {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    generator.set_word_pos(u128::from(k) * WORDS);
    generator.next_u64()
}

/// The middle of the interval of width 2⁻⁵² that the first 52 bits name: never 0, never 1, exact.
pub(super) fn coordinate(bits: u64) -> f64 {
    ((bits >> 12) * 2 + 1) as f64 * UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_exact_and_inside_the_open_interval_at_both_ends() {
        assert_eq!(coordinate(0), UNIT);
        assert_eq!(coordinate(u64::MAX), 1.0 - UNIT);
        assert_eq!(coordinate(1 << 63), 0.5 + UNIT);
    }
}
