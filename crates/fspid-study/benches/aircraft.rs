//! How long a minute of nonlinear flight takes on one core: six degrees of freedom at 100 Hz, with
//! turbulence, gusts, sensors and an actuator of second order.
//!
//! `cargo bench -p fspid-study` prints the best of several rounds, since others may use the machine.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use fspid_scenario::file;

const ROUNDS: usize = 20;
const SCENARIO: &str = include_str!("../../../scenarios/gallery/b747-turbulence.toml");

fn main() {
    let set: Vec<String> = ["loop.duration_s=60.0", "loop.sample_period_s=0.01"]
        .into_iter()
        .chain(["actuator.preset=second-order", "sensor.preset=ahrs"])
        .map(str::to_owned)
        .collect();
    let mut study = file::parse(SCENARIO, "bench", None, &set).expect("a shipped scenario");
    study.scenario.controllers.truncate(1);
    let mut best_ms = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let flight = fspid_sim::simulate(black_box(&study.scenario)).expect("it flies");
        best_ms = best_ms.min(1e3 * start.elapsed().as_secs_f64());
        assert_eq!(flight.traces.iter().map(fspid_sim::Trace::rows).sum::<usize>(), 6001);
    }
    println!("a minute of nonlinear flight at 100 Hz: {best_ms:.1} ms (asked: 60)");
}
