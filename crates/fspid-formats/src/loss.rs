//! What a format cannot say: refused, or allowed and then measured.

use fspid_fuzzy::system::{Parts, System};

use crate::note::{WriteOptions, Writing};
use fspid_diagnostics::{Note, Problem, Problems};

/// Points at which answers are compared.
const POINTS: u32 = 200;

/// Collects what gets lost while a system is written.
#[derive(Debug, Default)]
pub(crate) struct Loss {
    lossy: bool,
    problems: Vec<Problem>,
    notes: Vec<Note>,
    /// True if answers may change.
    changed: bool,
}

impl Loss {
    /// Nothing lost so far; a system that cannot be built is refused.
    pub(crate) fn new(parts: &Parts, options: WriteOptions) -> Result<Self, Problems> {
        let mut loss = Self { lossy: options.lossy, ..Self::default() };
        if let Err(errors) = System::new(parts.clone()) {
            errors.iter().for_each(|error| loss.cannot("", error.to_string(), ""));
            return Err(Problems::of_text(loss.problems));
        }
        Ok(loss)
    }

    /// `what` has no words in the format, and nothing comes near.
    pub(crate) fn cannot(
        &mut self,
        what: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let found = what.to_owned();
        self.problems.push(Problem { found, ..Problem::whole(message, expected) });
    }

    /// `what` has no words in the format; if losses are allowed, `instead` is written.
    pub(crate) fn lose(&mut self, what: &str, message: &str, instead: &str) {
        if self.lossy {
            self.changed = true;
            self.note(format!("`{what}`: {message}; written: {instead}"));
        } else {
            self.cannot(what, message, format!("a loss to be allowed, then written: {instead}"));
        }
    }

    /// Something that changes no answer.
    pub(crate) fn note(&mut self, message: impl Into<String>) {
        self.notes.push(Note { place: None, message: message.into() });
    }

    /// The text with everything that got lost; if answers may have changed, by how much.
    pub(crate) fn finish(
        mut self,
        text: String,
        original: &Parts,
        written: &Parts,
    ) -> Result<Writing, Problems> {
        if !self.problems.is_empty() {
            return Err(Problems::of_text(self.problems));
        }
        if self.changed {
            self.note(difference(original, written));
        }
        Ok(Writing { text, notes: self.notes })
    }
}

/// How far the answers of two systems are apart, in words.
fn difference(original: &Parts, written: &Parts) -> String {
    let largest = System::new(original.clone())
        .ok()
        .zip(System::new(written.clone()).ok())
        .and_then(|(original, written)| largest_differences(&original, &written));
    let Some(largest) = largest else {
        return "how far the answers change could not be measured".into();
    };
    let outputs = original.outputs.iter().zip(largest);
    let list: Vec<_> =
        outputs.map(|(output, most)| format!("`{}` {most:.1e}", output.name)).collect();
    format!("largest change of an answer found at {POINTS} points: {}", list.join(", "))
}

fn largest_differences(original: &System, written: &System) -> Option<Vec<f64>> {
    let (mut room, mut written_room) = (original.workspace(), written.workspace());
    let mut largest = vec![0.0_f64; original.parts().outputs.len()];
    for number in 1..=POINTS {
        let at = point(original.parts(), number);
        let before = original.evaluate(&at, &mut room).ok()?;
        let after = written.evaluate(&at, &mut written_room).ok()?;
        for ((most, before), after) in largest.iter_mut().zip(before).zip(after) {
            let difference = match (before.value, after.value) {
                (None, None) => 0.0,
                (before, after) => (before? - after?).abs(),
            };
            *most = most.max(difference);
        }
    }
    Some(largest)
}

/// A point of an evenly spread sequence over the inputs' universes, [-1, 1] where there is none.
fn point(parts: &Parts, number: u32) -> Vec<f64> {
    let share = |dimension: usize| (f64::from(number) * irrational(dimension)).fract();
    let ends = parts.inputs.iter().map(|i| i.universe.map_or((-1.0, 1.0), |u| (u.lower, u.upper)));
    ends.enumerate().map(|(i, (lower, upper))| lower + share(i) * (upper - lower)).collect()
}

/// Steps that never meet: Weyl's sequence with square roots.
fn irrational(dimension: usize) -> f64 {
    let not_square = (2_u32..).filter(|n| n.isqrt().pow(2) != *n).nth(dimension).unwrap_or(2);
    f64::from(not_square).sqrt().fract()
}
