//! Where a scenario comes from.

use std::path::{Path, PathBuf};

use fspid_scenario::file::{Study, Template};
use fspid_scenario::tuning::Case;

use crate::error::{TuneError, WrongCase};

/// A scenario file with changes from outside.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path of the scenario.
    pub path: PathBuf,
    /// Changes, as `--set` takes them.
    pub overrides: Vec<String>,
}

impl Source {
    /// Reads the scenario.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn template(&self) -> Result<Template, TuneError> {
        Ok(Template::load(&self.path, &self.overrides)?)
    }

    /// Files that the scenario names, with all cases of its tuning and its contest, as they are named there.
    ///
    /// # Errors
    /// Everything that is wrong with it, or with a case.
    pub fn files(&self) -> Result<Vec<String>, TuneError> {
        let template = self.template()?;
        let study = template.study();
        let mut files = study.files.clone();
        for case in cases(study) {
            files.extend(self.case(case)?.study().files.iter().cloned());
        }
        files.sort_unstable();
        files.dedup();
        Ok(files)
    }

    /// Reads the scenario with the changes of a case.
    pub(crate) fn case(&self, case: &Case) -> Result<Template, TuneError> {
        let mut overrides = self.overrides.clone();
        overrides.extend(case.set.iter().cloned());
        Template::load(&self.path, &overrides).map_err(|problems| {
            let case = case.name.clone();
            TuneError::Case(Box::new(WrongCase { case, problems }))
        })
    }
}

/// Cases that a scenario is tuned on, and those that it is judged by.
pub(crate) fn cases(study: &Study) -> impl Iterator<Item = &Case> {
    let tuned = study.tuning.iter().flat_map(|tuning| &tuning.cases);
    tuned.chain(study.contest.iter().flat_map(|contest| &contest.cases))
}

/// The folder that paths in a scenario are relative to.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}
