//! Random numbers that depend on nothing but a seed, a stream and a sample.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words that one normal number takes from its stream.
const WORDS: u128 = 4;

/// The standard normal number of a sample: counter-based, so that no stream and no sample depends
/// on another, by the transform of Box and Muller (1958).
pub(crate) fn standard_normal(seed: u64, stream: u64, k: usize) -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    generator.set_word_pos(k as u128 * WORDS);
    // In (0, 1], so that the logarithm is finite.
    let radius = unit(generator.next_u64()) + UNIT;
    let angle = unit(generator.next_u64());
    libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(std::f64::consts::TAU * angle)
}

/// 2^-53.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;

/// 53 random bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_moments_of_the_normal_distribution() {
        let n = 100_000;
        let values: Vec<f64> = (0..n).map(|k| standard_normal(7, 0, k)).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / n as f64;
        let fourth = values.iter().map(|v| v * v * v * v).sum::<f64>() / n as f64;
        // Four standard errors: 1/sqrt(n), sqrt(2/n), sqrt(96/n).
        assert!(mean.abs() < 0.0127, "{mean}");
        assert!((variance - 1.0).abs() < 0.0179, "{variance}");
        assert!((fourth - 3.0).abs() < 0.124, "{fourth}");
    }

    #[test]
    fn a_sample_of_noise_depends_on_seed_stream_and_sample_only() {
        let a = standard_normal(1, 2, 3);
        assert_eq!(a.to_bits(), standard_normal(1, 2, 3).to_bits());
        for other in [standard_normal(2, 2, 3), standard_normal(1, 3, 3), standard_normal(1, 2, 4)]
        {
            assert_ne!(a.to_bits(), other.to_bits());
        }
    }
}
