//! How long the full case takes on one core: a step of 20 s at 100 Hz flown, measured, and its loop analysed at rest
//! and at every frozen gain of a map of 9 by 9.
//!
//! `cargo bench -p fspid-study --bench analysis` prints the best and the median of many rounds, since others may use
//! the machine.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use fspid_scenario::file;
use fspid_sim::simulate;
use fspid_study::analysis::{Analysis, Question};
use fspid_study::metrics::FlightMetrics;
use fspid_study::simulation::Simulation;

const ROUNDS: usize = 400;
const SCENARIO: &str = include_str!("../../../scenarios/747-pitch-step.toml");
/// The whole is asked to take no longer, ms.
const ASKED_MS: f64 = 2.0;

fn main() {
    let mut study = file::parse(SCENARIO, "bench", None, &[]).expect("a shipped scenario");
    study.scenario.controllers.retain(|named| named.name == "FSPID");
    let study = black_box(study);
    let flown = simulate(&study.scenario).expect("it flies");
    assert_eq!(flown.traces.iter().map(fspid_sim::Trace::rows).sum::<usize>(), 2001);
    let analysed = |map_points| {
        let question = Question { map_points, ..Question::default() };
        Analysis::of(&study, question).expect("a loop")
    };
    report("the flight", || simulate(&study.scenario).expect("it flies"));
    report("its metrics", || {
        let timing = study.scenario.timing;
        FlightMetrics::of(&flown.traces[0], &flown.edges, timing, None, &[])
    });
    let at_rest = report("margins and disk at rest", || analysed(0));
    let mapped = report("the same with the map", || analysed(9));
    println!("the map alone: {:.3} ms at the median", mapped - at_rest);
    let all = report("all of it", || (Simulation::of(&study).expect("it flies"), analysed(9)));
    println!("asked: {ASKED_MS} ms, median here: {all:.3} ms");
}

/// Prints the best and the median of many rounds, and returns the median, ms.
fn report<T>(what: &str, work: impl Fn() -> T) -> f64 {
    let round = |_| {
        let start = Instant::now();
        black_box(work());
        1e3 * start.elapsed().as_secs_f64()
    };
    let mut times_ms: Vec<f64> = (0..ROUNDS).map(round).collect();
    times_ms.sort_by(f64::total_cmp);
    let median = times_ms[ROUNDS / 2];
    println!("{what}: {median:.3} ms at the median, {:.3} ms at best", times_ms[0]);
    median
}
