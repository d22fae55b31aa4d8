//! Questions to the supervisor, one at a time or a file of them.

use std::fmt::{self, Write as _};
use std::path::Path;

use fspid_core::fuzzy::{Defuzzifier, Inference, OutOfRange, Supervisor};
use serde_json::{Value, json};

use crate::file;

/// A supervisor as it is named on the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question<'a> {
    /// Name of a shipped rule table, or a file.
    pub table: &'a str,
    /// Half range of inputs and outputs.
    pub range: f64,
    /// Name of the centroid rule.
    pub defuzzifier: &'a str,
    /// Name of the policy for inputs beyond the range.
    pub out_of_range: &'a str,
}

/// Why there is no answer: every problem, in sentences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(Vec<String>);

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl std::error::Error for Refused {}

impl Question<'_> {
    /// The supervisor in question.
    ///
    /// # Errors
    /// [`Refused`] with every problem of the question at once.
    pub fn supervisor(&self) -> Result<Supervisor<f64>, Refused> {
        let mut problems = Vec::new();
        let table = file::load_rule_table(self.table, None).map_err(|found| {
            let known = file::rule_table_names().join(", ");
            problems.push(format!("--table: known are {known}, or a readable .toml file\n{found}"));
        });
        let defuzzifier = self.defuzzifier.parse::<Defuzzifier>().map_err(|problem| {
            problems.push(format!("--defuzzifier {}: {problem}", self.defuzzifier));
        });
        let policy = OutOfRange::ALL.into_iter().find(|p| p.name() == self.out_of_range);
        if policy.is_none() {
            let known = OutOfRange::ALL.map(OutOfRange::name).join(", ");
            problems.push(format!("--out-of-range {}: known are {known}", self.out_of_range));
        }
        let usable_range = self.range.is_finite() && self.range > 0.0;
        if !usable_range {
            problems
                .push(format!("--range is {:?}; allowed is a finite number above 0", self.range));
        }
        let (Ok(table), Ok(defuzzifier), Some(policy), true) =
            (table, defuzzifier, policy, usable_range)
        else {
            return Err(Refused(problems));
        };
        Supervisor::new(&table, self.range, defuzzifier, policy)
            .map_err(|problem| Refused(vec![problem.to_string()]))
    }
}

/// The answer as JSON.
#[must_use]
pub fn json(inference: &Inference<f64>) -> Value {
    let delta = inference.delta;
    let mut answer = json!({"delta_kp": delta.kp, "delta_ki": delta.ki, "delta_kd": delta.kd});
    if inference.clamped {
        answer["clamped"] = json!(true);
    }
    if inference.underflowed {
        answer["underflowed"] = json!(true);
    }
    answer
}

/// The answer for people.
#[must_use]
pub fn text(inference: &Inference<f64>) -> String {
    let delta = inference.delta;
    let note = match (inference.clamped, inference.underflowed) {
        (_, true) => "every rule underflowed; answered as for the clamped inputs\n",
        (true, false) => "an input was moved to the end of its range\n",
        (false, false) => "",
    };
    format!(
        "delta_kp {:+.12}\ndelta_ki {:+.12}\ndelta_kd {:+.12}\n{note}",
        delta.kp, delta.ki, delta.kd
    )
}

/// Largest file of points, bytes.
const LARGEST_FILE: u64 = 1 << 30;
/// Most problems that are told of one file.
const MOST_PROBLEMS: usize = 20;

/// Answers every row of a CSV file with columns `e` and `ec` (others are passed over) by a row
/// `e,ec,delta_kp,delta_ki,delta_kd` with 17 significant digits.
///
/// # Errors
/// [`Refused`] where the file cannot be read, lacks a column or holds rows that have no answer; no
/// row is answered then.
pub fn answer_file(supervisor: &Supervisor<f64>, path: &Path) -> Result<String, Refused> {
    let refused = |problem: String| Refused(vec![format!("{}: {problem}", path.display())]);
    let size = std::fs::metadata(path).map_err(|error| refused(error.to_string()))?.len();
    if size > LARGEST_FILE {
        return Err(refused(format!("{size} bytes; allowed are at most {LARGEST_FILE}")));
    }
    let text = std::fs::read_to_string(path).map_err(|error| refused(error.to_string()))?;
    answer_rows(supervisor, &text).map_err(|problems| {
        Refused(problems.iter().map(|p| format!("{}:{p}", path.display())).collect())
    })
}

fn answer_rows(supervisor: &Supervisor<f64>, text: &str) -> Result<String, Vec<String>> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
    let header = lines.next().map_or("", |(line, _)| line);
    let column = |name: &str| header.split(',').position(|word| word.trim() == name);
    let (Some(error_column), Some(change_column)) = (column("e"), column("ec")) else {
        return Err(vec![format!(
            "1: the heading is `{}`; it must name the columns e and ec",
            header.chars().take(80).collect::<String>()
        )]);
    };
    let mut out = String::from("e,ec,delta_kp,delta_ki,delta_kd\n");
    let mut problems = Vec::new();
    for (line, number) in lines.filter(|(line, _)| !line.trim().is_empty()) {
        let read = |index: usize, name: &str| {
            let word = line.split(',').nth(index).map_or("", str::trim);
            word.parse::<f64>()
                .map_err(|_| format!("{number}: {name} is `{word}`; allowed is a number"))
        };
        let answer = read(error_column, "e").and_then(|e| {
            let ec = read(change_column, "ec")?;
            let answer =
                supervisor.infer(e, ec).map_err(|problem| format!("{number}: {problem}"))?;
            Ok((e, ec, answer.delta))
        });
        match answer {
            Ok((e, ec, d)) => {
                // Writing to a string cannot fail.
                let _ =
                    writeln!(out, "{e:.16e},{ec:.16e},{:.16e},{:.16e},{:.16e}", d.kp, d.ki, d.kd);
            }
            Err(problem) if problems.len() < MOST_PROBLEMS => problems.push(problem),
            Err(_) => {
                problems.push("and more".to_owned());
                break;
            }
        }
    }
    if problems.is_empty() { Ok(out) } else { Err(problems) }
}
