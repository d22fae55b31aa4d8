//! What is wrong with a file: every problem with its place, what was found and what is allowed.

use std::fmt;

use serde_json::{Value, json};

use crate::place::Place;

/// Most problems that are kept; a file with more has the same mistake many times over.
const MOST: usize = 100;

/// What is wrong, and what is allowed (empty where nothing is said): errors of other crates say both in one sentence, the
/// second behind "; allowed is" or "; allowed are".
#[must_use]
pub fn in_two(sentence: &str) -> (&str, &str) {
    let joints = ["; allowed is ", "; allowed are "];
    joints.iter().find_map(|joint| sentence.split_once(joint)).unwrap_or((sentence, ""))
}

/// One thing that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where it was written if not in the file itself: another file, or `--set path=value`.
    pub origin: Option<String>,
    /// Path of the value, such as `controller[1].supervisor.range`; empty for the file as a whole.
    pub path: String,
    /// Where in the text; `None` where the whole is meant.
    pub place: Option<Place>,
    /// What is wrong.
    pub message: String,
    /// What was found, as written; empty where nothing was.
    pub found: String,
    /// What would be right; empty where the message says it.
    pub allowed: String,
}

impl Problem {
    /// Something wrong at a place of the text itself, and what would be right there.
    pub fn at(
        place: Place,
        found: &str,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        Self { place: Some(place), found: found.to_owned(), ..Self::whole(message, allowed) }
    }

    /// Something wrong with the text as a whole.
    pub fn whole(message: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self {
            origin: None,
            path: String::new(),
            place: None,
            message: message.into(),
            found: String::new(),
            allowed: allowed.into(),
        }
    }

    /// Its line and column; the beginning of the text where the whole is meant.
    #[must_use]
    pub fn line_and_column(&self) -> (usize, usize) {
        self.place.map_or((1, 1), |place| (place.line, place.column))
    }
}

impl fmt::Display for Problem {
    /// One line, without the name of the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        if !self.found.is_empty() {
            write!(f, "`{}`: ", self.found)?;
        }
        f.write_str(&self.message)?;
        if !self.allowed.is_empty() {
            write!(f, "; expected {}", self.allowed)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problem {}

/// Everything that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems {
    /// Name of the file; empty where a text is read that has none.
    pub file: String,
    /// The problems, in the order of the file; never empty.
    pub list: Vec<Problem>,
    /// How many more there are than the list holds.
    pub omitted: usize,
}

impl Problems {
    /// As many of the problems as anybody would read.
    #[must_use]
    pub fn new(file: &str, mut list: Vec<Problem>, omitted: usize) -> Self {
        let omitted = omitted + list.len().saturating_sub(MOST);
        list.truncate(MOST);
        let file = file.to_owned();
        Self { file, list, omitted }
    }

    /// The problems of a text without a name.
    #[must_use]
    pub fn of_text(list: Vec<Problem>) -> Self {
        Self::new("", list, 0)
    }

    /// The same problems, of a file with this name.
    #[must_use]
    pub fn in_file(self, name: &str) -> Self {
        Self { file: name.to_owned(), ..self }
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
            let (line, column) = p.line_and_column();
            json!({
                "origin": p.origin, "path": p.path, "line": line, "column": column,
                "message": p.message, "found": p.found, "allowed": p.allowed,
            })
        };
        let problems: Vec<Value> = self.list.iter().map(problem).collect();
        json!({ "file": self.file, "problems": problems, "omitted": self.omitted })
    }

    fn write_block(&self, f: &mut fmt::Formatter<'_>, problem: &Problem) -> fmt::Result {
        let (line, column) = problem.line_and_column();
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
    /// A block for each problem and a last line with their number; a line for each where the text has no name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.file.is_empty() {
            let lines: Vec<String> = self.list.iter().map(Problem::to_string).collect();
            return f.write_str(&lines.join("\n"));
        }
        for problem in &self.list {
            self.write_block(f, problem)?;
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

#[cfg(test)]
mod tests {
    use super::in_two;

    #[test]
    fn a_sentence_is_split_where_it_says_what_is_allowed() {
        assert_eq!(in_two("kp is NaN; allowed is a number"), ("kp is NaN", "a number"));
        assert_eq!(in_two("3 rows; allowed are 7, one each"), ("3 rows", "7, one each"));
        assert_eq!(in_two("it has no end; none is needed"), ("it has no end; none is needed", ""));
    }
}
