//! The supervisor of a scenario's self-tuning controller as a system.

use std::path::Path;

use fspid_fuzzy::system::Parts;
use fspid_sim::Controller;

use crate::file::{self, Study};
use crate::supervisor::Refused;
use crate::system_text::{LoadError, Loaded, built};

/// The supervisor of the controller of this name, or of the only one that has any.
///
/// What stands between the flight and the supervisor (factors, centres of sets, the dead zone) is not part of it.
pub(super) fn read(path: &Path, text: &str, name: Option<&str>) -> Result<Loaded, LoadError> {
    let shown = path.display().to_string();
    let study = file::parse(text, &shown, path.parent(), &[]).map_err(LoadError::Problems)?;
    of_study(&study, &shown, name)
}

/// The same of a scenario that was read, called `shown` in messages.
///
/// # Errors
/// [`LoadError::Refused`] where no controller, or none of that name, has a supervisor.
pub fn of_study(study: &Study, shown: &str, name: Option<&str>) -> Result<Loaded, LoadError> {
    let tuned = study.scenario.controllers.iter().filter_map(|named| match &named.controller {
        Controller::SelfTuning(fspid) => Some((named.name.as_str(), fspid.tuner())),
        Controller::Fixed(_) => None,
    });
    let all: Vec<_> = tuned.collect();
    let meant: Vec<_> = all.iter().filter(|(it, _)| name.is_none_or(|name| name == *it)).collect();
    let &[(name, tuner)] = meant.as_slice() else {
        let known: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        let told = match (all.is_empty(), name) {
            (true, _) => format!("{shown}: no controller has a supervisor"),
            (_, Some(name)) => {
                format!("--controller {name}: those with a supervisor are {}", known.join(", "))
            }
            (_, None) => format!(
                "{shown} has several supervisors; --controller says which: {}",
                known.join(", ")
            ),
        };
        return Err(LoadError::Refused(Refused::one(told)));
    };
    let mut parts = Parts::try_from(tuner.supervisor())
        .map_err(|error| LoadError::Refused(Refused::one(format!("{name}: {error}"))))?;
    parts.name = (*name).to_owned();
    let mut notes = Vec::new();
    if !tuner.settings().input_sets.are_even() {
        notes.push(format!(
            "{name}: its sets are uneven; the system has even sets, and its inputs are to be moved onto them"
        ));
    }
    Ok(Loaded { system: built(parts)?, notes })
}
