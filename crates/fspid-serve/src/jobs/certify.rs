//! Proofs of stability.

use std::cell::RefCell;

use fspid_study::certify::{self, Certification, Effort};
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
}

impl Certify {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        Ok(Self { overrides: options.texts("set")?, controller: options.text("controller")? })
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let (study, only) = (&task.study, self.controller.as_deref());
        let names: Vec<&str> =
            study.scenario.controllers.iter().map(|named| named.name.as_str()).collect();
        if let Some(name) = only.filter(|name| !names.contains(name)) {
            let known = fspid_diagnostics::known_words(name, &names);
            return Err(Ended::failed(format_args!("there is no controller `{name}`{known}")));
        }
        let asked = only.map_or(names, |name| vec![name]);
        let total = asked.len() as u64;
        task.tell("begun", &json!({ "controllers": asked }));
        let mut done = 0;
        let mut tell = |name: &str| {
            task.progress(done, total, &format!("controllers; certifying {name}"));
            done += 1;
        };
        STOPPING.replace(Some(task.stopping.clone()));
        let effort = Effort { stops, ..Effort::default() };
        let certification = Certification::watched(study, only, &effort, &mut tell);
        STOPPING.replace(None);
        let certification = certification.map_err(Ended::failed)?;
        if task.is_stopped() {
            return Err(Ended::Cancelled);
        }
        let files: Vec<Value> = certification
            .results
            .iter()
            .filter_map(|certified| {
                let text = certify::to_text(certified.certificate()?, &certified.origin);
                Some(json!({ "name": certification.file_name(certified), "text": text }))
            })
            .collect();
        let (text, json) = (certification.text(), certification.json());
        Ok(json!({ "text": text, "json": json, "certificates": files }))
    }
}
