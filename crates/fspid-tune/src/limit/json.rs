//! The answer for programs.

use fspid_scenario::units::degrees;
use serde_json::{Value, json};

use super::words::{beside, in_unit, none, unit};
use super::{Answer, Rung, Standing};

pub(super) fn json(answer: &Answer) -> Value {
    let (duration_s, sample_period_s) = answer.times_s;
    json!({
        "scenario": answer.scenario,
        "digest": answer.digest,
        "duration_s": duration_s,
        "sample_period_s": sample_period_s,
        "measure": answer.options.measure.name(),
        "unit": unit(answer.options.measure),
        "travel_of": answer.options.travel.name(),
        "ladder": answer.rungs.iter().map(|it| rung(answer, it)).collect::<Vec<_>>(),
        "controllers": answer.controllers.iter().map(|it| standing(answer, it)).collect::<Vec<_>>(),
        "beside": beside(answer),
    })
}

fn rung(answer: &Answer, rung: &Rung) -> Value {
    let value = |value: f64| in_unit(answer.options.measure, value);
    let mut told = json!({ "travel_deg": degrees(rung.travel_rad) });
    match &rung.limit {
        Ok(limit) => told["proved"] = json!(value(limit.proved)),
        Err(_) => told["why_none"] = json!(none(rung)),
    }
    if let Some(reached) = rung.reached {
        told["reached"] = json!(value(reached.measure));
        told["reached_travel_deg"] = json!(degrees(reached.travel_rad));
    }
    if let Some(causal) = &rung.causal {
        told["without_future"] = json!({
            "reached": value(causal.reached.measure),
            "reached_travel_deg": degrees(causal.reached.travel_rad),
            "plans": causal.plans,
        });
    }
    told
}

fn standing(answer: &Answer, standing: &Standing) -> Value {
    let mut told = json!({ "name": standing.name });
    match &standing.flown {
        Ok((value, way)) => {
            told["value"] = json!(in_unit(answer.options.measure, *value));
            told["travel_deg"] = json!(degrees(*way));
        }
        Err(why) => told["why_none"] = json!(why),
    }
    if let Some(share_pct) = standing.share_pct() {
        told["of_possible_pct"] = json!(share_pct);
    }
    if let Some(own) = &standing.rung {
        told["limit"] = rung(answer, own);
    }
    told
}
