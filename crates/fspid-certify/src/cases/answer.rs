//! Certified cases in words and for programs.

use fspid_proof::{LeftOut, Verdict};
use serde_json::{Value, json};

use super::{CertifiedCase, CertifiedCases};
use crate::json::NULLS;
use crate::scope::{NOT_IN_CLAIM, range_in_words};
use crate::text::{Headline, Line, found, push_lines, sentence};
use crate::{Certified, DisturbanceAnswer, family};
use fspid_study::json::{merged, present, with_null_reasons};

impl CertifiedCases {
    /// The answer of `certify --cases --format text`: a line for each loop, and what all of them amount to.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!(
            "{}: stability while the gains move, at {} {}\n",
            self.scenario,
            self.changes.len(),
            self.which.words()
        );
        for case in &self.cases {
            out.push_str(&format!("\n{}\n", case.change.name));
            for certified in &case.certification.results {
                out.push_str(&line(certified));
            }
            if case.has_nobody() {
                out.push_str(&format!("  {NOBODY}\n"));
            }
        }
        out.push('\n');
        for name in self.controllers() {
            let Headline { word, detail } = self.verdict(name);
            out.push_str(&format!("{name}: {word} {detail}\n"));
            push_lines(&mut out, self.in_every_case_in_words(name));
        }
        push_lines(&mut out, self.left_out().into_iter().map(|it| (NOT_IN_CLAIM, it.to_string())));
        out
    }

    /// What some claim of stability does not speak of, each once.
    pub(super) fn left_out(&self) -> Vec<LeftOut> {
        let results = self.cases.iter().flat_map(|case| &case.certification.results);
        let claims = results.filter_map(|it| found(it.outcome.as_ref().ok()?));
        let stable = claims.filter(|(certificate, _)| certificate.claim.is_of_stability());
        let mut all: Vec<LeftOut> = stable
            .flat_map(|(certificate, rechecked)| certificate.scope(rechecked).left_out)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// What all of them amount to for a controller.
    pub(super) fn verdict(&self, controller: &str) -> Headline {
        let not_proved: Vec<&str> = self.not_proved(controller).collect();
        let (count, words) = (self.cases.len(), self.which.words());
        let (word, detail) = match not_proved.len() {
            0 => ("PROVED", format!("at all {count} {words}")),
            missing => {
                let names = not_proved.join("; ");
                ("NOT PROVED", format!("at {missing} of {count} {words}: {names}"))
            }
        };
        Headline { word: word.to_owned(), detail }
    }

    /// What of all that was asked beside stability holds in every case of a controller; empty where nothing was.
    pub(super) fn in_every_case_in_words(&self, controller: &str) -> Vec<Line> {
        let disturbed = self.disturbed_in_words(controller).into_iter();
        let near_trim = self.near_trim_in_words(controller).into_iter();
        let disturbed = disturbed.map(|it| ("disturbances", it));
        disturbed.chain(near_trim.map(|it| ("nonlinear", it))).collect()
    }

    /// Names of the controllers, each once.
    pub(super) fn controllers(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for certified in self.cases.iter().flat_map(|case| &case.certification.results) {
            if !names.contains(&certified.controller.as_str()) {
                names.push(&certified.controller);
            }
        }
        names
    }

    /// Names of the cases at which a loop of a controller is not proved, or which have no such controller.
    pub(super) fn not_proved<'a>(&'a self, controller: &'a str) -> impl Iterator<Item = &'a str> {
        let is_missing = move |case: &&CertifiedCase| {
            let results = case.certification.results.iter();
            let mut own = results.filter(|it| it.controller == controller).peekable();
            own.peek().is_none() || own.any(|it| !it.is_proved())
        };
        self.cases.iter().filter(is_missing).map(|case| case.change.name.as_str())
    }

    /// The answer of `certify --cases --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut null = serde_json::Map::new();
        let mut schema = Value::Null;
        let cases = self.cases.iter().map(|case| {
            let mut answer = case.certification.json();
            if let Some(reasons) = answer.get("null").and_then(Value::as_object) {
                null.extend(reasons.clone());
            }
            schema = answer["schema"].take();
            json!({
                "name": case.change.name,
                "set": case.change.set,
                "controllers": answer["controllers"].take(),
            })
        });
        let cases: Vec<Value> = cases.collect();
        let answer = json!({
            "schema": schema,
            "scenario": self.scenario,
            "of": self.which.words(),
            "all_proved": self.all_proved(),
            "cases": cases,
        });
        let mut everywhere = with_null_reasons(self.in_every_case(), &NULLS);
        if let Some(Value::Object(reasons)) = everywhere.get_mut("null").map(Value::take) {
            null.extend(reasons);
        }
        let reasons = (!null.is_empty()).then_some(null);
        merged([answer, everywhere, present(json!({ "null": reasons }))])
    }

    /// What of all that was asked beside stability holds in every case of each controller; empty where nothing was.
    fn in_every_case(&self) -> Value {
        let each = self.controllers().into_iter().map(|name| {
            let of = json!({ "name": name });
            merged([of, self.disturbed_in_json(name), self.near_trim_in_json(name)])
        });
        let each: Vec<Value> = each.collect();
        let has_more = |it: &Value| it.as_object().is_some_and(|keys| keys.len() > 1);
        let told = each.iter().any(has_more).then_some(each);
        present(json!({ "in_every_case": told }))
    }
}

/// One loop in a line.
fn line(certified: &Certified) -> String {
    let mut out = format!("  {}: {}\n", certified.name(), told(certified));
    for (about, sentence) in beside(certified) {
        out.push_str(&format!("    {about} {sentence}\n"));
    }
    out
}

/// What is said of a case without a controller that was asked for.
pub(super) const NOBODY: &str = "the controller that is asked is not among those of this case";

impl CertifiedCase {
    pub(super) fn has_nobody(&self) -> bool {
        self.certification.results.is_empty()
    }
}

/// The verdict on a loop, and what it is about.
pub(super) fn told(certified: &Certified) -> String {
    match &certified.outcome {
        Err(reason) => format!("NOT PROVABLE: {reason}"),
        Ok(outcome) => {
            let claimed = found(outcome).map(|(certificate, rechecked)| {
                let range = range_in_words(&certificate.scope(rechecked));
                format!("{}; {range}", sentence(certificate))
            });
            let because = outcome.open_because.as_ref().map(|it| format!(": {it}"));
            let claimed = claimed.unwrap_or_else(|| "neither proved nor refuted".to_owned());
            match outcome.verdict {
                Verdict::Proved(..) if certified.is_proved() => format!("PROVED: {claimed}"),
                Verdict::Proved(..) => {
                    format!("NOT PROVED as a whole; the loop as it is: {claimed}")
                }
                Verdict::Refuted(..) => format!("REFUTED: {claimed}"),
                Verdict::Open => format!("OPEN{}; {claimed}", because.unwrap_or_default()),
            }
        }
    }
}

/// What came of all that is asked beside stability, behind what it is about.
fn beside(certified: &Certified) -> Vec<Line> {
    let trouble = certified.disturbances.as_ref().and_then(DisturbanceAnswer::trouble);
    let trouble = trouble.map(|reason| ("disturbances", format!("NOT BOUNDED: {reason}")));
    let nonlinear = certified.nonlinear.as_ref();
    let nonlinear = nonlinear.map(|it| ("nonlinear aircraft", it.in_short()));
    let family = certified.family.as_ref();
    let family = family.map(|it| ("all that is drawn:", family::in_words(it)));
    [trouble, nonlinear, family].into_iter().flatten().collect()
}
