//! What a reader has to say, collected while it goes on reading.

use fspid_diagnostics::{Note, Place, Problem, Problems, nearest};

/// Most problems, and most notes, that are told one by one.
const MOST: usize = 50;
/// Longest part of a word that is repeated, characters.
const LONGEST_WORD: usize = 40;

/// Problems and notes of a text.
#[derive(Debug, Default)]
pub(crate) struct Report {
    problems: Vec<Problem>,
    notes: Vec<Note>,
    /// Whether more problems have been met than are told.
    full: bool,
    more_notes: usize,
}

impl Report {
    /// A word at a place is wrong. `expected` may be empty.
    pub(crate) fn problem(
        &mut self,
        place: Place,
        word: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        self.push(wrong(place, word, message, expected));
    }

    /// The value, or nothing after noting down why there is none.
    pub(crate) fn keep<T>(&mut self, result: Result<T, Problem>) -> Option<T> {
        result.map_err(|problem| self.push(problem)).ok()
    }

    /// The text as a whole is wrong.
    pub(crate) fn whole(&mut self, message: impl Into<String>) {
        self.push(Problem::whole(message, ""));
    }

    /// Adds a problem.
    pub(crate) fn push(&mut self, problem: Problem) {
        if self.problems.len() < MOST {
            self.problems.push(problem);
        } else {
            self.full = true;
        }
    }

    /// True once there is no use in looking for further problems.
    pub(crate) fn is_full(&self) -> bool {
        self.full
    }

    /// True as long as notes are told one by one.
    pub(crate) fn takes_notes(&self) -> bool {
        self.notes.len() < MOST
    }

    /// Something worth knowing about a place.
    pub(crate) fn note(&mut self, place: Place, message: impl Into<String>) {
        if self.notes.len() < MOST {
            self.notes.push(Note { place: Some(place), message: message.into() });
        } else {
            self.more_notes += 1;
        }
    }

    /// Something worth knowing about the whole; told before everything with a place.
    pub(crate) fn note_whole(&mut self, message: impl Into<String>) {
        self.notes.push(Note { place: None, message: message.into() });
    }

    /// True if nothing is wrong so far.
    pub(crate) fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }

    /// The notes in the order of their places.
    ///
    /// # Errors
    /// The problems, if there are any, in the order of their places.
    pub(crate) fn finish(mut self) -> Result<Vec<Note>, Problems> {
        self.problems.sort_by_key(|problem| problem.place);
        if self.full {
            self.problems.push(Problem::whole("and more problems", ""));
        }
        if !self.problems.is_empty() {
            return Err(Problems::of_text(self.problems));
        }
        self.notes.sort_by_key(|note| note.place);
        if self.more_notes > 0 {
            let message = format!("and {} more notes", self.more_notes);
            self.notes.push(Note { place: None, message });
        }
        Ok(self.notes)
    }
}

/// A problem with a word at a place.
pub(crate) fn wrong(
    place: Place,
    word: &str,
    message: impl Into<String>,
    expected: impl Into<String>,
) -> Problem {
    Problem::at(place, &clipped(word), message, expected)
}

/// The beginning of a word, with control characters shown as escapes.
pub(crate) fn clipped(word: &str) -> String {
    let mut shown: String = word.chars().take(LONGEST_WORD).map(visible).collect();
    if word.chars().nth(LONGEST_WORD).is_some() {
        shown.push('…');
    }
    shown
}

fn visible(character: char) -> char {
    if character.is_control() { '\u{fffd}' } else { character }
}

/// Known words as a sentence lists them, with the one that was probably meant asked for:
/// ``one of `min`, `prod`; did you mean `min`?``
pub(crate) fn one_of<'k>(known: impl Iterator<Item = &'k str>, found: &str) -> String {
    let known: Vec<&str> = known.collect();
    let list = known.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
    match nearest(found, &known) {
        Some(word) => format!("one of {list}; did you mean `{word}`?"),
        None => format!("one of {list}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Place = Place { line: 1, column: 1 };

    #[test]
    fn a_near_word_is_asked_for_and_a_far_one_is_not() {
        let known = ["min", "prod"].into_iter();
        assert_eq!(one_of(known.clone(), "Prd"), "one of `min`, `prod`; did you mean `prod`?");
        assert_eq!(one_of(known, "zebra"), "one of `min`, `prod`");
    }

    #[test]
    fn beyond_fifty_it_is_only_told_that_there_are_more() {
        let mut report = Report::default();
        (0..60).for_each(|_| report.problem(HERE, "x", "is wrong", ""));
        let problems = report.finish().unwrap_err().list;
        assert_eq!(problems.len(), 51);
        assert_eq!(problems.last().unwrap().to_string(), "and more problems");
    }

    #[test]
    fn long_and_invisible_words_are_shown_short_and_harmless() {
        assert_eq!(clipped("a\0b"), "a\u{fffd}b");
        assert_eq!(clipped(&"x".repeat(1000)).chars().count(), LONGEST_WORD + 1);
    }
}
