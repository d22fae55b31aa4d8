//! A question: its verb, the scenario's text, and what the verb takes beside it.

use fspid_diagnostics::Problems;
use fspid_scenario::file::{self, Study};
use serde_json::{Value, json};

use crate::Answer;

/// What a scenario without a file is called in messages.
pub(crate) const NAME: &str = "scenario.toml";

/// A question, read.
pub(crate) struct Question {
    asked: Value,
}

impl Question {
    pub(crate) fn read(text: &str) -> Result<Self, Answer> {
        let asked = serde_json::from_str(text).map_err(Answer::refused)?;
        Ok(Self { asked })
    }

    /// A text that may be left out, and is empty then.
    pub(crate) fn optional(&self, key: &str) -> &str {
        self.asked.get(key).and_then(Value::as_str).unwrap_or_default()
    }

    pub(crate) fn text(&self, key: &str) -> Result<&str, Answer> {
        let found = self.asked.get(key).and_then(Value::as_str);
        found.ok_or_else(|| Answer::refused(format_args!("`{key}` is missing; it is a text")))
    }

    pub(crate) fn number(&self, key: &str) -> Result<f64, Answer> {
        let found = self.asked.get(key).and_then(Value::as_f64);
        found.ok_or_else(|| Answer::refused(format_args!("`{key}` is missing; it is a number")))
    }

    /// A count that is 0 if it is left out.
    pub(crate) fn count(&self, key: &str) -> usize {
        let found = self.asked.get(key).and_then(Value::as_u64).unwrap_or(0);
        usize::try_from(found).unwrap_or(usize::MAX)
    }

    /// Texts; none if they are left out.
    pub(crate) fn texts(&self, key: &str) -> Vec<String> {
        let found = self.asked.get(key).and_then(Value::as_array).into_iter().flatten();
        found.filter_map(|text| text.as_str().map(str::to_owned)).collect()
    }

    /// Numbers, NaN where there is none, as JSON has it; no numbers if they are left out.
    pub(crate) fn numbers(&self, key: &str) -> Vec<f64> {
        let found = self.asked.get(key).and_then(Value::as_array).into_iter().flatten();
        found.map(|number| number.as_f64().unwrap_or(f64::NAN)).collect()
    }

    /// The study of the scenario's text; a text without a folder can name no file.
    pub(crate) fn study(&self) -> Result<Study, Answer> {
        file::parse(self.text("text")?, NAME, None, &[]).map_err(|found| wrong(&found))
    }
}

/// Everything that is wrong with a text, each with its place.
pub(crate) fn wrong(found: &Problems) -> Answer {
    let one = |problem: &fspid_diagnostics::Problem| {
        json!({
            "line": problem.place.map(|place| place.line), "column": problem.place.map(|place| place.column),
            "origin": problem.origin, "path": problem.path, "found": problem.found,
            "message": problem.message, "allowed": problem.allowed,
        })
    };
    let list: Vec<Value> = found.list.iter().map(one).collect();
    Answer::of(json!({ "problems": list, "omitted": found.omitted }))
}
