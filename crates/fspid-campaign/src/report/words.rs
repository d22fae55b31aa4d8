//! Numbers, probabilities and names in words.

pub(super) use fspid_page::columns::cut;
use fspid_page::number::{short, significant};

use crate::summary::Probability;
pub(super) use crate::summary::words::{percent, whole as count};

/// A share of the variance in per cent.
pub(super) fn share(part: f64) -> String {
    significant(100.0 * part, 3)
}

/// A number with four digits.
pub(super) fn number(value: f64) -> String {
    short(value, 4)
}

/// A number with its unit, if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    let number = number(value);
    if unit.is_empty() { number } else { format!("{number} {}", cut(unit, 30)) }
}

/// How probable something is, with how sure that is: "6.7 % (5.8 % to 7.7 %)", "at most 0.10 % (95 %)".
pub(super) fn probability(found: &Probability, confidence: f64) -> String {
    let words = found.in_words(confidence);
    words.split_once(": ").map_or("not judged", |(_, sure)| sure).to_owned()
}

/// What is shown with its unit in brackets, for axes.
pub(super) fn axis_label(label: &str, unit: &str) -> String {
    if unit.is_empty() { label.to_owned() } else { format!("{label} [{}]", cut(unit, 30)) }
}

/// A text with a capital at its beginning.
pub(super) fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// Words as a list: "one, two and three".
pub(super) fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_failures_are_a_bound_and_not_a_probability_of_nought() {
        let words = |count, of| {
            let found = Probability {
                count,
                of,
                estimate: (of > 0).then(|| count as f64 / of as f64),
                lower: 0.0,
                upper: 0.002,
                at_most: (count == 0 && of > 0).then_some(0.001),
                at_least: None,
            };
            probability(&found, 0.95)
        };
        assert_eq!(words(0, 3000), "at most 0.10 % (95 %)");
        assert_eq!(words(0, 0), "not judged");
    }
}
