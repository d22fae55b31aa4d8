//! How fast one core answers with general systems: evaluations per second, all outputs in each.
//!
//! `cargo bench -p fspid-fuzzy --features alloc` prints the best of many short rounds (others may use
//! the machine), with a checksum that holds the compiler to doing the work.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{Conclusion, SetReading};
use fspid_fuzzy::system::{Defuzzifier, Membership, OutputTerm, Parts, Sampling, System};
use fspid_fuzzy::{OutOfRange, RuleTable, Supervisor};

const ROUNDS: usize = 200;
const RANGE: f64 = 5.0;

fn main() {
    let paper = paper();
    report("partition, exact centroid", 4_000, &paper);
    report("outline, exact centroid", 2_000, &spare(&paper));
    report("outline, exact bisector", 2_000, &method(&paper, Defuzzifier::Bisector));
    report("outline by product", 2_000, &larsen(&paper));
    for sampling in [Sampling::Endpoints(101), Sampling::Vertices(101)] {
        let sampled = method(&paper, |_| Defuzzifier::Centroid(sampling));
        report(&format!("partition, {sampling}"), 400, &sampled);
        report(&format!("general, {sampling}"), 400, &spare(&sampled));
    }
    report("weighted average", 4_000, &weighted(&paper));
}

fn report(name: &str, count: usize, parts: &Parts) {
    let system = System::new(parts.clone()).expect("a system");
    let mut workspace = system.workspace();
    let (mut best, mut checksum) = (f64::INFINITY, 0.0);
    for _ in 0..ROUNDS {
        let (begin, mut sum) = (Instant::now(), 0.0);
        for n in 0..count {
            let inputs = black_box([place(n, 0.618_033_988), place(n, 0.754_877_666)]);
            let answers = system.evaluate(&inputs, &mut workspace).expect("finite");
            sum += answers.iter().filter_map(|answer| answer.value).sum::<f64>();
        }
        best = f64::min(best, begin.elapsed().as_secs_f64());
        checksum = sum;
    }
    println!("{:>9.0} thousand/s  {name}  (checksum {checksum:.6})", count as f64 / best / 1e3);
}

/// Points that fill the range evenly.
fn place(n: usize, step: f64) -> f64 {
    let turns = n as f64 * step;
    RANGE * (2.0 * (turns - libm::floor(turns)) - 1.0)
}

fn paper() -> Parts {
    let printed = fspid_data::RULE_TABLES[0].1;
    let grids: Vec<&str> = printed.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    let rule = fspid_fuzzy::Defuzzifier::Exact;
    Parts::try_from(&Supervisor::new(&table, RANGE, rule, OutOfRange::Clamp).expect("allowed"))
        .expect("rules")
}

fn method(parts: &Parts, method: impl Fn(Sampling) -> Defuzzifier) -> Parts {
    let mut parts = parts.clone();
    parts.outputs.iter_mut().for_each(|o| o.defuzzifier = method(Sampling::Exact));
    parts
}

/// With one more term that nothing concludes, the terms are no partition.
fn spare(parts: &Parts) -> Parts {
    let mut parts = parts.clone();
    for output in &mut parts.outputs {
        let params = vec![-RANGE, 0.0, RANGE];
        let membership = Membership::Shape { kind: ShapeKind::Triangle, params, height: 1.0 };
        let conclusion = Conclusion::Set { membership, lower: None };
        output.terms.push(OutputTerm { name: "spare".to_string(), conclusion });
    }
    parts
}

fn larsen(parts: &Parts) -> Parts {
    let mut parts = parts.clone();
    parts.blocks.iter_mut().for_each(|b| b.implication = TNormKind::AlgebraicProduct.into());
    parts
}

/// Peaks in place of triangles: Takagi–Sugeno of order 0.
fn weighted(parts: &Parts) -> Parts {
    let mut parts = method(parts, |_| Defuzzifier::WeightedAverage(SetReading::default()));
    for (n, term) in parts.outputs.iter_mut().flat_map(|o| o.terms.iter_mut().enumerate()) {
        term.conclusion = Conclusion::Constant(RANGE * (n as f64 / 3.0 - 1.0));
    }
    parts
}
