//! Vectors as a table for people and other tools.

use fspid_numeric::Real;

use super::decimal;
use crate::program::{Part, Precision, Program};
use crate::vectors::{Event, Vector};

/// One line a sample, numbers with the digits that read back as the same bits.
#[must_use]
pub fn csv<R: Real>(program: &Program, vectors: &[Vector<R>]) -> String {
    let is_single = program.precision == Precision::Single;
    let names = |part| program.members(part).iter().map(|member| member.name.as_str());
    let inputs = names(Part::Sample).count();
    let has_events = vectors.iter().any(|vector| vector.event != Event::Step);
    let mut header: Vec<&str> = names(Part::Sample).chain(names(Part::Answer)).collect();
    if has_events {
        header.extend(["event", "given"]);
    }
    let mut text = header.join(",");
    text.push('\n');
    for vector in vectors {
        let reals = vector.sample.iter().take(inputs).chain(&vector.answer);
        let reals = reals.map(|value| any(value.to_f64(), is_single));
        let mut cells: Vec<String> = reals.chain(vector.marks.iter().map(u8::to_string)).collect();
        if has_events {
            cells.push(vector.event.name().to_owned());
            cells.push(any(vector.event.given().to_f64(), is_single));
        }
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

fn any(value: f64, is_single: bool) -> String {
    match value {
        value if value.is_nan() => "nan".to_owned(),
        value if value.is_infinite() => if value < 0.0 { "-inf" } else { "inf" }.to_owned(),
        value => decimal(value, is_single),
    }
}
