//! What a reader has to say, collected while it goes on reading.

use crate::note::{Note, Place, Problem, Problems};

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
        let (word, expected) = (String::new(), String::new());
        self.push(Problem { place: None, word, message: message.into(), expected });
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
            let (word, expected) = (String::new(), String::new());
            let message = "and more problems".into();
            self.problems.push(Problem { place: None, word, message, expected });
        }
        if !self.problems.is_empty() {
            return Err(Problems(self.problems));
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
    let (place, word) = (Some(place), clipped(word));
    Problem { place, word, message: message.into(), expected: expected.into() }
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

/// Known words as a sentence lists them, with the nearest one asked for first:
/// ``one of `min`, `prod`; did you mean `min`?``
pub(crate) fn one_of<'k>(known: impl Iterator<Item = &'k str> + Clone, found: &str) -> String {
    let list = known.clone().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
    match nearest(known, found) {
        Some(word) => format!("one of {list}; did you mean `{word}`?"),
        None => format!("one of {list}"),
    }
}

/// The known word that takes fewest single-character changes, if they are few.
pub(crate) fn nearest<'k>(known: impl Iterator<Item = &'k str>, found: &str) -> Option<&'k str> {
    if found.len() > LONGEST_WORD {
        return None;
    }
    let found = found.to_lowercase();
    let most = (found.chars().count() / 3).max(1);
    known
        .map(|word| (distance(&word.to_lowercase(), &found), word))
        .filter(|(changes, _)| *changes <= most)
        .min_by_key(|(changes, _)| *changes)
        .map(|(_, word)| word)
}

/// Single characters that must be changed, put in, left out or swapped with their neighbour.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut rows: Vec<Vec<usize>> = vec![(0..=to.len()).collect()];
    let mut before = None;
    for left in from.chars() {
        let row = next_row(&rows, &to, left, before);
        rows.push(row);
        before = Some(left);
    }
    rows.last().and_then(|row| row.last()).copied().unwrap_or_default()
}

/// One more row of the table of distances: from the words up to `left` to each beginning of `to`.
fn next_row(rows: &[Vec<usize>], to: &[char], left: char, before: Option<char>) -> Vec<usize> {
    let cell = |up: usize, column: usize| {
        let row = rows.len().checked_sub(up).and_then(|row| rows.get(row));
        row.and_then(|row| row.get(column)).copied().unwrap_or(usize::MAX - 1)
    };
    let mut row = vec![rows.len()];
    let mut behind = None;
    for (column, &right) in to.iter().enumerate() {
        let changed = cell(1, column) + usize::from(left != right);
        let left_out = cell(1, column + 1) + 1;
        let put_in = row.last().map_or(usize::MAX, |count| count + 1);
        let swaps = column > 0 && before == Some(right) && behind == Some(left);
        let swapped = if swaps { cell(2, column - 1) + 1 } else { usize::MAX };
        row.push(changed.min(left_out).min(put_in).min(swapped));
        behind = Some(right);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Place = Place { line: 1, column: 1 };

    #[test]
    fn distances_count_changes() {
        for (from, to, changes) in [
            ("", "", 0),
            ("", "ab", 2),
            ("kitten", "sitting", 3),
            ("min", "mni", 1),
            ("abcd", "badc", 2),
        ] {
            assert_eq!(distance(from, to), changes, "{from} {to}");
        }
    }

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
        let problems = report.finish().unwrap_err().0;
        assert_eq!(problems.len(), 51);
        assert_eq!(problems.last().unwrap().to_string(), "and more problems");
    }

    #[test]
    fn long_and_invisible_words_are_shown_short_and_harmless() {
        assert_eq!(clipped("a\0b"), "a\u{fffd}b");
        assert_eq!(clipped(&"x".repeat(1000)).chars().count(), LONGEST_WORD + 1);
    }
}
