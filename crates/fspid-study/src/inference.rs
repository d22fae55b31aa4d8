//! Questions to the supervisor, one at a time or a file of them.

use fspid_core::fuzzy::{Inference, Supervisor};
use serde_json::{Value, json};

use crate::json::{merged, present};
use crate::rows::RowAnswers;
use fspid_diagnostics::lines;

/// The answer as JSON.
#[must_use]
pub fn json(inference: &Inference<f64>) -> Value {
    let delta = inference.delta;
    let outputs = json!({ "delta_kp": delta.kp, "delta_ki": delta.ki, "delta_kd": delta.kd });
    let remarks = present(json!({
        "clamped": inference.clamped.then_some(true),
        "underflowed": inference.underflowed.then_some(true),
    }));
    merged([outputs, remarks])
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

impl RowAnswers for SupervisorTable {
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
