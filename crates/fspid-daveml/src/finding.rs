//! Problems and notes while they are collected: by byte, and turned into lines and columns at the end.

use fspid_diagnostics::{LineStarts, Note, Problem, Problems};

/// Most problems and most notes that are kept.
const MAX_FINDINGS: usize = 100;

/// Byte of a text at which something was written; documents do not differ by it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Origin(pub(crate) Option<usize>);

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A problem or note, with its place still a byte.
#[derive(Debug)]
struct Finding<T> {
    at: Origin,
    what: T,
}

/// What was found so far.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    problems: Vec<Finding<Problem>>,
    notes: Vec<Finding<Note>>,
}

impl Findings {
    /// Keeps a problem.
    pub(crate) fn problem(
        &mut self,
        at: Origin,
        word: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let what = Problem { found: shortened(word), ..Problem::whole(message, expected) };
        keep(&mut self.problems, Finding { at, what });
    }

    /// Keeps a note.
    pub(crate) fn note(&mut self, at: Origin, message: impl Into<String>) {
        let what = Note { place: None, message: message.into() };
        keep(&mut self.notes, Finding { at, what });
    }

    /// True as long as there is no problem.
    pub(crate) fn good(&self) -> bool {
        self.problems.is_empty()
    }

    /// The notes, or the problems if there are any, with their places in the text.
    pub(crate) fn finish(mut self, text: &str) -> Result<Vec<Note>, Problems> {
        let lines = LineStarts::of(text);
        let place = |at: Origin| at.0.map(|byte| lines.place(text, byte));
        self.problems.sort_by_key(|finding| finding.at.0);
        self.notes.sort_by_key(|finding| finding.at.0);
        if self.problems.is_empty() {
            let placed = |found: Finding<Note>| Note { place: place(found.at), ..found.what };
            Ok(self.notes.into_iter().map(placed).collect())
        } else {
            let placed = |found: Finding<Problem>| Problem { place: place(found.at), ..found.what };
            Err(Problems::of_text(self.problems.into_iter().map(placed).collect()))
        }
    }
}

fn keep<T>(list: &mut Vec<Finding<T>>, finding: Finding<T>) {
    if list.len() < MAX_FINDINGS {
        list.push(finding);
    }
}

/// A word short enough for a sentence.
fn shortened(word: &str) -> String {
    match word.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", word.get(..end).unwrap_or_default()),
        None => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_come_in_the_order_of_their_places_and_at_most_a_hundred() {
        let mut findings = Findings::default();
        for byte in (0..200).rev() {
            findings.problem(Origin(Some(byte)), "x", "wrong", "");
        }
        let problems = findings.finish(&" ".repeat(300)).expect_err("there are problems").list;
        assert_eq!(problems.len(), MAX_FINDINGS);
        assert!(problems.is_sorted_by_key(|problem| problem.place));
    }

    #[test]
    fn a_long_word_is_shortened() {
        assert_eq!(shortened(&"é".repeat(100)).chars().count(), 61);
    }
}
