//! Runs the check cases of DAVE-ML files: `cargo run --release -p fspid-daveml --example check -- FILE.dml …`
#![allow(clippy::print_stdout, reason = "an example that is run by hand")]

use std::process::ExitCode;

fn main() -> ExitCode {
    let reports: Vec<_> = std::env::args().skip(1).map(|path| report(&path)).collect();
    for report in &reports {
        match report {
            Ok(text) | Err(text) => println!("{text}"),
        }
    }
    if reports.iter().all(Result::is_ok) { ExitCode::SUCCESS } else { ExitCode::from(2) }
}

fn report(path: &str) -> Result<String, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let reading = fspid_daveml::read(&text).map_err(|problems| format!("{path}:\n{problems}"))?;
    let notes: String = reading.notes.iter().map(|note| format!("\n  {note}")).collect();
    let (model, check) = (&reading.model, reading.model.check());
    let size = format!("{} inputs, {} outputs", model.inputs().count(), model.outputs().count());
    let answer = format!("{path}: {} ({size})\n  {check}{notes}", reading.document.header.name);
    if check.passed() { Ok(answer) } else { Err(answer) }
}
