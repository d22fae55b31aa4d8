//! Proofs of stability.

use std::cell::RefCell;

use fspid_scenario::file::Template;
use fspid_study::certify::{self, Certification, Effort, Question};
use serde_json::{Value, json};

use super::task::{Ended, Stopping, Task};
use crate::answer::Refusal;
use crate::request::Fields;

thread_local! {
    /// The job that this thread works on. A search for a proof asks a plain function whether it shall stop, and stays on the
    /// thread that it began on.
    static STOPPING: RefCell<Option<Stopping>> = const { RefCell::new(None) };
}

fn stops() -> bool {
    STOPPING.with_borrow(|stopping| stopping.as_ref().is_some_and(Stopping::is_asked))
}

/// The options of `fspid certify`.
#[derive(Clone, Debug)]
pub(super) struct Certify {
    pub(super) overrides: Vec<String>,
    controller: Option<String>,
    disturbances: bool,
    family: bool,
    nonlinear: bool,
}

impl Certify {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        Ok(Self {
            overrides: options.texts("set")?,
            controller: options.text("controller")?,
            disturbances: options.flag("disturbances")?,
            family: options.flag("family")?,
            nonlinear: options.flag("nonlinear")?,
        })
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let template = &task.template;
        let effort = Effort { stops, ..Effort::default() };
        let question = self.question(&effort);
        let asked = self.asked(template)?;
        let total = (asked.len() * question.parts()) as u64;
        task.tell("begun", &json!({ "controllers": asked }));
        let mut done = 0;
        let mut tell = |what: &str| {
            // A controller whose plant changes is asked some things more than once.
            task.progress(done.min(total), total, &format!("answers; certifying {what}"));
            done += 1;
        };
        STOPPING.replace(Some(task.stopping.clone()));
        let certification = Certification::answering(template, question, &mut tell);
        STOPPING.replace(None);
        let certification = certification.map_err(Ended::failed)?;
        if task.is_stopped() {
            return Err(Ended::Cancelled);
        }
        let (text, json) = (certification.text(), certification.json());
        Ok(json!({ "text": text, "json": json, "certificates": certificates(&certification) }))
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

/// Every certificate with the name of its file.
fn certificates(certification: &Certification) -> Vec<Value> {
    let files = certification.results.iter().filter_map(|certified| {
        let text = certify::to_text(certified.certificate()?, &certified.origin);
        Some(json!({ "name": certification.file_name(certified), "text": text }))
    });
    files.collect()
}
