//! The answer for programs.

use serde_json::{Map, Value, json};

use super::Verification;
use crate::judgement::Judgement;
use crate::simulation::{FailedFlight, finite};

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
    /// an end is the text `"inf"`. `own_flight` stands
    /// where a ready set was judged on a flight of its own. Keys without a value are left out. `failed_flights` are
    /// flights that fail whatever is required of them, `[{"controller": "…", "failures": ["…"]}]`, with `own_flight` for
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
        let mut answer = json!({
            "schema": SCHEMA,
            "scenario": self.study.scenario.name,
            "file": self.path,
            "digest": self.study.digest,
            "all_met": self.all_met(),
            "met": self.judgements.len() - self.unmet(),
            "not_met": self.unmet(),
            "not_evaluated": unevaluated.count(),
            "requirements": requirements,
        });
        let failed: Vec<Value> = self.failed_flights.iter().map(FailedFlight::json).collect();
        if !failed.is_empty() {
            answer["failed_flights"] = json!(failed);
        }
        if !self.at_rest.is_empty() {
            answer["at_rest"] = json!(self.at_rest);
        }
        answer
    }
}

fn line(judgement: &Judgement, replay: Option<&String>) -> Value {
    let requirement = &judgement.requirement;
    let origin = &requirement.origin;
    let mut whole = Map::new();
    let mut put = |key: &str, value: Option<Value>| {
        if let Some(value) = value {
            whole.insert(key.to_owned(), value);
        }
    };
    let word = |text: &Option<String>| text.as_ref().map(|text| json!(text));
    put("id", Some(json!(requirement.id)));
    put("controller", Some(json!(judgement.controller)));
    put("measure", Some(json!(requirement.measure.name())));
    put("unit", Some(json!(requirement.measure.unit())));
    match &judgement.found {
        Ok(case) => put("value", Some(finite(case.value))),
        Err(reason) => put("reason", Some(json!(reason.to_string()))),
    }
    put("least", requirement.least.map(|least| json!(least)));
    put("most", requirement.most.map(|most| json!(most)));
    put("met", Some(json!(judgement.met)));
    put("clause", word(&origin.clause));
    put("source", word(&origin.source));
    put("confidence", origin.confidence.map(|confidence| json!(confidence.name())));
    put("set", word(&origin.set));
    put("note", word(&origin.note));
    put("conditions", conditions(judgement));
    let place = judgement.place();
    put("worst_case", (!place.is_empty()).then(|| place.json()));
    put("own_flight", judgement.own_step_deg.map(|step_deg| json!({ "step_deg": step_deg })));
    put("replay", replay.map(|replay| json!(replay)));
    Value::Object(whole)
}

fn conditions(judgement: &Judgement) -> Option<Value> {
    let conditions = &judgement.requirement.conditions;
    let mut whole = Map::new();
    for (key, number) in conditions.numbers() {
        if let Some(number) = number {
            whole.insert(key.to_owned(), json!(number));
        }
    }
    if let Some(air) = conditions.air {
        whole.insert("air".to_owned(), json!(air.name()));
    }
    (!whole.is_empty()).then_some(Value::Object(whole))
}
