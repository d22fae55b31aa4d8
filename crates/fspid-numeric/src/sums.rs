//! Weighted sums of long vectors, with the widest instructions of the machine.
//!
//! Every number of a sum is added up in the order of its terms, and magnitudes in eight sums side by side: the same bits
//! whatever the instructions.

#[cfg(feature = "simd")]
use fearless_simd::dispatch;

#[cfg(feature = "simd")]
use crate::InstructionSet;

/// Magnitudes that are summed side by side: one sum would wait for each of its terms.
const LANES: usize = 8;
/// Numbers of a sum that are made together, term after term, so that none is written before it is whole.
const BLOCK: usize = 4 * LANES;

/// $\sum_i a_i v_i$, of vectors that are 0 beyond their ends, and its [`magnitudes`]; numbers beyond the sum's end are left
/// away.
pub fn combine(terms: &[(f64, &[f64])], sum: &mut [f64]) -> f64 {
    #[cfg(feature = "simd")]
    return dispatch!(InstructionSet::best().level(), _simd => combined(terms, sum));
    #[cfg(not(feature = "simd"))]
    combined(terms, sum)
}

/// $\sum_j |v_j|$.
#[must_use]
pub fn magnitudes(values: &[f64]) -> f64 {
    #[cfg(feature = "simd")]
    return dispatch!(InstructionSet::best().level(), _simd => magnitudes_with([0.0; LANES], values));
    #[cfg(not(feature = "simd"))]
    magnitudes_with([0.0; LANES], values)
}

#[inline(always)]
fn combined(terms: &[(f64, &[f64])], sum: &mut [f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (blocks, rest) = sum.as_chunks_mut::<BLOCK>();
    let whole = blocks.len() * BLOCK;
    for (place, block) in blocks.iter_mut().enumerate() {
        *block = combined_block(terms, place * BLOCK);
        add_magnitudes(&mut lanes, block);
    }
    if !rest.is_empty() {
        rest.copy_from_slice(&combined_block(terms, whole)[..rest.len()]);
    }
    magnitudes_with(lanes, rest)
}

/// Held in registers until it is whole: nothing of it is asked for by its place.
#[inline(always)]
fn combined_block(terms: &[(f64, &[f64])], from: usize) -> [f64; BLOCK] {
    let mut sum = [0.0; BLOCK];
    for (factor, term) in terms {
        let term = term.get(from..).unwrap_or_default();
        if let Some(values) = term.first_chunk::<BLOCK>() {
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += factor * value;
            }
        } else {
            // Apart from the sum, which would be written for it: how many there are is not known to the compiler.
            let mut products = [0.0; BLOCK];
            for (product, value) in products.iter_mut().zip(term) {
                *product = factor * value;
            }
            for (sum, product) in sum.iter_mut().zip(&products) {
                *sum += product;
            }
        }
    }
    sum
}

#[inline(always)]
fn add_magnitudes(lanes: &mut [f64; LANES], values: &[f64]) {
    for chunk in values.as_chunks::<LANES>().0 {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value.abs();
        }
    }
}

/// Those of values after such that are in the lanes.
#[inline(always)]
fn magnitudes_with(mut lanes: [f64; LANES], values: &[f64]) -> f64 {
    add_magnitudes(&mut lanes, values);
    let rest = values.as_chunks::<LANES>().1;
    lanes.iter().sum::<f64>() + rest.iter().map(|value| value.abs()).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    fn drawn(length: usize, seed: u64) -> Vec<f64> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5
        };
        (0..length).map(|_| next()).collect()
    }

    /// One number after the other, term after term.
    fn plain(terms: &[(f64, &[f64])], length: usize) -> Vec<f64> {
        let of = |place: usize| {
            let values = terms.iter().filter_map(|(factor, term)| Some(factor * term.get(place)?));
            values.fold(0.0, |sum, value| sum + value)
        };
        (0..length).map(of).collect()
    }

    #[test]
    fn a_weighted_sum_has_the_bits_of_one_number_after_the_other_whatever_the_lengths() {
        for length in [0_usize, 1, 7, 8, 31, 32, 33, 64, 100, 1281] {
            for lengths in
                [[length; 3], [length, length / 2, length + 5], [0, length.saturating_sub(1), 3]]
            {
                let vectors = lengths.map(|own| drawn(own, 3 * own as u64 + length as u64));
                let factors = [0.3, -1.7, 1e-3];
                let terms: Vec<(f64, &[f64])> =
                    factors.into_iter().zip(vectors.iter().map(Vec::as_slice)).collect();
                let mut sum = std::vec![f64::NAN; length];
                let size = combine(&terms, &mut sum);
                assert_eq!(size.to_bits(), magnitudes(&sum).to_bits(), "{lengths:?}");
                assert_eq!(sum, plain(&terms, length), "{lengths:?}");
            }
        }
    }

    #[test]
    fn a_sum_of_nothing_is_zero() {
        let mut sum = [1.0; 40];
        assert_eq!(combine(&[], &mut sum), 0.0);
        assert_eq!(sum, [0.0; 40]);
        assert_eq!(magnitudes(&[]), 0.0);
    }

    #[test]
    fn magnitudes_are_added_up_in_eight_sums_and_what_is_left_after_them() {
        for length in [1, 8, 9, 16, 23, 400] {
            let values = drawn(length, length as u64);
            let mut lanes = [0.0; LANES];
            let whole = length / LANES * LANES;
            for (place, value) in values[..whole].iter().enumerate() {
                lanes[place % LANES] += value.abs();
            }
            let rest: f64 = values[whole..].iter().map(|value| value.abs()).sum();
            let sum = lanes.iter().sum::<f64>() + rest;
            assert_eq!(magnitudes(&values).to_bits(), sum.to_bits(), "{length}");
        }
    }

    #[test]
    fn what_is_not_a_number_is_in_the_sum() {
        let mut sum = [0.0; 9];
        let mut term = [1.0; 9];
        term[8] = f64::NAN;
        let size = combine(&[(2.0, &term), (f64::INFINITY, &[1.0])], &mut sum);
        assert_eq!(sum[..8], [f64::INFINITY, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0]);
        assert!(sum[8].is_nan() && size.is_nan() && magnitudes(&term).is_nan());
    }
}
