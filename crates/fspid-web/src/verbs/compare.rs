//! Telemetry beside its model: the model at the times that were told, and how far apart both are.

use fspid_study::difference::{Curve, Difference};
use serde_json::json;

use super::Answered;
use crate::Answer;
use crate::question::Question;

/// Columns of the model's pitch and command and of the difference at `time_s`; `begin_s` is where the model's time is 0.
pub(super) fn compare(question: &Question) -> Answered {
    let [time_s, measured, model_s] =
        ["time_s", "measured_deg", "model_s"].map(|key| question.numbers(key));
    let begin_s = question.number("begin_s")?;
    let model = |key: &str| -> Vec<f64> {
        let values = question.numbers(key);
        let curve = Curve { time_s: &model_s, values: &values };
        time_s.iter().map(|time| curve.at(time - begin_s)).collect()
    };
    let (theta, command) = (model("theta_deg"), model("command_deg"));
    let known = |at: usize| measured.get(at).copied().unwrap_or(f64::NAN);
    let apart: Vec<f64> = theta.iter().enumerate().map(|(at, value)| known(at) - value).collect();
    let difference = Difference::of(&time_s, &apart).map(|found| {
        json!({ "largest_deg": found.largest, "at_s": found.at_s, "rms_deg": found.rms, "lines": found.count })
    });
    let mut answer = Answer::of(json!(null));
    let [theta, command, apart] = [theta, command, apart].map(|column| answer.keep(column));
    answer.json = json!({
        "difference": difference, "model_deg": theta, "command_deg": command, "difference_deg": apart,
    });
    Ok(answer)
}
