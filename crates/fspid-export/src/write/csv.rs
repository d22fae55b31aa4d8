//! Vectors as a table for people and other tools.

use std::ops::Range;

use fspid_numeric::Real;

use super::put;
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
    text.reserve(vectors.len() * WIDTH * header.len());
    text.push('\n');
    let mut columns = vec![Above::default(); header.len()];
    let mut all_given = Above::default();
    for vector in vectors {
        let reals = vector.sample.iter().take(inputs).chain(&vector.answer);
        for (value, above) in reals.zip(&mut columns) {
            above.again(&mut text, value.to_f64(), is_single);
            text.push(',');
        }
        put::list(&mut text, ",", &vector.marks, |text, mark| put::byte(text, *mark));
        if has_events {
            text.push(',');
            text.push_str(vector.event.name());
            text.push(',');
            all_given.again(&mut text, vector.event.given().to_f64(), is_single);
        }
        text.push('\n');
    }
    text
}

/// About how wide a cell is at most.
const WIDTH: usize = 12;

/// The number that a column holds in the line above, and where it stands. Two in five stay as they are, and to copy one
/// takes less than to find its digits.
#[derive(Clone, Debug, Default)]
struct Above {
    bits: u64,
    place: Range<usize>,
}

impl Above {
    /// Writes the column's next number.
    fn again(&mut self, text: &mut String, value: f64, is_single: bool) {
        let start = text.len();
        if self.bits == value.to_bits() && !self.place.is_empty() {
            text.extend_from_within(self.place.clone());
        } else {
            any(text, value, is_single);
        }
        *self = Self { bits: value.to_bits(), place: start..text.len() };
    }
}

fn any(text: &mut String, value: f64, is_single: bool) {
    match value {
        value if value.is_nan() => text.push_str("nan"),
        value if value.is_infinite() => text.push_str(if value < 0.0 { "-inf" } else { "inf" }),
        value => put::decimal(text, value, is_single),
    }
}
