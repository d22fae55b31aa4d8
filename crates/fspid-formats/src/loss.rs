//! What a format cannot say: refused, or allowed and then measured.

use fspid_fuzzy::system::{Parts, System};

use crate::difference::{differences, questions};
use crate::note::{WriteOptions, Writing};
use fspid_diagnostics::{Note, Problem, Problems};

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
            self.note(words(original, written));
        }
        Ok(Writing { text, notes: self.notes })
    }
}

/// How far the answers of two systems are apart, in words.
fn words(original: &Parts, written: &Parts) -> String {
    let Some(found) = differences(original, written) else {
        return "how far the answers change could not be measured".into();
    };
    let outputs = original.outputs.iter().zip(found);
    let list = outputs.map(|(output, found)| {
        let unanswered = match found.unanswered {
            0 => String::new(),
            count => format!(" ({count} are answered by only one of the two)"),
        };
        format!("`{}` {:.1e}{unanswered}", output.name, found.largest)
    });
    let list = list.collect::<Vec<_>>().join(", ");
    let points = questions(original);
    format!(
        "largest change of an answer within the ranges of the inputs, found at {points} points and near the worst of them; beyond the ranges it is not measured: {list}"
    )
}
