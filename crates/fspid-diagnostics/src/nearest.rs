//! Words that are unknown, and those that were probably meant.

/// Shortest name whose mistyped form is recognised without its unit.
const LEAST_BARE: usize = 6;

/// What follows "there is no `word`": the word that was probably meant, and those that are known.
#[must_use]
pub fn known_words(word: &str, known: &[&str]) -> String {
    let all = listed(known);
    match nearest(word, known) {
        Some(meant) => format!("; did you mean `{meant}`? Known are {all}"),
        None => format!("; known are {all}"),
    }
}

/// Names in a row; those that a reader would part or join otherwise stand in marks.
#[must_use]
pub fn listed<N: AsRef<str>>(names: &[N]) -> String {
    let marked = |name: &str| {
        if name.contains([',', ' ']) { format!("`{name}`") } else { name.to_owned() }
    };
    names.iter().map(|name| marked(name.as_ref())).collect::<Vec<_>>().join(", ")
}

/// The known word that was probably meant.
#[must_use]
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > 64 {
        return None;
    }
    let likeness = |candidate: &str| {
        let (a, b) = (word.to_lowercase(), candidate.to_lowercase());
        let whole = strsim::jaro_winkler(&a, &b);
        let changes = strsim::osa_distance(&a, &b);
        // A word of which no letter is left is another word.
        let is_another = changes >= a.chars().count().max(b.chars().count());
        let typing = changes <= 1 + b.len() / 5 && !is_another;
        // The beginning is meant as the whole: `duration` for `duration_s`, `b747` for `b747-paper`.
        let beginning = b.strip_prefix(a.as_str()).is_some_and(|rest| rest.starts_with(['_', '-']));
        // A measure without its unit, mistyped: `overshot` for `overshoot_pct`.
        let bare = b.rsplit_once('_').map_or("", |(bare, _)| bare);
        let without_unit = bare.len() >= LEAST_BARE && strsim::osa_distance(&a, bare) <= 1;
        if beginning {
            2.0
        } else if typing || without_unit {
            1.0 + whole
        } else {
            whole
        }
    };
    // The first of several that are as near: the last is what `max_by` keeps.
    let scored = known.iter().rev().map(|candidate| (likeness(candidate), *candidate));
    scored
        .filter(|(score, _)| *score >= 1.0)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistyped_word_is_recognised_and_a_foreign_one_is_not() {
        let known = ["sample_period_s", "duration_s", "kp", "kd"];
        assert_eq!(nearest("sample_perod_s", &known), Some("sample_period_s"));
        assert_eq!(nearest("duration", &known), Some("duration_s"));
        assert_eq!(nearest("Kp", &known), Some("kp"));
        assert_eq!(nearest("colour", &known), None);
        assert_eq!(nearest(";", &["x", "y"]), None);
        assert_eq!(nearest("COK", &["COG", "COA"]), Some("COG"));
        assert_eq!(nearest("overshot", &["overshoot_pct", "peak_deg"]), Some("overshoot_pct"));
    }

    /// What used to follow the question mark began in small letters: "did you mean food? known are …".
    #[test]
    fn a_new_sentence_begins_with_a_capital_letter() {
        let known = ["service", "food"];
        assert_eq!(known_words("fod", &known), "; did you mean `food`? Known are service, food");
        assert_eq!(known_words("colour", &known), "; known are service, food");
    }
}
