//! How many inferences a second one core makes, beside a fixed loop over 101 samples.
//!
//! `cargo bench -p fspid-fuzzy --features batch` prints for each engine the best rate over blocks of
//! inputs, so short that some are not interrupted by whoever else uses the machine, how many times
//! as fast as the fixed loop it is, and a checksum over a million distinct inputs, which holds the
//! compiler to doing the work and shows which engines give the same answers.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

const INPUTS: usize = 1_000_000;
const BLOCK: usize = 10_000;
const ROUNDS: usize = 7;
const RANGE: f64 = 5.0;

fn main() {
    let inputs = Inputs::new();
    let supervisor = supervisor();
    let samples = FixedLoop::new();
    let fixed = report("101 samples, fixed loop", None, &inputs, |sum, error, change| {
        samples.infer_all(sum, error, change)
    });
    report("exact, scalar", Some(fixed), &inputs, |sum, error, change| {
        infer_all(&supervisor, sum, error, change)
    });
}

/// Times `work`, which adds to a checksum, over all inputs, block by block, and prints the best rate.
fn report(
    what: &str,
    reference: Option<f64>,
    inputs: &Inputs,
    mut work: impl FnMut(f64, &[f64], &[f64]) -> f64,
) -> f64 {
    let mut best = 0.0_f64;
    let mut checksums = [0.0; ROUNDS];
    for checksum in &mut checksums {
        let blocks = inputs.error.chunks(BLOCK).zip(inputs.change.chunks(BLOCK));
        for (error, change) in blocks {
            let start = Instant::now();
            *checksum = black_box(work(*checksum, error, change));
            best = best.max(BLOCK as f64 / start.elapsed().as_secs_f64() / 1e6);
        }
    }
    let [checksum, others @ ..] = checksums.map(f64::to_bits);
    assert!(others.iter().all(|&other| other == checksum), "a round gave another answer");
    let times = reference.map_or(String::new(), |fixed| format!("{:.1} times, ", best / fixed));
    let checksum = f64::from_bits(checksum);
    println!("{what:<28} {best:7.2} million/s, {times}checksum {checksum:?}");
    best
}

/// A sum in which each gain's increment has another weight.
fn weighted(kp: f64, ki: f64, kd: f64) -> f64 {
    kp + 3.0 * ki + 7.0 * kd
}

fn infer_all(supervisor: &Supervisor<f64>, mut sum: f64, error: &[f64], change: &[f64]) -> f64 {
    for (&error, &change) in error.iter().zip(change) {
        if let Ok(answer) = black_box(supervisor).infer(error, change) {
            sum += weighted(answer.delta.kp, answer.delta.ki, answer.delta.kd);
        }
    }
    sum
}

struct Inputs {
    error: Vec<f64>,
    change: Vec<f64>,
}

impl Inputs {
    /// Evenly spread over the range: splitmix64 (Steele, Lea and Flood 2014).
    fn new() -> Self {
        let mut state = 42_u64;
        let mut random = || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            let unit = ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0;
            RANGE * (2.0 * unit - 1.0)
        };
        let (error, change) = (0..INPUTS).map(|_| (random(), random())).unzip();
        Self { error, change }
    }
}

fn table() -> RuleTable {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

fn supervisor() -> Supervisor<f64> {
    Supervisor::new(&table(), RANGE, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

/// What stands in most programs in place of the exact centroid: the union of the cut output sets
/// sampled at 101 points, with the output sets' grades there as tables.
struct FixedLoop {
    /// For its grades only, so that both engines have the same input sets.
    supervisor: Supervisor<f64>,
    /// Position of the label of each rule, by output and cell.
    rules: [[usize; 49]; 3],
    /// Grade of each output set at each sample.
    sets: [[f64; SAMPLES]; 7],
    places: [f64; SAMPLES],
}

const SAMPLES: usize = 101;

impl FixedLoop {
    fn new() -> Self {
        use fspid_fuzzy::{Label, Output};
        let table = table();
        let rules = Output::ALL.map(|output| {
            let grid = table.grid(output);
            core::array::from_fn(|cell| grid.at(Label::ALL[cell / 7], Label::ALL[cell % 7]).index())
        });
        let places = core::array::from_fn(|n| n as f64 * (2.0 * RANGE / 100.0) - RANGE);
        let spacing = RANGE / 3.0;
        let sets = core::array::from_fn(|label| {
            let peak = (label as f64 - 3.0) * spacing;
            places.map(|place: f64| (1.0 - (place - peak).abs() / spacing).max(0.0))
        });
        let loops = Self { supervisor: supervisor(), rules, sets, places };
        loops.assert_right();
        loops
    }

    fn assert_right(&self) {
        let rule = Defuzzifier::Endpoints(101);
        let sampled = Supervisor::new(&table(), RANGE, rule, OutOfRange::Clamp).expect("allowed");
        let [kp, _, kd] = self.infer(1.0, -2.0);
        let theirs = sampled.infer(1.0, -2.0).expect("inside").delta;
        assert!((kp - theirs.kp).abs() < 1e-12 && (kd - theirs.kd).abs() < 1e-12);
    }

    fn infer_all(&self, mut sum: f64, error: &[f64], change: &[f64]) -> f64 {
        for (&error, &change) in error.iter().zip(change) {
            let [kp, ki, kd] = black_box(self).infer(error, change);
            sum += weighted(kp, ki, kd);
        }
        sum
    }

    fn infer(&self, error: f64, change: f64) -> [f64; 3] {
        let (error, change) = (self.supervisor.grades(error), self.supervisor.grades(change));
        core::array::from_fn(|output| {
            let mut strengths = [0.0_f64; 7];
            for (cell, &label) in self.rules[output].iter().enumerate() {
                let firing = smaller(error[cell / 7], change[cell % 7]);
                strengths[label] = larger(strengths[label], firing);
            }
            let mut union = [0.0_f64; SAMPLES];
            for (set, strength) in self.sets.iter().zip(strengths) {
                for (grade, &member) in union.iter_mut().zip(set) {
                    *grade = larger(*grade, smaller(member, strength));
                }
            }
            let (mut area, mut moment) = (0.0, 0.0);
            for (grade, place) in union.iter().zip(self.places) {
                area += grade;
                moment += grade * place;
            }
            moment / area
        })
    }
}

/// Unlike `f64::min` without regard to NaN, which would cost several instructions.
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
