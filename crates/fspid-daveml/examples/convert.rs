//! Writes a DAVE-ML file as TOML: `cargo run -p fspid-daveml --example convert -- FILE.dml > FILE.toml`
#![allow(clippy::print_stdout, reason = "an example that is run by hand")]

use fspid_daveml::{data, read};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("which file?")?;
    let reading = read(&std::fs::read_to_string(path)?)?;
    let text = data::write(&reading.document);
    let again = data::read(&text)?;
    assert_eq!(again.model, reading.model, "what is written is what was read");
    print!("{text}");
    Ok(())
}
