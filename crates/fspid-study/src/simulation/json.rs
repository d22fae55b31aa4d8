//! The answer as JSON: angles in degrees, every absent measure with its reason.

use fspid_core::Gains;
use serde_json::{Map, Value, json};

use super::{ControllerResult, FailedFlight, Judgement, Simulation};
use crate::analysis::AtRest;
use crate::metrics::{EdgeMetrics, Measured, StepMetrics, Verdict};
use fspid_scenario::units::degrees;

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Simulation {
    /// The answer of `simulate --format json`. Of each controller `verdict` is a sentence, `outcome` the same for
    /// programs: its `kind` ([`Verdict::kind`]) and the numbers of that kind, `at_s`, `window_s`, `doubling_s` and
    /// `spectral_radius`. `failed` says whether the flight fails whatever is required of it, `failures` why. `notes`
    /// hold for the whole answer.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut answer = json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "controllers": self.results.iter().map(controller).collect::<Vec<_>>(),
        });
        if let Some(note) = self.range_rule.note() {
            answer["notes"] = json!([note]);
        }
        if !self.failed_own_flights.is_empty() {
            answer["failed_own_flights"] =
                self.failed_own_flights.iter().map(FailedFlight::json).collect();
        }
        if !self.judgements.is_empty() {
            answer["requirements"] = self.judgements.iter().map(judgement).collect();
        }
        answer
    }
}

fn controller(result: &ControllerResult) -> Value {
    let metrics = &result.metrics;
    let mut measures = step_measures(&metrics.first_step());
    let integrals = metrics.integrals;
    measures.extend([
        ("iae", integrals.map(|i| degrees(i.iae_rad_s))),
        ("itae", integrals.map(|i| degrees(i.itae_rad_s2))),
        ("ise", integrals.map(|i| degrees(degrees(i.ise_rad2_s)))),
        ("itse", integrals.map(|i| degrees(degrees(i.itse_rad2_s2)))),
        ("command_variation", metrics.effort.map(|e| degrees(e.variation_rad))),
        ("command_max_deg", metrics.effort.map(|e| degrees(e.largest_rad))),
    ]);
    let (values, absent) = split(&measures);
    let mut answer = json!({
        "name": result.name,
        "verdict": result.verdict().to_string(),
        "outcome": outcome(result.verdict()),
        "failed": !result.failures().is_empty(),
        "metrics": values,
        "absent": absent,
        "edges": metrics.edges.iter().map(edge).collect::<Vec<_>>(),
        "saturated_samples": result.trace.saturated_samples,
        "faults": result.trace.faults.to_string(),
    });
    answer["gains"] = gains(&result.at_rest);
    if let Some(load) = result.at_rest.load {
        answer["constant_load"] = json!({
            "largest_deg_per_deg": finite(load.largest),
            "at_end_deg_per_deg": finite(load.at_end),
            "for_good_deg_per_deg": finite(load.for_good),
            "removed": load.is_removed(),
            "half_gone": load.is_half_gone(),
        });
    }
    if result.metrics.wrong_way {
        answer["moves_the_wrong_way"] = json!(true);
    }
    if let Some(exit) = result.trace.exit {
        answer["left_validity"] = json!({
            "at_s": exit.at_s,
            "outside_s": exit.outside_s,
            "limit": exit.departure.quantity.name(),
            "fails": result.ending().failing_exit().is_some(),
        });
    }
    let failures = result.failures();
    if !failures.is_empty() {
        answer["failures"] = json!(failures);
    }
    answer
}

/// A verdict for programs: its kind and its numbers.
fn outcome(verdict: Verdict) -> Value {
    let mut answer = json!({ "kind": verdict.kind() });
    match verdict {
        Verdict::Settled | Verdict::Flown => {}
        Verdict::NotSettled { window_s } => answer["window_s"] = finite(window_s),
        Verdict::Diverged { at_s } | Verdict::HitGround { at_s } => answer["at_s"] = finite(at_s),
        Verdict::Unstable { spectral_radius, doubling_s } => {
            answer["spectral_radius"] = finite(spectral_radius);
            answer["doubling_s"] = finite(doubling_s);
        }
        Verdict::LeftRange(exit) => {
            answer["at_s"] = finite(exit.at_s);
            answer["outside_s"] = finite(exit.outside_s);
            answer["limit"] = json!(exit.departure.quantity.name());
        }
    }
    answer
}

impl FailedFlight {
    /// `{"controller": "…", "failures": ["…"], "own_flight": {"step_deg": 5.0}}`, the last where it is one.
    pub(crate) fn json(&self) -> Value {
        let mut answer = json!({ "controller": self.controller, "failures": self.failures });
        if let Some(step_deg) = self.own_step_deg {
            answer["own_flight"] = json!({ "step_deg": step_deg });
        }
        answer
    }
}

/// The gains of the file and those at rest, `null` where these are not one set.
fn gains(at_rest: &AtRest) -> Value {
    let triple = |Gains { kp, ki, kd }| json!({ "kp": kp, "ki": ki, "kd": kd });
    json!({
        "nominal": triple(at_rest.nominal),
        "at_rest": at_rest.gains.gains().map(triple),
    })
}

fn edge(edge: &EdgeMetrics) -> Value {
    let (values, absent) = split(&step_measures(&edge.step));
    let mut answer = json!({
        "at_s": edge.at_s,
        "from_deg": degrees(edge.from_rad),
        "to_deg": degrees(edge.to_rad),
        "metrics": values,
        "absent": absent,
    });
    if let Some(from_s) = edge.disturbed_from_s {
        answer["disturbed_from_s"] = json!(from_s);
    }
    answer
}

fn step_measures(step: &StepMetrics) -> Vec<(&'static str, Measured)> {
    vec![
        ("rise_time_s", step.rise_time_s),
        ("settling_time_s", step.settling_time_s),
        ("transient_time_s", step.transient_time_s),
        ("overshoot_pct", step.overshoot_pct),
        ("undershoot_pct", step.undershoot_pct),
        ("final_error_pct", step.final_error_pct),
        ("peak_deg", step.peak.map(degrees)),
        ("peak_time_s", step.peak_time_s),
    ]
}

/// Every measure by name, `null` for an absent one, and the reasons of the absent ones.
fn split(measures: &[(&'static str, Measured)]) -> (Map<String, Value>, Map<String, Value>) {
    let mut values = Map::new();
    let mut absent = Map::new();
    for (name, measured) in measures {
        match measured {
            Ok(value) => values.insert((*name).to_owned(), json!(value)),
            Err(reason) => {
                absent.insert((*name).to_owned(), json!(reason.to_string()));
                values.insert((*name).to_owned(), Value::Null)
            }
        };
    }
    (values, absent)
}

fn judgement(judgement: &Judgement) -> Value {
    let requirement = &judgement.requirement;
    let mut answer = json!({
        "id": requirement.id,
        "controller": judgement.controller,
        "measure": requirement.measure.name(),
        "met": judgement.met,
    });
    for (key, limit) in [("least", requirement.least), ("most", requirement.most)] {
        if let Some(limit) = limit {
            answer[key] = json!(limit);
        }
    }
    match &judgement.found {
        Ok(case) => answer["value"] = finite(case.value),
        Err(reason) => answer["absent"] = json!(reason.to_string()),
    }
    answer
}

/// A number, or in words which of the numbers that JSON does not have.
pub(crate) fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { json!(format!("{value}")) }
}
