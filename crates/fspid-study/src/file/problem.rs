//! What is wrong with a file: every problem with its place, what was found and what is allowed.

use std::fmt;

use serde_json::{Value, json};

/// Most problems that are kept; a file with more has the same mistake many times over.
const MOST: usize = 100;

/// One thing that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where it was written if not in the file itself: another file, or `--set path=value`.
    pub origin: Option<String>,
    /// Path of the value, such as `controller[1].supervisor.range`; empty for the file as a whole.
    pub path: String,
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What was found, as written; empty where nothing was.
    pub found: String,
    /// What would be right; empty where the message says it.
    pub allowed: String,
}

/// Everything that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems {
    /// Name of the file.
    pub file: String,
    /// The problems, in the order of the file; never empty.
    pub list: Vec<Problem>,
    /// How many more there are than the list holds.
    pub omitted: usize,
}

impl Problems {
    /// As many of the problems as anybody would read.
    pub(crate) fn new(file: &str, mut list: Vec<Problem>, omitted: usize) -> Self {
        let omitted = omitted + list.len().saturating_sub(MOST);
        list.truncate(MOST);
        let file = file.to_owned();
        Self { file, list, omitted }
    }

    /// The first problem in one line, without its place.
    #[must_use]
    pub fn first_in_a_line(&self) -> String {
        let Some(first) = self.list.first() else {
            return String::new();
        };
        let allowed = match first.allowed.as_str() {
            "" => String::new(),
            allowed => format!("; allowed: {allowed}"),
        };
        format!("{}: {}{allowed}", first.path, first.message)
    }

    /// The problems as JSON: `{"file": …, "problems": [{"path": …, "line": …, …}]}`.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let problem = |p: &Problem| {
            json!({
                "origin": p.origin, "path": p.path, "line": p.line, "column": p.column,
                "message": p.message, "found": p.found, "allowed": p.allowed,
            })
        };
        let problems: Vec<Value> = self.list.iter().map(problem).collect();
        json!({ "file": self.file, "problems": problems, "omitted": self.omitted })
    }

    fn write(&self, f: &mut fmt::Formatter<'_>, problem: &Problem) -> fmt::Result {
        let Problem { line, column, .. } = problem;
        match &problem.origin {
            Some(origin) if origin.starts_with("--set") => write!(f, "{origin}: ")?,
            Some(file) => write!(f, "{file}:{line}:{column}: ")?,
            None => write!(f, "{}:{line}:{column}: ", self.file)?,
        }
        if !problem.path.is_empty() {
            write!(f, "{}: ", problem.path)?;
        }
        f.write_str(&problem.message)?;
        let details = [("found", &problem.found), ("allowed", &problem.allowed)];
        let mut separator = "\n    ";
        for (word, text) in details.iter().filter(|(_, text)| !text.is_empty()) {
            write!(f, "{separator}{word}: {text}")?;
            separator = "; ";
        }
        f.write_str("\n")
    }
}

impl fmt::Display for Problems {
    /// A block for each problem and a last line with their number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for problem in &self.list {
            self.write(f, problem)?;
        }
        match self.list.len() + self.omitted {
            1 => write!(f, "1 problem in {}", self.file)?,
            count => write!(f, "{count} problems in {}", self.file)?,
        }
        if self.omitted > 0 {
            write!(f, ", the first {} of them above", self.list.len())?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

/// Shortest name whose mistyped form is recognised without its unit.
const LEAST_BARE: usize = 6;

/// What follows "there is no `word`": the word that was probably meant, and those that are known.
#[must_use]
pub fn known_words(word: &str, known: &[&str]) -> String {
    let all = known.join(", ");
    match nearest(word, known) {
        Some(meant) => format!("; did you mean `{meant}`? Known are {all}"),
        None => format!("; known are {all}"),
    }
}

/// The known word that was probably meant.
pub(crate) fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > 64 {
        return None;
    }
    let likeness = |candidate: &str| {
        let (a, b) = (word.to_lowercase(), candidate.to_lowercase());
        let whole = strsim::jaro_winkler(&a, &b);
        let typing = strsim::osa_distance(&a, &b) <= 1 + b.len() / 5;
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
    let scored = known.iter().map(|candidate| (likeness(candidate), *candidate));
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
