//! In which interval around its present value a number of a scenario keeps the requirements met.
//!
//! The scenario is judged anew at values around the present one: outwards on a grid until a value fails on each side, then
//! inwards between the last value that holds and that one. **What lies between the values that were looked at was not
//! looked at**: the answer counts them, and nothing here is a proof.
//!
//! - *Grid*: distances from the present value that grow by $\sqrt 2$ from 1/16 to 8 times its size (1 if it is 0), rounded
//!   to six digits, whole numbers to whole ones, so that every value that is told is one that was flown.
//! - *Ends*: halved until they are within [`TOLERANCE`] of that size; whole numbers to neighbours.
//! - *What has to hold*: every requirement, those of ready sets that are asked for among them, and no flight that fails by itself, as [`verify`](super::verify()) has it.
//!   Where nothing is required: the loop is stable at rest, and every step settles. Where stability at rest is undecided
//!   nothing holds, whatever is required.
//! - *Of whom*: of a number of a controller that controller alone is asked, of any other number all of them.

mod look;
mod search;
mod words;

use std::path::Path;

use fspid_diagnostics::nearest;
use fspid_scenario::file::{PathRow, Problems, paths_of, row_at};
use serde_json::{Value, json};

pub use look::Asked;
pub use search::{Beyond, End, Search, Why};

use look::Looker;

/// How close the ends are found, as a part of the size of the present value.
pub const TOLERANCE: f64 = 1e-3;

/// Which number of which scenario.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The scenario's text.
    pub text: &'a str,
    /// What it is called in messages.
    pub name: &'a str,
    /// The folder that it names files from; without one it can name none.
    pub folder: Option<&'a Path>,
    /// Where the number is, as `--set` takes it.
    pub path: &'a str,
    /// Ready sets that are required too, with their choices, such as `mil-f-8785c:level=2`.
    pub sets: &'a [String],
}

/// Why there is no interval.
#[derive(Clone, Debug, thiserror::Error)]
pub enum IntervalError {
    /// The scenario as it is written is wrong.
    #[error(transparent)]
    Problems(Problems),
    /// Nothing is there.
    #[error("there is no `{path}`{}; `fspid check --paths FILE` lists what there is", meant(nearest.as_deref()))]
    NoPlace {
        /// What was asked for.
        path: String,
        /// What was probably meant.
        nearest: Option<String>,
    },
    /// What is there is no number.
    #[error("`{path}` is no number, so that there is no interval around it")]
    NoNumber {
        /// What was asked for.
        path: String,
    },
}

/// Where a number can move.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// Where the number is.
    pub path: String,
    /// Its value in the scenario.
    pub present: f64,
    /// What was asked.
    pub asked: Asked,
    /// How close the ends are, in the number's unit.
    pub within: f64,
    /// What was found.
    pub search: Search,
}

/// Looks for the interval around the present value of a number.
///
/// # Errors
/// [`IntervalError`]: a scenario that is wrong as it is written, a path without a number. That nothing holds is an answer.
pub fn interval(question: &Question<'_>) -> Result<Interval, IntervalError> {
    let rows = paths_of(question.text, question.name, question.folder, &[])
        .map_err(IntervalError::Problems)?;
    let path = question.path.to_owned();
    let row = row_at(&rows, &path).ok_or_else(|| no_place(&rows, &path))?;
    let kind = row.schema.get("type").and_then(Value::as_str);
    let number = row.value.as_ref().and_then(|value| value.parse::<f64>().ok());
    let is_number = matches!(kind, Some("number" | "integer"));
    let Some(present) = number.filter(|number| is_number && number.is_finite()) else {
        return Err(IntervalError::NoNumber { path });
    };
    let mut looker =
        Looker::new(question, owner(&rows, &row.path)).map_err(IntervalError::Problems)?;
    let whole = kind == Some("integer");
    let size = if present == 0.0 { 1.0 } else { present.abs() };
    let within = if whole { 1.0 } else { TOLERANCE * size };
    let search = Search::around(present, size, whole, &mut |value| looker.look(value));
    Ok(Interval { path, present, asked: looker.asked, within, search })
}

fn no_place(rows: &[PathRow], path: &str) -> IntervalError {
    let known: Vec<&str> = rows.iter().map(|row| row.path.as_str()).collect();
    let nearest = nearest(path, &known).map(str::to_owned);
    IntervalError::NoPlace { path: path.to_owned(), nearest }
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |path| format!("; did you mean `{path}`?"))
}

/// The controller that a number belongs to.
fn owner(rows: &[PathRow], path: &str) -> Option<String> {
    rows.iter().find_map(|row| {
        let table = row.path.strip_suffix(".name").filter(|it| it.starts_with("controller"))?;
        let is_inside = path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'));
        let name = is_inside.then_some(row.value.as_ref()).flatten()?;
        Some(serde_json::from_str(name).unwrap_or_else(|_| name.clone()))
    })
}

impl Interval {
    /// True if the present value holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.search.why.is_none()
    }

    /// For programs.
    ///
    /// `holds` is of the present value. With it there are `least` and `most`, the outermost values that hold, `inside`, how
    /// many values were looked at between them, and `below` and `above`, what was found beyond: `{value, kind, why}`, or
    /// nothing where the search ended. Without it there are `why`, and as `nearest` the nearest value that holds, if one
    /// was found. `looked_at` counts all values, and `values` lists them with whether they hold.
    #[must_use]
    pub fn json(&self) -> Value {
        let Search { ends, why, nearest, looks } = &self.search;
        let values: Vec<Value> = looks.iter().map(|(value, holds)| json!([value, holds])).collect();
        let [below, above] = ends;
        json!({
            "schema": 1,
            "path": self.path,
            "present": self.present,
            "asked": self.asked.words(),
            "controller": self.asked.controller,
            "requirements": self.asked.requirements,
            "sets": self.asked.sets,
            "within": self.within,
            "looked_at": looks.len(),
            "values": values,
            "holds": self.holds(),
            "why": why.as_ref().map(Why::words),
            "least": self.holds().then_some(below.holds),
            "most": self.holds().then_some(above.holds),
            "inside": self.inside(),
            "below": below.beyond.as_ref().map(Beyond::json),
            "above": above.beyond.as_ref().map(Beyond::json),
            "nearest": nearest,
            "text": self.text(),
        })
    }

    /// How many values were looked at that hold, from the least to the most.
    #[must_use]
    pub fn inside(&self) -> usize {
        let [below, above] = self.search.ends.each_ref().map(|end| end.holds);
        let between = |value: f64| self.holds() && (below..=above).contains(&value);
        self.search.looks.iter().filter(|(value, _)| between(*value)).count()
    }
}
