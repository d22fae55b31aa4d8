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

/// A path as commands on pages name it: as it was given, from the folder in which it was given. Of one from the root the
/// name alone stands there: pages are handed on, and such folders are of one machine.
pub(crate) fn in_commands(path: &Path) -> String {
    let shown = match path.is_relative() {
        true => path.as_os_str(),
        false => path.file_name().unwrap_or_default(),
    };
    shown.to_string_lossy().into_owned()
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

#[cfg(test)]
mod tests {
    use super::*;

    /// `fspid contest light-steps.toml` was told of `data/designs/learned/light-steps.toml`.
    #[test]
    fn a_path_in_a_command_is_the_one_that_was_given_and_no_folder_of_a_machine() {
        let shown = |path: &str| in_commands(Path::new(path));
        assert_eq!(shown("data/designs/light.toml"), "data/designs/light.toml");
        assert_eq!(shown("../light.toml"), "../light.toml");
        assert_eq!(shown("light.toml"), "light.toml");
        let absolute = std::env::temp_dir().join("folder").join("light.toml");
        assert_eq!(in_commands(&absolute), "light.toml");
    }
}
