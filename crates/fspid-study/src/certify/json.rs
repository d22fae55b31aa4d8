//! Certificates for programs.

use fspid_numeric::scalar::Interval;
use fspid_proof::{Bearing, Kept, Outcome, Rechecked, Verdict};
use serde_json::{Value, json};

use super::scope::{Told, told_deg};
use super::text::found;
use super::{Certification, Certified, CheckedFile, Comparison, Difference, Seal};

/// Version of the answer's shape.
const SCHEMA: u32 = 2;

impl Certification {
    /// The answer of `certify --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "controllers": self.results.iter().map(result).collect::<Vec<_>>(),
        })
    }
}

fn result(certified: &Certified) -> Value {
    let mut answer = json!({ "name": certified.controller, "plant_from_s": certified.from_s });
    match &certified.outcome {
        Err(reason) => {
            answer["verdict"] = json!("not provable");
            answer["reason"] = json!(reason.to_string());
        }
        Ok(outcome) => outcome_into(&mut answer, outcome),
    }
    answer
}

fn outcome_into(answer: &mut Value, outcome: &Outcome) {
    answer["verdict"] = json!(match &outcome.verdict {
        Verdict::Proved(..) => "proved",
        Verdict::Refuted(..) => "refuted",
        Verdict::Open => "open",
    });
    answer["asked"] = json!({
        "setpoint_within_deg": told_deg(outcome.asked.setpoint_rad),
        "load_within_deg": told_deg(outcome.asked.load_rad),
    });
    if let Some((certificate, rechecked)) = found(outcome) {
        // Of an open answer the claim is one about less than the scenario asks.
        answer["claim_is_for_less"] = json!(matches!(outcome.verdict, Verdict::Open));
        answer["claim"] = json!(certificate.claim.name());
        answer["decay_per_sample"] = json!(certificate.claim.rate());
        answer["inequalities"] = json!(rechecked.inequalities);
        answer["boxes_of_gains"] = json!(rechecked.cells);
        answer["law_keeps_to_the_rate"] = kept(rechecked);
        let bearing = certificate.bearing(rechecked);
        answer["bearing"] = json!(bearing.name());
        answer["bearing_in_words"] = json!(bearing.to_string());
        answer["scope"] = Told::of(certificate, rechecked).json();
    }
    let [kp, ki, kd] = outcome.bounds.map(ends);
    answer["gains"] = json!({ "kp": kp, "ki": ki, "kd": kd });
    answer["largest_output_factor"] = json!({
        "proved": outcome.largest.proved,
        "not_proved": outcome.largest.not_proved,
    });
    answer["open_because"] = json!(outcome.open_because.as_ref().map(ToString::to_string));
}

fn ends(bounds: Interval) -> [f64; 2] {
    [bounds.lower(), bounds.upper()]
}

impl CheckedFile {
    /// The answer of `certify --check --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut answer = json!({
            "schema": SCHEMA,
            "holds": self.holds(),
            "answer": self.answer().name(),
            "claim": self.certificate.claim.name(),
            "decay_per_sample": self.certificate.claim.rate(),
            "output_factor": self.certificate.output_factor,
            "bearing": self.bearing().map(Bearing::name),
            "bearing_in_words": self.bearing().map(|bearing| bearing.to_string()),
            "origin": self.origin,
            "as_written": self.seal == Seal::Whole,
        });
        match &self.result {
            Ok(rechecked) => {
                answer["inequalities"] = json!(rechecked.inequalities);
                answer["boxes_of_gains"] = json!(rechecked.cells);
                answer["law_keeps_to_the_rate"] = kept(rechecked);
                answer["scope"] = Told::of(&self.certificate, rechecked).json();
                let [kp, ki, kd] = rechecked.bounds.map(ends);
                answer["gains"] = json!({ "kp": kp, "ki": ki, "kd": kd });
            }
            Err(doubt) => answer["reason"] = json!(doubt.to_string()),
        }
        if let Some(against) = &self.against {
            answer["against"] = comparison(against);
        }
        answer
    }
}

/// Where the law keeps to the rate of a claim about one; `null` where that is not shown, or not asked.
fn kept(rechecked: &Rechecked) -> Value {
    match rechecked.kept {
        Some(Kept::Everywhere) => json!("everywhere"),
        Some(Kept::WithinLevel) => json!("within the level"),
        None => Value::Null,
    }
}

fn comparison(against: &Comparison) -> Value {
    let field =
        |it: &Difference| json!({ "path": it.path, "certified": it.certified, "flown": it.flown });
    json!({
        "scenario": against.scenario,
        "same": against.is_same(),
        "differences": against.differences.iter().map(field).collect::<Vec<_>>(),
        "digests": against.other_text,
    })
}
