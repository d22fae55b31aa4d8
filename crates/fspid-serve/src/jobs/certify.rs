//! Proofs of stability.

use fspid_certify::{
    Cases, CertificateFile, Certification, CertifiedCases, Effort, NotWritable, Question,
};
use fspid_scenario::file::Template;
use fspid_tune::problems_of_certified;
use serde_json::{Value, json};

use super::proof::{stopped_with, stops};
use super::task::{Ended, Task};
use crate::answer::Refusal;
use crate::request::Fields;

/// The options of `fspid certify`.
#[derive(Clone, Debug)]
pub(super) struct Certify {
    pub(super) overrides: Vec<String>,
    controller: Option<String>,
    disturbances: bool,
    family: bool,
    nonlinear: bool,
    cases: Option<Cases>,
    steps: bool,
}

impl Certify {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        let cases = options.text("cases")?.map(|name| Cases::named(&name));
        let found = Self {
            overrides: options.texts("set")?,
            controller: options.text("controller")?,
            disturbances: options.flag("disturbances")?,
            family: options.flag("family")?,
            nonlinear: options.flag("nonlinear")?,
            cases: cases.transpose().map_err(Refusal::wrong)?,
            steps: options.flag("steps")?,
        };
        if found.steps && found.cases.is_none() {
            return Err(Refusal::wrong(
                "`steps` goes with `cases`: without them, steps are asked in any case",
            ));
        }
        Ok(found)
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let asked = self.asked(&task.template)?;
        task.tell("begun", &json!({ "controllers": asked }));
        let each = asked.len() * self.question(&Effort::default()).parts();
        let answer = match self.cases {
            None => self.as_it_stands(task, each),
            Some(which) => self.in_cases(which, task, each),
        };
        // What was stopped has no answer, and its sentence says no more than that.
        if task.is_stopped() { Err(Ended::Cancelled) } else { answer }
    }

    fn as_it_stands(&self, task: &Task<'_>, total: usize) -> Result<Value, Ended> {
        let effort = Effort { stops, ..Effort::default() };
        let (question, mut tell) = (self.question(&effort), telling(task, total));
        let found =
            stopped_with(task, || Certification::answering(&task.template, question, &mut tell));
        let found = found.map_err(Ended::failed)?;
        answer((found.text(), found.json()), found.certificate_files())
    }

    fn in_cases(&self, which: Cases, task: &Task<'_>, each: usize) -> Result<Value, Ended> {
        let study = task.template.study();
        let effort = Effort { stops, long_flights: self.steps, ..Effort::default() };
        let (question, mut tell) =
            (self.question(&effort), telling(task, which.found(study).saturating_mul(each)));
        let source = (task.source.path.as_path(), task.source.overrides.as_slice());
        let found = stopped_with(task, || {
            CertifiedCases::answering(source, study, which, question, &mut tell)
        });
        let found = found
            .map_err(|error| Ended::Failed(error.to_string(), problems_of_certified(&error)))?;
        answer((found.text(), found.json()), found.certificate_files())
    }

    fn question<'a>(&'a self, effort: &'a Effort) -> Question<'a> {
        let Self { disturbances, family, nonlinear, .. } = *self;
        Question { only: self.controller.as_deref(), disturbances, family, nonlinear, effort }
    }

    /// Names of the controllers that are certified.
    fn asked<'a>(&'a self, template: &'a Template) -> Result<Vec<&'a str>, Ended> {
        let controllers = &template.study().scenario.controllers;
        let names: Vec<&str> = controllers.iter().map(|named| named.name.as_str()).collect();
        match self.controller.as_deref() {
            None => Ok(names),
            Some(name) if names.contains(&name) => Ok(vec![name]),
            Some(name) => {
                let known = fspid_diagnostics::known_words(name, &names);
                Err(Ended::failed(format_args!("there is no controller `{name}`{known}")))
            }
        }
    }
}

/// Tells what is certified next, and how much of the whole is done.
fn telling<'a>(task: &'a Task<'_>, total: usize) -> impl FnMut(&str) + 'a {
    let (mut done, total) = (0, total as u64);
    move |what| {
        // A controller whose plant changes is asked some things more than once.
        task.progress(done.min(total), total, &format!("answers; certifying {what}"));
        done += 1;
    }
}

fn answer(
    (text, json): (String, Value),
    files: Result<Vec<CertificateFile>, NotWritable>,
) -> Result<Value, Ended> {
    let file = |it: CertificateFile| json!({ "name": it.name, "text": it.text });
    let certificates: Vec<Value> = files.map_err(Ended::failed)?.into_iter().map(file).collect();
    Ok(json!({ "text": text, "json": json, "certificates": certificates }))
}
