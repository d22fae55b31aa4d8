//! A hundred million bad samples through every structure of controller:
//! `cargo run --release -p fspid-options --example hostile_samples -- 100000000 SEED`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::process::ExitCode;

use fspid_options::hostile::{attack, structures};

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().ok());
    let samples = arguments.next().flatten().unwrap_or(1_000_000);
    let seed = arguments.next().flatten().unwrap_or(1);
    let found = attack(seed, samples);
    println!("{} structures, seed {seed}: {found:?}", structures().len());
    if found.is_clean() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
