//! Random numbers that depend on nothing but a seed, a stream and a sample.

use std::cell::RefCell;

use fearless_simd::dispatch;
use fspid_numeric::{InstructionSet, straight};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words that one normal number takes from its stream.
const WORDS: u128 = 4;
/// Numbers that are drawn at once: what the generator makes in one go, 64 words.
const AT_ONCE: usize = 16;
/// How many such blocks a thread keeps, a power of two: 0.6 MB, some flights of 25 s at 100 Hz with all noises.
const KEPT: usize = 4096;

/// Which numbers a block holds.
#[derive(Clone, Copy, PartialEq)]
struct BlockOf {
    seed: u64,
    stream: u64,
    /// Number of the block in its stream.
    block: usize,
}

/// Numbers of one stream that follow each other.
#[derive(Clone, Copy)]
struct Block {
    /// None before anything was drawn.
    of: Option<BlockOf>,
    numbers: [f64; AT_ONCE],
}

thread_local! {
    /// The blocks that were drawn last. They are a pure function of what they are of, so that nothing of it shows
    /// but in time: neighbours are drawn together, and flights of other candidates in the same air draw nothing.
    static BLOCKS: RefCell<Vec<Block>> =
        RefCell::new(vec![Block { of: None, numbers: [0.0; AT_ONCE] }; KEPT]);
}

/// The standard normal number of a sample: counter-based, so that no stream and no sample depends
/// on another, by the transform of Box and Muller (1958).
pub(crate) fn standard_normal(seed: u64, stream: u64, k: usize) -> f64 {
    let of = BlockOf { seed, stream, block: k / AT_ONCE };
    BLOCKS.with_borrow_mut(|blocks| {
        let block = &mut blocks[place(of)];
        if block.of != Some(of) {
            *block = Block { of: Some(of), numbers: drawn(of) };
        }
        block.numbers[k % AT_ONCE]
    })
}

/// Where a block is kept: those of a stream side by side, streams and seeds apart by more than a short flight.
fn place(of: BlockOf) -> usize {
    let BlockOf { seed, stream, block } = of;
    let apart = seed.wrapping_mul(1031).wrapping_add(stream.wrapping_mul(331));
    apart.wrapping_add(block as u64) as usize % KEPT
}

/// The numbers of a block.
fn drawn(of: BlockOf) -> [f64; AT_ONCE] {
    let mut generator = ChaCha8Rng::seed_from_u64(of.seed);
    generator.set_stream(of.stream);
    generator.set_word_pos((of.block * AT_ONCE) as u128 * WORDS);
    let mut bytes = [[[0; 8]; 2]; AT_ONCE];
    generator.fill_bytes(bytes.as_flattened_mut().as_flattened_mut());
    let bits = bytes.map(|pair| pair.map(u64::from_le_bytes));
    let mut numbers = [0.0; AT_ONCE];
    dispatch!(InstructionSet::best().level(), _simd => transform(&bits, &mut numbers));
    numbers
}

/// Normal numbers from random bits, with the bits of `libm`.
#[inline(always)]
fn transform(bits: &[[u64; 2]; AT_ONCE], numbers: &mut [f64; AT_ONCE]) {
    let (mut radius, mut angle_rad) = ([0.0; AT_ONCE], [0.0; AT_ONCE]);
    for ([of_radius, of_angle], (radius, angle_rad)) in
        bits.iter().zip(radius.iter_mut().zip(&mut angle_rad))
    {
        // In (0, 1], so that the logarithm is finite.
        *radius = unit(*of_radius) + UNIT;
        *angle_rad = std::f64::consts::TAU * unit(*of_angle);
    }
    let mut all_straight = true;
    for place in 0..AT_ONCE {
        all_straight &= straight::is_straight_cos_of_turn(angle_rad[place]);
        let length = (-2.0 * straight::ln_of_normal(radius[place])).sqrt();
        numbers[place] = length * straight::cos_of_turn(angle_rad[place]);
    }
    if !all_straight {
        for place in 0..AT_ONCE {
            let length = (-2.0 * libm::log(radius[place])).sqrt();
            numbers[place] = length * libm::cos(angle_rad[place]);
        }
    }
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
    fn numbers_that_are_kept_are_those_of_a_generator_placed_at_their_sample() {
        let alone = |seed: u64, stream: u64, k: usize| {
            let mut generator = ChaCha8Rng::seed_from_u64(seed);
            generator.set_stream(stream);
            generator.set_word_pos(k as u128 * WORDS);
            let radius = unit(generator.next_u64()) + UNIT;
            let angle = unit(generator.next_u64());
            libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(std::f64::consts::TAU * angle)
        };
        // Far more blocks than are kept, in an order that drives each other out, and again.
        for round in 0..2 {
            for k in (0..400).chain((0..90_000).step_by(37)) {
                for (seed, stream) in [(1, 0), (1, 7), (u64::MAX, u64::MAX), (KEPT as u64 + 1, 0)] {
                    let kept = standard_normal(seed, stream, k);
                    assert_eq!(kept.to_bits(), alone(seed, stream, k).to_bits(), "{round} {k}");
                }
            }
        }
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
