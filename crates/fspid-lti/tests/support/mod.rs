//! Reading of the stored tables and comparison of sets of complex numbers.

#![allow(dead_code, reason = "each test file uses its own part")]

use fspid_lti::{Complex, Matrix, modulus};
use proptest::test_runner::{Config, RngSeed};

/// Properties are tried on the same cases in each run; a case that fails belongs into a test of its own.
pub(crate) fn repeatable() -> Config {
    Config { failure_persistence: None, rng_seed: RngSeed::Fixed(2026), ..Config::default() }
}

/// Rows of a table, split into their fields.
pub(crate) fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    table.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(';').collect())
}

pub(crate) fn numbers(field: &str) -> Vec<f64> {
    field.split_whitespace().map(|word| word.parse().expect("the table holds numbers")).collect()
}

pub(crate) fn complex_numbers(field: &str) -> Vec<Complex> {
    let pair = |word: &str| {
        let (re, im) = word.split_once(',').expect("the table holds pairs");
        Complex::new(re.parse().expect("a number"), im.parse().expect("a number"))
    };
    field.split_whitespace().map(pair).collect()
}

pub(crate) fn matrix(rows: usize, entries: &[f64]) -> Matrix {
    let columns = entries.len() / rows;
    let rows: Vec<&[f64]> = entries.chunks(columns).collect();
    Matrix::from_rows(&rows).expect("a test matrix is well formed")
}

/// Largest relative distance between two sets, each element matched with the nearest one left over.
pub(crate) fn worst_relative(found: &[Complex], expected: &[Complex]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let mut rest = found.to_vec();
    let mut worst: f64 = 0.0;
    for &value in expected {
        let distance = |candidate: Complex| modulus(candidate - value);
        let nearest =
            (0..rest.len()).min_by(|&i, &j| distance(rest[i]).total_cmp(&distance(rest[j])));
        let nearest = rest.swap_remove(nearest.expect("the sets are equally large"));
        worst = worst.max(distance(nearest) / modulus(value));
    }
    worst
}

/// Pseudo-random numbers from a fixed start: Steele, Lea and Flood, Fast splittable generators, OOPSLA 2014.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }
}
