//! All cases of a scenario certified, for whoever asks: the program, the server, Python.

use std::path::Path;

use fspid_scenario::file::{LoadError, Study, Template};
use fspid_sim::SimError;

use super::{Cases, CertifiedCases, NoCases};
use crate::certify::Question;

/// Why the cases of a scenario have no answer.
#[derive(Debug, thiserror::Error)]
pub enum CasesError {
    /// There are none, or too many.
    #[error(transparent)]
    NoCases(#[from] NoCases),
    /// The scenario is wrong as a case makes it, or is gone.
    #[error("{case}: {reason}")]
    Scenario {
        /// Name of the case.
        case: String,
        /// Everything that is wrong.
        reason: LoadError,
    },
    /// A plant has no linear model.
    #[error(transparent)]
    Plant(#[from] SimError),
}

impl CertifiedCases {
    /// Certifies each case of a scenario. The file is read with what each case sets, then with what is set in all of them;
    /// `study` is the scenario as it stands. Tells before each part what is certified, and at which case.
    ///
    /// # Errors
    /// [`CasesError`]; where the effort was stopped, loops have no answer.
    pub fn answering(
        (path, overrides): (&Path, &[String]),
        study: &Study,
        which: Cases,
        question: Question<'_>,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, CasesError> {
        let mut found = Self::new(study, which)?;
        for change in found.changes().to_vec() {
            let all: Vec<String> = change.set.iter().chain(overrides).cloned().collect();
            let read = Template::load(path, &all);
            let case = || change.name.clone();
            let changed = read.map_err(|reason| CasesError::Scenario { case: case(), reason })?;
            let mut tell = |name: &str| tell(&format!("{name} at {}", change.name));
            found.add(&change, &changed, question, &mut tell)?;
        }
        Ok(found)
    }
}
