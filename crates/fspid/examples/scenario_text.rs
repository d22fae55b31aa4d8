//! A scenario file flown, measured and asked for its margins: `cargo run --release -p fspid --example scenario_text -- FILE`.

#![allow(clippy::print_stdout, reason = "an example shows something")]

use std::path::Path;

use fspid::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).unwrap_or("scenarios/747-pitch-step.toml".to_owned());
    let study = load(Path::new(&file), &[])?;
    let simulation = Simulation::of(&study)?;
    for result in &simulation.results {
        println!("{}: {}", result.name, result.metrics.verdict);
    }
    for one in Analysis::of(&study, Question::default())?.loops {
        match one.margins() {
            Ok(margins) => println!("{}: disk margin {:.3}", one.name, margins.disk_margin),
            Err(reason) => println!("{}: no margins: {reason}", one.name),
        }
    }
    Ok(())
}
