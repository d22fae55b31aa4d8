//! Certificates proved anew.

use fspid_certify::check_text_until;
use serde_json::{Value, json};

use super::proof::{stopped_with, stops};
use super::task::{Ended, Task};
use crate::answer::Refusal;
use crate::request::Fields;
use crate::scenarios::digest;

/// The options of `fspid certify --check`, against the scenario of the job.
#[derive(Clone, Debug)]
pub(super) struct Check {
    pub(super) overrides: Vec<String>,
    certificate: String,
}

impl Check {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        Ok(Self {
            overrides: options.texts("set")?,
            certificate: options.needed_text("certificate")?,
        })
    }

    /// The options as the list of jobs tells them: which certificate, and not all of it for each job each time.
    pub(super) fn told(&self) -> Value {
        let mut told = json!({ "certificate_digest": digest(self.certificate.as_bytes()) });
        if !self.overrides.is_empty() {
            told["set"] = json!(self.overrides);
        }
        told
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        task.tell("begun", &json!({}));
        let checked = stopped_with(task, || check_text_until(&self.certificate, stops));
        if task.is_stopped() {
            return Err(Ended::Cancelled);
        }
        let mut checked = checked.map_err(Ended::failed)?;
        checked.compare_family(&task.template).map_err(Ended::failed)?;
        Ok(json!({ "text": checked.text(), "json": checked.json(), "holds": checked.holds() }))
    }
}
