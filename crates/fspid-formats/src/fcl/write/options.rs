//! `OPTION`, in the standard's dialect.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{FallbackValue, Input, Output, Parts, Sampling};

use super::statement::{range, statement};
use crate::fcl::option::{ADDS, OUT_OF_RANGE};
use crate::number::written as number;
use crate::repeated;

/// What the standard has no words for.
pub(super) fn written(parts: &Parts) -> String {
    let inputs = parts.inputs.iter().map(input_options);
    let adds = |output| repeated::adds_up(parts, output);
    let outputs =
        parts.outputs.iter().enumerate().map(|(index, output)| output_options(output, adds(index)));
    let lines: String = inputs.chain(outputs).collect();
    if lines.is_empty() { lines } else { format!("\nOPTION\n{lines}END_OPTION\n") }
}

fn input_options(input: &Input) -> String {
    let mut text = String::new();
    let name = &input.name;
    if input.universe.is_some() {
        text += &statement(&format!("FSPID_RANGE {name} := "), &range(input.universe));
    }
    if input.out_of_range != OutOfRange::Evaluate {
        let word = OUT_OF_RANGE.iter().find(|row| row.1 == input.out_of_range);
        text += &statement(&format!("FSPID_OUT_OF_RANGE {name} : "), word.map_or("", |row| row.0));
    }
    text + &disabled(name, input.enabled)
}

fn disabled(name: &str, enabled: bool) -> String {
    if enabled { String::new() } else { statement(&format!("FSPID_ENABLED {name} : "), "FALSE") }
}

fn output_options(output: &Output, adds: bool) -> String {
    let mut text = String::new();
    let name = &output.name;
    if let Some(sampling) = output.defuzzifier.sampling().filter(|s| *s != Sampling::Exact) {
        let words = sampling.to_string().to_uppercase().replace('-', "_").replace(':', " ");
        text += &statement(&format!("FSPID_SAMPLING {name} : "), &words);
    }
    if output.clamp {
        text += &statement(&format!("FSPID_LIMIT {name} : "), "RANGE");
    }
    if adds {
        text += &statement(&format!("{ADDS} {name} : "), "ADDED");
    }
    let begin = format!("FSPID_DEFAULT {name} : ");
    match output.fallback.value {
        FallbackValue::Middle => text += &statement(&begin, "MIDDLE"),
        FallbackValue::Number(value) if output.fallback.previous => {
            text += &statement(&begin, &number(value));
        }
        _ => {}
    }
    text + &disabled(name, output.enabled)
}
