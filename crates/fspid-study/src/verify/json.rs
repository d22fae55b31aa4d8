//! The answer for programs.

use serde_json::{Map, Value, json};

use fspid_scenario::requirement::{Conditions, Confidence};

use super::Verification;
use crate::json::{by_name, finite, present, unless_empty};
use crate::judgement::Judgement;
use crate::simulation::{FailedFlight, own_flight};

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Verification {
    /// The answer of `verify --format json`. `replays` are the paths of the files that replay the lines, if they were
    /// written.
    ///
    /// ```json
    /// {
    ///   "schema": 1, "scenario": "…", "file": "…", "digest": "…", "all_met": false,
    ///   "met": 7, "not_met": 2, "not_evaluated": 1,
    ///   "requirements": [{
    ///     "id": "…", "controller": "…", "measure": "phase_margin_deg", "unit": "deg",
    ///     "value": 31.2, "least": 45.0, "met": false,
    ///     "clause": "…", "source": "…", "confidence": "recalled", "set": "…", "note": "…",
    ///     "conditions": {"from_hz": 0.06}, "worst_case": {"frequency_rad_s": 2.3}, "replay": "…",
    ///     "own_flight": {"step_deg": 11.46}
    ///   }]
    /// }
    /// ```
    /// `not_met` counts what could not be evaluated too; such a line has `reason` in place of `value`. A margin without
    /// an end is the text `"infinite"`. `own_flight` stands
    /// where a ready set was judged on a flight of its own, of the pitch loop without an autopilot. Keys without a value are
    /// left out. `failed_flights` are flights that fail whatever is required of them, `[{"controller": "…", "failures": ["…"]}]`, with `own_flight` for
    /// those of ready sets; with one `all_met` is false. `at_rest` says of each self-tuning controller its gains at rest, and of each controller a constant load
    /// that it does not remove.
    #[must_use]
    pub fn json(&self, replays: Option<&[String]>) -> Value {
        let unevaluated = self.judgements.iter().filter(|judgement| judgement.found.is_err());
        let requirements: Vec<Value> = self
            .judgements
            .iter()
            .enumerate()
            .map(|(index, judgement)| {
                line(judgement, replays.and_then(|replays| replays.get(index)))
            })
            .collect();
        present(json!({
            "schema": SCHEMA,
            "scenario": self.study.scenario.name,
            "file": self.path,
            "digest": self.study.digest,
            "all_met": self.all_met(),
            "met": self.judgements.len() - self.unmet(),
            "not_met": self.unmet(),
            "not_evaluated": unevaluated.count(),
            "requirements": requirements,
            "failed_flights": unless_empty(&self.failed_flights, FailedFlight::json),
            "at_rest": unless_empty(&self.at_rest, |sentence| json!(sentence)),
        }))
    }
}

fn line(judgement: &Judgement, replay: Option<&String>) -> Value {
    let requirement = &judgement.requirement;
    let origin = &requirement.origin;
    let place = judgement.place();
    present(json!({
        "id": requirement.id,
        "controller": judgement.controller,
        "measure": requirement.measure.name(),
        "unit": requirement.measure.unit(),
        "value": judgement.found.as_ref().ok().map(|case| finite(case.value)),
        "reason": judgement.found.as_ref().err().map(ToString::to_string),
        "least": requirement.least,
        "most": requirement.most,
        "met": judgement.met,
        "clause": origin.clause,
        "source": origin.source,
        "confidence": origin.confidence.map(Confidence::name),
        "set": origin.set,
        "note": origin.note,
        "conditions": conditions(&requirement.conditions),
        "worst_case": (!place.is_empty()).then(|| place.json()),
        "own_flight": own_flight(judgement.own_step_deg),
        "replay": replay,
    }))
}

fn conditions(conditions: &Conditions) -> Option<Map<String, Value>> {
    let numbers = conditions.numbers().into_iter();
    let numbers = numbers.filter_map(|(key, number)| Some((key.to_owned(), json!(number?))));
    by_name(numbers.chain(conditions.air.map(|air| ("air".to_owned(), json!(air.name())))))
}
