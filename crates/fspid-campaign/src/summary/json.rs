//! A summary for other programs.

use fspid_study::json::with_null_reasons;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::data::{MeasureSummary, Note, SensitivityTarget, Severity, Summary};

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
/// runs, rows            counts of what was read
/// planned_runs, shards  only where parts were read: how many runs were planned, { found, of }
/// seed                  text
/// sampling              random | latin-hypercube | sobol
/// digest                of the rows, 64 hexadecimal digits; null where parts were read one by one
/// confidence            of intervals and bounds
/// parameters            [{ name, kind: float | integer | text, unit, meaning }]
/// controllers           [{
///   name
///   verdicts            [{ verdict, flights }]
///   failed, refused     probability
///   undecided           flights of a loop of which nobody can tell whether it is stable at rest
///   requirements        [{ id, measure, unit, required, least, most, not_met: probability, without_value,
///                          not_judged, worst: { run, value } }]
///   measures            [{ name, unit, meaning, count, missing, not_finite, bad: high | low, is_event,
///                          mean, standard_deviation, standard_error, minimum, maximum,
///                          quantiles: [{ share, value, lower, upper,
///                                       from sketches alone: rank_error, at_least, at_most }],
///                          histogram: { edges, counts, below, above },
///                          lowest, highest: [{ run, value }] }]
///   failed_runs         [{ run, severity: diverged | hit the ground | unstable | refused | requirements not met,
///                          diverged_at_s, reasons }]
///   sensitivities       [{ of: failure | measure, measure, used, runs_used, runs,
///                          parameters: [{ parameter,
///                            rank_correlation: { coefficient, interval_95: [lower, upper], pairs },
///                            variance_share: { fraction, uncorrected, standard_error, classes }, p }] }]
/// }]
/// notes                 [{ note, text, … what the note is about }]
///
/// probability           { count, of, estimate, lower, upper, at_most, at_least }
/// ```
#[must_use]
pub fn json(summary: &Summary) -> Value {
    let head = &summary.head;
    let notes = summary.notes.iter();
    let notes = notes.map(|it| NoteView { note: it.name(), text: it.to_string(), about: it });
    let mut json = json!({
        "schema": SCHEMA,
        "campaign": head.campaign,
        "program": head.program,
        "scenario": {
            "name": head.scenario,
            "digest": head.scenario_digest,
            "changes": head.changes,
            "text": head.scenario_text,
        },
        "runs": head.runs,
        "rows": head.rows,
        "seed": head.seed.to_string(),
        "sampling": head.sampling,
        "digest": head.digest.map(|digest| digest.to_string()),
        "confidence": head.confidence,
        "parameters": head.parameters,
        "controllers": summary.controllers,
        "notes": notes.collect::<Vec<_>>(),
    });
    if let (Some(shards), Some(json)) = (head.shards, json.as_object_mut()) {
        json.insert("planned_runs".to_owned(), json!(head.planned_runs));
        json.insert("shards".to_owned(), json!(shards));
    }
    with_null_reasons(json, &NULLS)
}

/// Why keys of the answer are null.
const NULLS: [(&str, &str); 28] = [
    ("digest", "parts were read one by one, or what was read holds none"),
    (
        "at_least",
        "not every flight counts, so that `lower` and `upper` say it, or none was counted",
    ),
    ("at_most", "some flight counts, so that `lower` and `upper` say it, or none was counted"),
    ("estimate", "nothing was counted"),
    ("lower", "no such interval is known of so few flights or values"),
    ("upper", "no such interval is known of so few flights or values"),
    ("least", "the requirement has no such end"),
    ("most", "the requirement has no such end"),
    ("worst", "no flight has a value of it"),
    ("bad", "neither high nor low values of it are bad"),
    ("histogram", "there are no different values of it"),
    ("mean", NO_VALUES),
    ("standard_deviation", NO_VALUES),
    ("standard_error", NO_VALUES),
    ("minimum", NO_VALUES),
    ("maximum", NO_VALUES),
    ("value", NO_VALUES),
    ("measure", "it is about failing, and about no measure"),
    ("diverged_at_s", "the flight did not diverge"),
    ("rank_correlation", NO_SHARE),
    ("variance_share", NO_SHARE),
    ("p", NO_SHARE),
    ("coefficient", NO_SHARE),
    ("fraction", NO_SHARE),
    ("uncorrected", NO_SHARE),
    ("interval_95", NO_SHARE),
    ("id", "the requirement has no name"),
    ("unit", "it has none"),
];

const NO_VALUES: &str = "there are too few values for it, or none";
const NO_SHARE: &str =
    "too few flights have a value, or all have the same one, or the parameter does not vary";

/// A note as a word, in words, and what it is about.
#[derive(Serialize)]
struct NoteView<'a> {
    note: &'static str,
    text: String,
    #[serde(flatten)]
    about: &'a Note,
}

impl Serialize for MeasureSummary {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let view = json!({
            "name": self.name,
            "unit": self.unit,
            "meaning": self.meaning,
            "count": self.count,
            "missing": self.missing,
            "not_finite": self.not_finite,
            "bad": self.bad,
            "is_event": self.is_event,
            "mean": self.moments.map(|moments| moments.mean),
            "standard_deviation": self.moments.and_then(|moments| moments.standard_deviation),
            "standard_error": self.moments.and_then(|moments| moments.standard_error),
            "minimum": self.lowest.first().map(|lowest| lowest.value),
            "maximum": self.highest.first().map(|highest| highest.value),
            "quantiles": self.quantiles,
            "histogram": self.histogram,
            "lowest": self.lowest,
            "highest": self.highest,
        });
        view.serialize(to)
    }
}

impl Serialize for SensitivityTarget {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let view = match self {
            Self::Failure => json!({ "of": "failure", "measure": null }),
            Self::Measure(name) => json!({ "of": "measure", "measure": name }),
        };
        view.serialize(to)
    }
}

impl Serialize for Severity {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name())
    }
}
