//! What the format cannot say: refused, or written otherwise with a note.

use fspid_diagnostics::{Note, Problem, Problems};

/// Collects what is lost on the way.
#[derive(Debug)]
pub(super) struct Losses {
    lossy: bool,
    problems: Vec<Problem>,
    notes: Vec<Note>,
    /// True once something has been written that answers otherwise.
    pub(super) any: bool,
}

impl Losses {
    pub(super) fn new(lossy: bool) -> Self {
        Self { lossy, problems: Vec::new(), notes: Vec::new(), any: false }
    }

    /// Something that may be written otherwise if losses are allowed.
    pub(super) fn lost(&mut self, message: impl Into<String>) {
        if self.lossy {
            self.any = true;
            self.note(message);
        } else {
            self.problem(message, "that a loss is allowed");
        }
    }

    /// Something that cannot be written, whatever is allowed.
    pub(super) fn never(&mut self, message: impl Into<String>) {
        self.problem(message, "");
    }

    fn problem(&mut self, message: impl Into<String>, expected: &str) {
        self.problems.push(Problem::whole(message, expected));
    }

    /// Something that changes no answer.
    pub(super) fn note(&mut self, message: impl Into<String>) {
        self.notes.push(Note { place: None, message: message.into() });
    }

    /// The notes.
    ///
    /// # Errors
    /// The problems, if there are any.
    pub(super) fn finish(self) -> Result<Vec<Note>, Problems> {
        if self.problems.is_empty() {
            Ok(self.notes)
        } else {
            Err(Problems::of_text(self.problems))
        }
    }

    /// True if nothing stands in the way of writing.
    pub(super) fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }
}
