//! Random loops with slow modes and their margins, a line each, for `oracles/check_slow_loops.py`, which refutes them.
//!
//! `cargo run --release -p fspid-lti --example slow_loops -- 100000 1 > loops.csv`: so many loops that are stable, and
//! the seed.

#![allow(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/slow.rs"]
mod slow;
#[path = "../tests/support/mod.rs"]
mod support;

use fspid_lti::{LtiError, SampledMargins, Stability};
use slow::Slow;
use support::Random;

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().unwrap_or(1));
    let (count, seed) = (arguments.next().unwrap_or(1000), arguments.next().unwrap_or(1));
    let mut random = Random(seed);
    println!(
        "# numerator;denominator;kp ki kd;filter s;dead samples;period s;Ms;Mt;disk;limits;phase margin;brackets"
    );
    let (mut stable, mut unstable, mut hidden, mut failed) = (0, 0, 0, 0);
    while stable < count {
        let open = Slow::random(&mut random);
        match open.open().and_then(|it| it.margins()) {
            Ok(Stability::Stable(found)) => {
                stable += 1;
                println!("{}", line(&open, &found));
            }
            Ok(Stability::Unstable { .. }) => unstable += 1,
            Err(LtiError::Blurred { .. }) => hidden += 1,
            Err(error) => {
                failed += 1;
                println!("# {error}: {open:?}");
            }
        }
    }
    println!(
        "# {stable} stable, {unstable} unstable, {hidden} hidden by rounding, {failed} without an answer"
    );
}

fn line(open: &Slow, found: &SampledMargins) -> String {
    let words = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let limits = [found.gain_low, found.gain_high];
    let factors =
        [limits[0].map_or(0.0, |it| it.factor), limits[1].map_or(f64::INFINITY, |it| it.factor)];
    let phase = found.phase_margin.map_or(f64::INFINITY, |it| it.phase_margin_rad.abs());
    let proved = [found.proved.sensitivity, found.proved.complementary, found.proved.disk];
    let brackets: Vec<f64> = proved.iter().flat_map(|it| [it.at_least, it.at_most]).collect();
    [
        words(&open.numerator),
        words(&open.denominator),
        words(&open.gains),
        open.filter_s.to_string(),
        open.delay.to_string(),
        open.dt_s.to_string(),
        words(&[found.sensitivity_peak.value, found.sensitivity_peak.omega_rad_s]),
        words(&[found.complementary_peak.value, found.complementary_peak.omega_rad_s]),
        words(&[found.disk.size, found.disk.omega_rad_s]),
        words(&factors),
        words(&[phase, found.phase_margin.map_or(0.0, |it| it.omega_rad_s)]),
        words(&brackets),
    ]
    .join(";")
}
