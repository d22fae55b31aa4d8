//! A permutation of the runs that is computed for one run at a time, and places within strata.

use super::key::Key;

/// Rounds of the permutation. Over all keys the strata of two runs are a random walk on ordered pairs
/// whose second eigenvalue is $\lambda = (1 + 1/N) / 2$ (computed by `oracles/make_sampling.py` for
/// N from 4 to 32), so that after r rounds they are within $\frac N2 \lambda^r$ of independent in
/// total variation: 2·10⁻¹⁰ at 2³² runs, less at fewer. The variance of a Latin hypercube's means rests
/// on such pairs.
const ROUNDS: usize = 64;

/// A permutation of `0..runs`, by swap or not.
///
/// In each round a number x below N has the partner $(K_r - x) \bmod N$, whose partner is x; a bit
/// of the round and of the larger one of the two decides whether they change places. Unlike a
/// Feistel network this needs no walk through numbers beyond N, so each run takes the same time.
///
/// # Source
/// V. T. Hoang, B. Morris and P. Rogaway, "An enciphering scheme based on a card shuffle",
/// CRYPTO 2012.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Permutation {
    runs: u64,
    key: Key,
    /// The numbers $K_r$, uniform below N.
    turns: [u64; ROUNDS],
}

impl Permutation {
    /// The permutation of so many runs that a key names.
    pub(super) fn new(runs: u64, key: Key) -> Self {
        // The integer part of a fraction times N; its shares differ by 2⁻³² at most.
        let below = |hash: u64| ((u128::from(hash) * u128::from(runs)) >> 64) as u64;
        Self { runs, key, turns: std::array::from_fn(|round| below(key.hash(tag(round)))) }
    }

    /// The stratum of a run.
    pub(super) fn stratum(&self, run: u64) -> u64 {
        (0..).zip(&self.turns).fold(run, |here, (round, &turn)| {
            let partner = if turn >= here { turn - here } else { turn + self.runs - here };
            let swaps = self.key.hash(tag(round) | (1 + here.max(partner))) >> 63 == 1;
            if swaps { partner } else { here }
        })
    }
}

/// Number of a round among those that are hashed; its lowest 40 bits are 0 and free for runs.
const fn tag(round: usize) -> u64 {
    (round as u64) << 40
}

/// A place in a stratum, given by random bits: strictly inside the stratum even after rounding.
pub(super) fn within(stratum: u64, runs: u64, bits: u64) -> f64 {
    // Stratum and jitter together take at most 51 binary digits, so that their sum is exact and its
    // distance from a border, relative to the sum, is at least 2⁻⁵¹. The division and a
    // multiplication by the number of runs lose 2⁻⁵³ each and cannot reach the border.
    let digits = 50 - (64 - (runs - 1).leading_zeros());
    let jitter = ((bits >> (64 - digits)) * 2 + 1) as f64 / (1_u64 << (digits + 1)) as f64;
    (stratum as f64 + jitter) / runs as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small ones, primes, powers of two and their neighbours, round numbers.
    const SIZES: [u64; 16] = [1, 2, 3, 4, 5, 7, 16, 17, 31, 32, 33, 100, 101, 1000, 4096, 10_007];

    #[test]
    fn every_stratum_has_exactly_one_run_whatever_their_number() {
        for runs in SIZES {
            for seed in 0..3 {
                let permutation = Permutation::new(runs, Key::new(seed, 0));
                let mut strata: Vec<u64> = (0..runs).map(|run| permutation.stratum(run)).collect();
                strata.sort_unstable();
                assert!(strata.into_iter().eq(0..runs), "{runs} runs");
            }
        }
    }

    #[test]
    fn all_permutations_of_a_few_runs_are_equally_frequent() {
        // Chi-square with 23 degrees of freedom; 49.7 is exceeded with probability 0.001.
        let mut counts = std::collections::BTreeMap::new();
        let keys = 24_000;
        for seed in 0..keys {
            let permutation = Permutation::new(4, Key::new(seed, 0));
            let strata: Vec<u64> = (0..4).map(|run| permutation.stratum(run)).collect();
            *counts.entry(strata).or_insert(0_u32) += 1;
        }
        assert_eq!(counts.len(), 24);
        let expected = keys as f64 / 24.0;
        let chi_square: f64 = counts
            .values()
            .map(|&n| (f64::from(n) - expected) * (f64::from(n) - expected) / expected)
            .sum();
        assert!(chi_square < 49.7, "{chi_square}");
    }

    #[test]
    fn places_are_strictly_inside_their_strata_for_extreme_bits() {
        for runs in SIZES.into_iter().chain([999_983, 1_000_000, (1 << 32) - 5, 1 << 32]) {
            for stratum in [0, 1, runs / 2, runs - 1].into_iter().filter(|&s| s < runs) {
                for bits in [0, u64::MAX] {
                    let u = within(stratum, runs, bits);
                    assert!(0.0 < u && u < 1.0);
                    assert_eq!((u * runs as f64).floor(), stratum as f64, "{runs}: {u:e}");
                    assert!(u > stratum as f64 / runs as f64);
                }
            }
        }
    }
}
