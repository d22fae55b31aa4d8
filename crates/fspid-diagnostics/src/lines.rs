//! Answers for a terminal, line by line.

use std::fmt::{Arguments, Write as _};

/// Adds a line: `line(&mut out, format_args!(…))`.
pub fn line(out: &mut String, text: Arguments<'_>) {
    add(out, text);
    out.push('\n');
}

/// Adds to the last line.
pub fn add(out: &mut String, text: Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = out.write_fmt(text);
}

/// A text in lines of at most so many characters, the first of which begins with `mark`, the others as far right. A word that
/// is longer has a line of its own.
#[must_use]
pub fn wrapped(text: &str, mark: &str, width: usize) -> Vec<String> {
    let room = width.saturating_sub(mark.chars().count());
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        if let Some(line) = lines.last_mut() {
            if line.is_empty() || line.chars().count() + 1 + word.chars().count() <= room {
                let between = if line.is_empty() { "" } else { " " };
                line.push_str(between);
                line.push_str(word);
            } else {
                lines.push(word.to_owned());
            }
        }
    }
    let other = " ".repeat(mark.chars().count());
    let marked = |(index, line): (usize, String)| {
        let mark = if index == 0 { mark } else { &other };
        format!("{mark}{line}")
    };
    lines.into_iter().enumerate().map(marked).collect()
}

/// Furthest right that what a line is about stands, characters.
const LABEL: usize = 24;

/// A text whose longer lines go on below where they begin, or below what follows the label that they begin with.
#[must_use]
pub fn folded(text: &str, width: usize) -> String {
    let mut out = String::new();
    for line in text.lines() {
        if line.chars().count() <= width {
            out.push_str(line);
            out.push('\n');
            continue;
        }
        let (mark, rest) = line.split_at(begin(line));
        for line in wrapped(rest, mark, width) {
            out.push_str(&line);
            out.push('\n');
        }
    }
    out
}

/// Where the words of a line begin after its label, which two spaces or more part from them.
fn begin(line: &str) -> usize {
    let indent = line.len() - line.trim_start().len();
    let words = &line[indent..];
    let parted = words.find("  ").map(|gap| {
        let after = &words[gap..];
        indent + gap + (after.len() - after.trim_start().len())
    });
    parted.filter(|begin| *begin <= LABEL).unwrap_or(indent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_below_their_first_word_or_that_after_their_label() {
        let text = "short\n  decay      one two three four\n  PROVED: one two three four five\n";
        let folded = folded(text, 24);
        let expected = "short\n  decay      one two\n             three four\n  PROVED: one two three\n  four five\n";
        assert_eq!(folded, expected);
        assert!(folded.lines().all(|line| line.len() <= 24), "{folded}");
    }
}
