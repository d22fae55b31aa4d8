//! All cases of a scenario certified, for whoever asks: the program, the server, Python.

use std::path::Path;

use fspid_scenario::file::{LoadError, Study, Template};
use fspid_sim::SimError;

use super::{Cases, CertifiedCases, Change, NoCases, choices};
use crate::Question;

/// Why the cases of a scenario have no answer.
#[derive(Debug, thiserror::Error)]
pub enum CasesError {
    /// There are none, or too many.
    #[error(transparent)]
    NoCases(#[from] NoCases),
    /// The scenario is wrong as cases make it, or is gone: the name of each, and everything that is wrong.
    #[error("{}", told(.0))]
    Scenario(Vec<(String, LoadError)>),
    /// A plant has no linear model.
    #[error(transparent)]
    Plant(#[from] SimError),
}

fn told(wrong: &[(String, LoadError)]) -> String {
    let each = wrong.iter().map(|(case, reason)| format!("{case}: {reason}"));
    each.collect::<Vec<_>>().join("\n")
}

impl CertifiedCases {
    /// Certifies each case of a scenario. The file is read with what each case sets, then with what is set in all of them, for
    /// all cases before anything is proved; `study` is the scenario as it stands. Tells before each part what is certified, and
    /// at which case.
    ///
    /// # Errors
    /// [`CasesError`]; where the effort was stopped, loops have no answer.
    pub fn answering(
        source: (&Path, &[String]),
        study: &Study,
        which: Cases,
        question: Question<'_>,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, CasesError> {
        if which == Cases::Choices && !question.family {
            choices::all_are_apart(study)?;
        }
        let mut found = Self::new(study, which)?;
        for (change, changed) in read(source, found.changes())? {
            let mut tell = |name: &str| tell(&format!("{name} at {}", change.name));
            found.add(&change, &changed, question, &mut tell)?;
        }
        Ok(found)
    }
}

/// The scenario as each change makes it, or every change that makes none.
fn read(
    (path, overrides): (&Path, &[String]),
    changes: &[Change],
) -> Result<Vec<(Change, Template)>, CasesError> {
    let (mut read, mut wrong) = (Vec::new(), Vec::new());
    for change in changes {
        let all: Vec<String> = change.set.iter().chain(overrides).cloned().collect();
        match Template::load(path, &all) {
            Ok(template) => read.push((change.clone(), template)),
            Err(reason) => wrong.push((change.name.clone(), reason)),
        }
    }
    if wrong.is_empty() { Ok(read) } else { Err(CasesError::Scenario(wrong)) }
}
