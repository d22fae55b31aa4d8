//! A summary for other programs.

use serde_json::{Value, json};

use super::data::{
    Bad, ControllerSummary, Extreme, FailedRun, Head, Influence, MeasureSummary, Note, Probability,
    RequirementSummary, Sensitivity, SensitivityTarget, Summary,
};
use crate::statistics::Histogram;

/// Version of the JSON.
const SCHEMA: u64 = 1;

/// A summary as JSON: names are stable under one `schema`, and null stands where something does not exist.
///
/// Numbers are in the unit that the name of their measure ends with; probabilities and shares are from 0 to 1, not
/// percent. Numbers that are not finite are null. Seeds are texts, because not every program reads 64 bits.
///
/// ```text
/// schema                1
/// campaign              id, 64 hexadecimal digits
/// program               name and version of what flew it
/// scenario              { name, digest, changes: [text], text }
/// runs, rows            counts
/// seed                  text
/// sampling              random | latin-hypercube | sobol
/// digest                of the rows, 64 hexadecimal digits
/// confidence            of intervals and bounds
/// parameters            [{ name, kind: float | integer | text, unit, meaning }]
/// controllers           [{
///   name
///   verdicts            [{ verdict, flights }]
///   failed, refused     probability
///   requirements        [{ id, measure, unit, required, least, most, not_met: probability, without_value,
///                          not_judged, worst: { run, value } }]
///   measures            [{ name, unit, meaning, count, missing, not_finite, bad: high | low, is_event,
///                          mean, standard_deviation, standard_error, minimum, maximum,
///                          quantiles: [{ share, value, lower, upper }],
///                          histogram: { edges, counts, below, above },
///                          lowest, highest: [{ run, value }] }]
///   failed_runs         [{ run, severity: diverged | hit the ground | unstable | refused | requirements not met,
///                          diverged_at_s, reasons }]
///   sensitivities       [{ of: failure | measure, measure, used, runs_used, runs,
///                          parameters: [{ parameter,
///                            rank_correlation: { coefficient, interval_95: [lower, upper], pairs },
///                            variance_share: { fraction, uncorrected, standard_error, classes } }] }]
/// }]
/// notes                 [{ note, text, … what the note is about }]
///
/// probability           { count, of, estimate, lower, upper, at_most, at_least }
/// ```
#[must_use]
pub fn json(summary: &Summary) -> Value {
    let Head { scenario_text, scenario_digest, changes, .. } = &summary.head;
    let head = &summary.head;
    let parameters: Vec<Value> = head
        .parameters
        .iter()
        .map(|it| json!({ "name": it.name, "kind": it.kind.name(), "unit": it.unit, "meaning": it.meaning }))
        .collect();
    json!({
        "schema": SCHEMA,
        "campaign": head.campaign,
        "program": head.program,
        "scenario": {
            "name": head.scenario,
            "digest": scenario_digest,
            "changes": changes,
            "text": scenario_text,
        },
        "runs": head.runs,
        "rows": head.rows,
        "seed": head.seed.to_string(),
        "sampling": head.sampling.name(),
        "digest": head.digest.to_string(),
        "confidence": head.confidence,
        "parameters": parameters,
        "controllers": list(&summary.controllers, controller),
        "notes": list(&summary.notes, note),
    })
}

fn list<T>(items: &[T], one: fn(&T) -> Value) -> Value {
    items.iter().map(one).collect()
}

fn controller(it: &ControllerSummary) -> Value {
    let verdicts = it.verdicts.iter();
    let verdicts = verdicts.map(|it| json!({ "verdict": it.verdict, "flights": it.flights }));
    json!({
        "name": it.name,
        "verdicts": verdicts.collect::<Vec<_>>(),
        "failed": probability(&it.failed),
        "refused": probability(&it.refused),
        "requirements": list(&it.requirements, requirement),
        "measures": list(&it.measures, measure),
        "failed_runs": list(&it.failed_runs, failed_run),
        "sensitivities": list(&it.sensitivities, sensitivity),
    })
}

fn probability(it: &Probability) -> Value {
    let [lower, upper] = it.interval;
    json!({
        "count": it.count,
        "of": it.of,
        "estimate": it.estimate,
        "lower": lower,
        "upper": upper,
        "at_most": it.at_most,
        "at_least": it.at_least,
    })
}

fn requirement(it: &RequirementSummary) -> Value {
    json!({
        "id": it.id,
        "measure": it.measure,
        "unit": it.unit,
        "required": it.required,
        "least": it.limits.least,
        "most": it.limits.most,
        "not_met": probability(&it.not_met),
        "without_value": it.without_value,
        "not_judged": it.not_judged,
        "worst": it.worst.as_ref().map(extreme),
    })
}

fn extreme(it: &Extreme) -> Value {
    json!({ "run": it.run, "value": it.value })
}

fn measure(it: &MeasureSummary) -> Value {
    let quantiles = it.quantiles.iter().map(|quantile| {
        json!({
            "share": quantile.share,
            "value": quantile.value,
            "lower": quantile.interval.lower,
            "upper": quantile.interval.upper,
        })
    });
    let bad = it.bad.map(|bad| match bad {
        Bad::High => "high",
        Bad::Low => "low",
    });
    json!({
        "name": it.name,
        "unit": it.unit,
        "meaning": it.meaning,
        "count": it.count,
        "missing": it.missing,
        "not_finite": it.not_finite,
        "bad": bad,
        "is_event": it.is_event,
        "mean": it.moments.map(|moments| moments.mean),
        "standard_deviation": it.moments.and_then(|moments| moments.standard_deviation),
        "standard_error": it.moments.and_then(|moments| moments.standard_error),
        "minimum": it.lowest.first().map(|lowest| lowest.value),
        "maximum": it.highest.first().map(|highest| highest.value),
        "quantiles": quantiles.collect::<Vec<_>>(),
        "histogram": it.histogram.as_ref().map(histogram),
        "lowest": list(&it.lowest, extreme),
        "highest": list(&it.highest, extreme),
    })
}

fn histogram(it: &Histogram) -> Value {
    json!({ "edges": it.edges, "counts": it.counts, "below": it.below, "above": it.above })
}

fn failed_run(it: &FailedRun) -> Value {
    json!({
        "run": it.run,
        "severity": it.severity.name(),
        "diverged_at_s": it.diverged_at_s,
        "reasons": it.reasons,
    })
}

fn sensitivity(it: &Sensitivity) -> Value {
    let (of, measure) = match &it.of {
        SensitivityTarget::Failure => ("failure", None),
        SensitivityTarget::Measure(name) => ("measure", Some(name)),
    };
    let [runs_used, runs] = it.used_of;
    json!({
        "of": of,
        "measure": measure,
        "used": it.used,
        "runs_used": runs_used,
        "runs": runs,
        "parameters": list(&it.influences, influence),
    })
}

fn influence(it: &Influence) -> Value {
    let correlation = it.correlation.map(|found| {
        json!({
            "coefficient": found.coefficient,
            "interval_95": found.interval_95,
            "pairs": found.pairs,
        })
    });
    let share = it.share.map(|share| {
        json!({
            "fraction": share.fraction,
            "uncorrected": share.uncorrected,
            "standard_error": share.standard_error,
            "classes": share.classes,
        })
    });
    json!({ "parameter": it.parameter, "rank_correlation": correlation, "variance_share": share })
}

fn note(it: &Note) -> Value {
    let mut value = json!({ "note": it.name(), "text": it.to_string() });
    let counted = |measures: &[(String, u64)]| -> Value {
        measures.iter().map(|(name, flights)| json!({ "name": name, "flights": flights })).collect()
    };
    let more = match it {
        Note::RunsNotIndependent { sampling } => vec![("sampling", json!(sampling.name()))],
        Note::SharesOvercorrected => Vec::new(),
        Note::NothingRequired { controller } => vec![("controller", json!(controller))],
        Note::FirstRunsOnly { used, of } => vec![("runs_used", json!(used)), ("runs", json!(of))],
        Note::Missing { controller, measures } | Note::NotFinite { controller, measures } => {
            vec![("controller", json!(controller)), ("measures", counted(measures))]
        }
    };
    if let Some(object) = value.as_object_mut() {
        object.extend(more.into_iter().map(|(name, value)| (name.to_owned(), value)));
    }
    value
}
