//! Questions to the supervisor, one at a time or a file of them.

use std::fmt;

use fspid_core::fuzzy::{Defuzzifier, Inference, OutOfRange, Supervisor};
use serde_json::{Value, json};

use crate::file;
use crate::lines;
use crate::rows::Table;

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

impl Refused {
    /// One reason.
    pub(crate) fn one(reason: impl Into<String>) -> Self {
        Self(vec![reason.into()])
    }

    /// All reasons.
    pub(crate) fn all(reasons: Vec<String>) -> Self {
        Self(reasons)
    }
}

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

/// A supervisor that answers rows of `e,ec` by `e,ec,delta_kp,delta_ki,delta_kd` with 17
/// significant digits.
#[derive(Clone, Debug)]
pub struct SupervisorTable(pub Supervisor<f64>);

impl Table for SupervisorTable {
    fn inputs(&self) -> Vec<&str> {
        vec!["e", "ec"]
    }

    fn outputs(&self) -> Vec<&str> {
        vec!["delta_kp", "delta_ki", "delta_kd"]
    }

    fn check(&self, row: &[f64]) -> Result<(), String> {
        let &[error, change] = row else { return Ok(()) };
        // Whatever lies within the range has an answer; only the rest is asked.
        if error.abs() <= self.0.range() && change.abs() <= self.0.range() {
            return Ok(());
        }
        self.0.infer(error, change).map(|_| ()).map_err(|problem| problem.to_string())
    }

    fn answer(&mut self, row: &[f64], line: &mut String) -> Result<(), String> {
        let &[e, ec] = row else { return Ok(()) };
        let answer = self.0.infer(e, ec).map_err(|problem| problem.to_string())?;
        let d = answer.delta;
        lines::line(
            line,
            format_args!("{e:.16e},{ec:.16e},{:.16e},{:.16e},{:.16e}", d.kp, d.ki, d.kd),
        );
        Ok(())
    }
}
