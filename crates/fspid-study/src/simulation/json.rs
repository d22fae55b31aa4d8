//! The answer as JSON: angles in degrees, every absent measure with its reason.

use fspid_core::Gains;
use fspid_sim::load::ConstantLoad;
use serde_json::{Map, Value, json};

use super::{ControllerResult, FailedFlight, Judgement, Simulation};
use crate::analysis::{AtRest, RestGains};
use crate::json::{finite, present, unless_empty};
use crate::metrics::{Absent, EdgeMetrics, METRICS, Measured, StepMetrics, Verdict};
use fspid_scenario::units::degrees;

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Simulation {
    /// The answer of `simulate --format json`. Of each controller `verdict` is a sentence, `outcome` the same for
    /// programs: its `kind` ([`Verdict::kind`]) and the numbers of that kind, `at_s`, `window_s`, `doubling_s` and
    /// `spectral_radius`. `failed` says whether the flight fails whatever is required of it, `failures` why. `stability` is
    /// that of the loop at rest, a word, where it could be asked, and `undecided` why nobody can tell. `notes` of a controller
    /// are what the text says of it beside its measures, those beside them hold for the whole answer.
    #[must_use]
    pub fn json(&self) -> Value {
        present(json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "controllers": self.results.iter().map(controller).collect::<Vec<_>>(),
            "notes": self.range_rule.note().map(|note| [note]),
            "failed_own_flights": unless_empty(&self.failed_own_flights, FailedFlight::json),
            "requirements": unless_empty(&self.judgements, judgement),
        }))
    }
}

fn controller(result: &ControllerResult) -> Value {
    let metrics = &result.metrics;
    let first_step = metrics.first_step();
    let of_flight = METRICS.iter().filter_map(|it| Some((it.key?, it.of_flight(metrics))));
    let (values, absent) = split(step_measures(&first_step).chain(of_flight));
    let failures = result.failures();
    present(json!({
        "name": result.name,
        "verdict": result.verdict().to_string(),
        "outcome": outcome(result.verdict()),
        "failed": !failures.is_empty(),
        "metrics": values,
        "absent": absent,
        "edges": metrics.edges.iter().map(edge).collect::<Vec<_>>(),
        "saturated_samples": result.trace.saturated_samples,
        "faults": result.trace.faults.to_string(),
        "gains": gains(&result.at_rest),
        "stability": result.at_rest.stability_word(),
        "undecided": result.at_rest.undecided.map(|it| Absent::Undecided(it.doubt).to_string()),
        "notes": unless_empty(&notes(result), |words| json!(words)),
        "constant_load": result.at_rest.load.map(constant_load),
        "moves_the_wrong_way": result.metrics.wrong_way.then_some(true),
        "left_validity": result.trace.exit.map(|exit| json!({
            "at_s": exit.at_s,
            "outside_s": exit.outside_s,
            "limit": exit.departure.quantity.name(),
            "fails": result.ending().failing_exit().is_some(),
        })),
        "failures": (!failures.is_empty()).then_some(failures),
    }))
}

/// What the text says beside the measures and no other key does.
fn notes(result: &ControllerResult) -> Vec<String> {
    let at_rest = &result.at_rest;
    let without_gains = at_rest.gains_in_words().filter(|_| at_rest.gains.gains().is_none());
    without_gains.into_iter().chain(result.notes()).collect()
}

fn constant_load(load: ConstantLoad) -> Value {
    json!({
        "largest_deg_per_deg": finite(load.largest),
        "at_end_deg_per_deg": finite(load.at_end),
        "for_good_deg_per_deg": finite(load.for_good),
        "removed": load.is_removed(),
        "half_gone": load.is_half_gone(),
    })
}

/// A verdict for programs: its kind and its numbers.
fn outcome(verdict: Verdict) -> Value {
    let kind = verdict.kind();
    match verdict {
        Verdict::Settled | Verdict::Flown => json!({ "kind": kind }),
        Verdict::NotSettled { window_s, since_s: None } => {
            json!({ "kind": kind, "window_s": finite(window_s) })
        }
        Verdict::NotSettled { window_s, since_s: Some(since_s) } => {
            json!({ "kind": kind, "window_s": finite(window_s), "since_s": finite(since_s) })
        }
        Verdict::EndedEarly(end) => present(json!({
            "kind": kind,
            "at_s": finite(end.at_s),
            "loss": end.cause.loss_kind(),
        })),
        Verdict::Unstable { spectral_radius, doubling_s } => json!({
            "kind": kind,
            "spectral_radius": finite(spectral_radius),
            "doubling_s": finite(doubling_s),
        }),
        Verdict::ModeNeverBegan { mode } => json!({ "kind": kind, "mode": mode + 1 }),
        Verdict::LeftRange(exit) => json!({
            "kind": kind,
            "at_s": finite(exit.at_s),
            "outside_s": finite(exit.outside_s),
            "limit": exit.departure.quantity.name(),
        }),
    }
}

/// The step of a flight that a ready set was judged on, where it is not the scenario's.
pub(crate) fn own_flight(step_deg: Option<f64>) -> Option<Value> {
    step_deg.map(|step_deg| json!({ "step_deg": step_deg }))
}

impl FailedFlight {
    /// `{"controller": "…", "failures": ["…"], "own_flight": {"step_deg": 5.0}}`, the last where it is one.
    pub(crate) fn json(&self) -> Value {
        present(json!({
            "controller": self.controller,
            "failures": self.failures,
            "own_flight": own_flight(self.own_step_deg),
        }))
    }
}

/// The gains of the file and those at rest, `null` where these are not one set.
fn gains(at_rest: &AtRest) -> Value {
    let triple = |Gains { kp, ki, kd }| json!({ "kp": kp, "ki": ki, "kd": kd });
    json!({
        "nominal": (at_rest.gains != RestGains::Unknown).then(|| triple(at_rest.nominal)),
        "at_rest": at_rest.gains.gains().map(triple),
    })
}

fn edge(edge: &EdgeMetrics) -> Value {
    let (values, absent) = split(step_measures(&edge.step));
    present(json!({
        "at_s": edge.at_s,
        "from_deg": degrees(edge.from_rad),
        "to_deg": degrees(edge.to_rad),
        "metrics": values,
        "absent": absent,
        "disturbed_from_s": edge.disturbed_from_s,
    }))
}

fn step_measures(step: &StepMetrics) -> impl Iterator<Item = (&'static str, Measured)> {
    METRICS.iter().filter_map(|it| Some((it.name, it.of_step(step)?)))
}

/// Every measure by name, `null` for an absent one, and the reasons of the absent ones.
fn split(
    measures: impl Iterator<Item = (&'static str, Measured)>,
) -> (Map<String, Value>, Map<String, Value>) {
    let mut values = Map::new();
    let mut absent = Map::new();
    for (name, measured) in measures {
        match measured {
            Ok(value) => values.insert(name.to_owned(), json!(value)),
            Err(reason) => {
                absent.insert(name.to_owned(), json!(reason.to_string()));
                values.insert(name.to_owned(), Value::Null)
            }
        };
    }
    (values, absent)
}

fn judgement(judgement: &Judgement) -> Value {
    let requirement = &judgement.requirement;
    present(json!({
        "id": requirement.id,
        "controller": judgement.controller,
        "measure": requirement.measure.name(),
        "met": judgement.met,
        "least": requirement.least,
        "most": requirement.most,
        "value": judgement.found.as_ref().ok().map(|case| finite(case.value)),
        "absent": judgement.found.as_ref().err().map(ToString::to_string),
    }))
}
