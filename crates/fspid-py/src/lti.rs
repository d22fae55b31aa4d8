//! Margins of loops that are given as transfer functions.

use fspid::lti::{FrequencyResponse, LtiError, TransferFunction};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::error;

/// Margins of a continuous loop: polynomials by falling powers, a dead time.
#[pyfunction]
pub(crate) fn margins(
    py: Python<'_>,
    numerator: Vec<f64>,
    denominator: Vec<f64>,
    delay_s: f64,
) -> PyResult<Answer> {
    let found = py.detach(|| found(&numerator, &denominator, delay_s));
    let json = found.map_err(|found| error::input(py, found))?;
    Ok(Answer::new(String::new(), &json, json["stable"] == json!(true)))
}

fn found(numerator: &[f64], denominator: &[f64], delay_s: f64) -> Result<Value, LtiError> {
    let response = FrequencyResponse::new(TransferFunction::new(numerator, denominator)?, delay_s)?;
    let margins = response.margins()?;
    let lower = margins.lower_neutral().filter(|_| margins.stable());
    let phase = margins.phase_margin();
    // With a dead time there is no polynomial of which the peak would be a root.
    let peak = |it: Result<f64, LtiError>| it.ok();
    Ok(json!({
        "stable": margins.stable(),
        "gain_margin": margins.gain_margin(),
        "gain_reduction_margin": lower.map(|neutral| neutral.gain),
        "phase_margin_deg": phase.map(|it| it.phase_margin_rad.to_degrees()),
        "gain_crossover_rad_s": phase.map(|it| it.omega_rad_s),
        "phase_crossover_rad_s": margins.upper_neutral().filter(|_| margins.stable()).map(|it| it.omega_rad_s),
        "delay_margin_s": margins.delay_margin_s(),
        "sensitivity_peak": peak(response.peak_sensitivity().map(|it| it.value)),
        "disk_margin": peak(response.disk_margin(0.0).map(|it| it.size)),
        "reasons": reasons(margins.stable(), delay_s),
    }))
}

/// Why a number is absent.
fn reasons(stable: bool, delay_s: f64) -> Value {
    let unstable = "an unstable loop has no margins";
    if !stable {
        let names = [
            "gain_margin",
            "gain_reduction_margin",
            "phase_margin_deg",
            "gain_crossover_rad_s",
            "phase_crossover_rad_s",
            "delay_margin_s",
            "sensitivity_peak",
            "disk_margin",
        ];
        return names.into_iter().map(|name| (name.to_owned(), json!(unstable))).collect();
    }
    let dead =
        if delay_s > 0.0 { "not computed for a loop with dead time" } else { "there is none" };
    json!({
        "gain_margin": "no larger gain makes the loop unstable",
        "gain_reduction_margin": "no smaller gain makes the loop unstable",
        "phase_crossover_rad_s": "no larger gain makes the loop unstable",
        "phase_margin_deg": "the gain is 1 nowhere",
        "gain_crossover_rad_s": "the gain is 1 nowhere",
        "delay_margin_s": "no dead time makes the loop unstable",
        "sensitivity_peak": dead,
        "disk_margin": dead,
    })
}
