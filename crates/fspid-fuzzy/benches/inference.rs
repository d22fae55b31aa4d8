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
use std::ops::Range;
use std::time::Instant;

use fspid_fuzzy::{Defuzzifier, Increments, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_numeric::Real;

const INPUTS: usize = 1_000_000;
const BLOCK: usize = 10_000;
const ROUNDS: usize = 7;
const RANGE: f64 = 5.0;

fn main() {
    let inputs = Inputs::<f64>::new();
    let samples = FixedLoop::new();
    let fixed = report("101 samples, fixed loop", None, |block, answers| {
        for (place, (error, change)) in inputs.pairs(block).enumerate() {
            answers.put(place, black_box(&samples).infer(error, change));
        }
    });
    let supervisor = supervisor(Defuzzifier::Exact);
    report("exact, one by one", Some(fixed), |block, answers| {
        for (place, (error, change)) in inputs.pairs(block).enumerate() {
            if let Ok(answer) = black_box(&supervisor).infer(error, change) {
                let Increments { kp, ki, kd } = answer.delta;
                answers.put(place, [kp, ki, kd]);
            }
        }
    });
    let numbers = numbers();
    report("numbers, one by one", Some(fixed), |block, answers| {
        for (place, (error, change)) in inputs.pairs(block).enumerate() {
            if let Ok(answer) = black_box(&numbers).infer(error, change) {
                let Increments { kp, ki, kd } = answer.delta;
                answers.put(place, [kp, ki, kd]);
            }
        }
    });
    #[cfg(feature = "batch")]
    report("numbers, batch", Some(fixed), |block, answers| {
        let (error, change) = (&inputs.error[block.clone()], &inputs.change[block]);
        let answered = numbers.infer_many(error, change, answers.as_batch());
        assert!(answered.is_ok(), "inputs within the range");
    });
    #[cfg(feature = "batch")]
    {
        report_batches("f64", fixed, &inputs);
        report_batches("f32", fixed, &Inputs::<f32>::new());
    }
    #[cfg(not(feature = "batch"))]
    println!("batches are not built; add --features batch");
}

/// Rules that conclude numbers, a plane that is bent.
fn numbers() -> Supervisor<f64> {
    let grid = std::array::from_fn(|i| {
        std::array::from_fn(|j| RANGE * ((i as f64 - 3.0) * (j as f64 + 1.0)) / 21.0)
    });
    let table = NumberTable::new([grid; 3]).expect("finite");
    Supervisor::of_numbers(&table, RANGE, OutOfRange::Clamp).expect("within the range")
}

/// Batches by each instruction set of this machine.
#[cfg(feature = "batch")]
fn report_batches<R: Real>(precision: &str, fixed: f64, inputs: &Inputs<R>) {
    let supervisor = supervisor(Defuzzifier::Exact);
    for set in fspid_numeric::InstructionSet::available() {
        report(&format!("exact, batch of {precision}, {set}"), Some(fixed), |block, answers| {
            let (error, change) = (&inputs.error[block.clone()], &inputs.change[block]);
            let answered = supervisor.infer_many_by(set, error, change, answers.as_batch());
            assert!(answered.is_ok(), "inputs within the range");
        });
    }
}

/// Times `work` over all inputs, block by block, and prints the best rate in millions per second.
fn report<R: Real>(
    what: &str,
    reference: Option<f64>,
    mut work: impl FnMut(Range<usize>, &mut Places<R>),
) -> f64 {
    let mut places = Places::new();
    let mut best = 0.0_f64;
    let mut checksums = [0.0; ROUNDS];
    for checksum in &mut checksums {
        for begin in (0..INPUTS).step_by(BLOCK) {
            let start = Instant::now();
            work(begin..begin + BLOCK, black_box(&mut places));
            best = best.max(BLOCK as f64 / start.elapsed().as_secs_f64() / 1e6);
            *checksum = places.added_to(*checksum);
        }
    }
    let [checksum, others @ ..] = checksums.map(f64::to_bits);
    assert!(others.iter().all(|&other| other == checksum), "a round gave another answer");
    let times = reference.map_or(String::new(), |fixed| format!("{:.1} times, ", best / fixed));
    let checksum = f64::from_bits(checksum);
    println!("{what:<31} {best:7.2} million/s, {times}checksum {checksum:?}");
    best
}

/// Answers of a block.
struct Places<R> {
    kp: [R; BLOCK],
    ki: [R; BLOCK],
    kd: [R; BLOCK],
    #[cfg(feature = "batch")]
    flags: [[bool; BLOCK]; 2],
}

impl<R: Real> Places<R> {
    fn new() -> Self {
        let none = [R::ZERO; BLOCK];
        Self {
            kp: none,
            ki: none,
            kd: none,
            #[cfg(feature = "batch")]
            flags: [[false; BLOCK]; 2],
        }
    }

    fn put(&mut self, place: usize, [kp, ki, kd]: [R; 3]) {
        (self.kp[place], self.ki[place], self.kd[place]) = (kp, ki, kd);
    }

    #[cfg(feature = "batch")]
    fn as_batch(&mut self) -> fspid_fuzzy::Answers<'_, R> {
        let [clamped, underflowed] = &mut self.flags;
        let Self { kp, ki, kd, .. } = self;
        fspid_fuzzy::Answers { kp, ki, kd, clamped, underflowed }
    }

    /// A sum in which the increment of each gain has another weight.
    fn added_to(&self, mut sum: f64) -> f64 {
        for ((kp, ki), kd) in self.kp.iter().zip(&self.ki).zip(&self.kd) {
            sum += kp.to_f64() + 3.0 * ki.to_f64() + 7.0 * kd.to_f64();
        }
        sum
    }
}

struct Inputs<R> {
    error: Vec<R>,
    change: Vec<R>,
}

impl<R: Real> Inputs<R> {
    /// Evenly spread over the range: splitmix64 (Steele, Lea and Flood 2014).
    fn new() -> Self {
        let mut state = 42_u64;
        let mut random = || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            let unit = ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0;
            R::from_f64(RANGE * (2.0 * unit - 1.0))
        };
        let (error, change) = (0..INPUTS).map(|_| (random(), random())).unzip();
        Self { error, change }
    }

    fn pairs(&self, block: Range<usize>) -> impl Iterator<Item = (R, R)> {
        let pairs = self.error[block.clone()].iter().zip(&self.change[block]);
        pairs.map(|(&error, &change)| (error, change))
    }
}

fn table() -> RuleTable {
    let file = fspid_data::RULE_TABLES[0].1;
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

fn supervisor<R: Real>(rule: Defuzzifier) -> Supervisor<R> {
    Supervisor::new(&table(), R::from_f64(RANGE), rule, OutOfRange::Clamp).expect("allowed")
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
        let loops = Self { supervisor: supervisor(Defuzzifier::Exact), rules, sets, places };
        loops.assert_right();
        loops
    }

    fn assert_right(&self) {
        let sampled = supervisor(Defuzzifier::Endpoints(101));
        let [kp, _, kd] = self.infer(1.0, -2.0);
        let theirs = sampled.infer(1.0, -2.0).expect("inside").delta;
        assert!((kp - theirs.kp).abs() < 1e-12 && (kd - theirs.kd).abs() < 1e-12);
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
