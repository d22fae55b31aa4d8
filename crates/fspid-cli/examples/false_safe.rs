//! A hundred thousand loops that are bad by construction, shown to everybody who judges:
//! `cargo run --release -p fspid-cli --example false_safe -- 100000 SEED`.

#![allow(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/false_safe/mod.rs"]
mod false_safe;

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().ok());
    let count = arguments.next().flatten().unwrap_or(1000);
    let seed = arguments.next().flatten().unwrap_or(1);
    let found = false_safe::battery(seed, count);
    println!(
        "{} loops, seed {seed}, {:?}: {} verdicts, {} undecided, {} called good, {} not answered",
        found.loops,
        found.families,
        found.verdicts,
        found.undecided,
        found.called_good.len(),
        found.refused.len()
    );
    for told in found.called_good.iter().chain(&found.refused) {
        println!("{told}");
    }
    match found.called_good.is_empty() && found.refused.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}
