//! Asks an exported function block for the answers to vectors: `ask fspid.st vectors.csv` prints how many differ.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

use std::process::ExitCode;

use fspid_structured_text::{Instance, Kind, Library, Value};

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut files = std::env::args().skip(1);
    let (Some(block), Some(vectors)) = (files.next(), files.next()) else {
        return Err("usage: ask BLOCK.st VECTORS.csv".into());
    };
    let library = Library::read(&std::fs::read_to_string(block)?)?;
    let name = library.names().next().ok_or("no function block")?.to_owned();
    let mut block = library.instance(&name)?;
    let vectors = std::fs::read_to_string(vectors)?;
    let mut lines = vectors.lines().map(|line| line.split(',').collect::<Vec<&str>>());
    let columns = lines.next().ok_or("no vectors")?;
    let (mut samples, mut different) = (0, 0);
    for values in lines {
        samples += 1;
        different += usize::from(!is_same(&mut block, &columns, &values)?);
    }
    println!("{samples} samples, {different} different");
    Ok(ExitCode::from(u8::from(different > 0)))
}

/// Gives the inputs among the columns, calls the block, and compares the others.
fn is_same(
    block: &mut Instance<'_>,
    columns: &[&str],
    values: &[&str],
) -> Result<bool, Box<dyn std::error::Error>> {
    let mut outputs = Vec::new();
    for (column, value) in columns.iter().zip(values) {
        // Inputs and outputs of a fuzzy system say which they are.
        let names = [(*column).to_owned(), format!("in_{column}"), format!("out_{column}")];
        let known = names.iter().find_map(|name| Some((name, block.kind(name).ok()?)));
        let (name, kind) = known.ok_or_else(|| format!("no variable {column}"))?;
        let value = read(kind, value).ok_or_else(|| format!("{value} is no {kind}"))?;
        if block.set(name, value).is_err() {
            outputs.push((name.clone(), value));
        }
    }
    block.call()?;
    let mut is_same = true;
    for (name, value) in outputs {
        is_same &= bits(block.get(&name)?) == bits(value);
    }
    Ok(is_same)
}

fn read(kind: Kind, text: &str) -> Option<Value> {
    match kind {
        Kind::Real => text.parse().ok().map(Value::Real),
        Kind::Lreal => text.parse().ok().map(Value::Lreal),
        Kind::Dint => text.parse().ok().map(Value::Dint),
        Kind::Usint => text.parse().ok().map(Value::Usint),
        Kind::Byte => text.parse().ok().map(Value::Byte),
        Kind::Bool => Some(Value::Bool(text == "1")),
    }
}

/// With the sign of a zero.
fn bits(value: Value) -> (Kind, u64) {
    let bits = match value {
        Value::Real(value) => u64::from(value.to_bits()),
        Value::Lreal(value) => value.to_bits(),
        Value::Dint(value) => u64::from(value.cast_unsigned()),
        Value::Usint(value) | Value::Byte(value) => u64::from(value),
        Value::Bool(value) => u64::from(value),
    };
    (value.kind(), bits)
}
