//! Controllers that are programs of their own.

use std::path::PathBuf;

use fspid_sim::external::{Contents, Place, Renamed};
use fspid_sim::{External, ExternalSource, NamedExternal, Timing};

use super::flown::Flown;
use super::{control_law, period_s};

use crate::file::files::Files;
use crate::file::spec::controller as keys;
use crate::keyed::{Key, Section};
use fspid_diagnostics::Report;

/// The external controller of a sound section.
pub(super) fn external(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (flown, timing, has_autopilot): (Option<&Flown>, Option<Timing>, bool),
) -> Option<NamedExternal> {
    let name = section.get(keys::NAME)?.to_owned();
    let dt_s = period_s(timing);
    if section.given(keys::CONTROL_LAW) {
        let source = control_law::law(report, files, section, (flown?, timing?, has_autopilot))?;
        let (contents, renamed) = (None, Vec::new());
        let answer_limit_s = section.get(keys::ANSWER_LIMIT_S)?;
        let external = External { source, contents, answer_limit_s, dt_s, renamed };
        return Some(NamedExternal { name, external });
    }
    let (key, of): (_, fn(PathBuf) -> _) = match section.given(keys::FMU) {
        true => (keys::FMU, ExternalSource::Fmu),
        false => (keys::LIBRARY, ExternalSource::Library),
    };
    let (path, bytes) = match files.program(section.get(key)?) {
        Ok(found) => found,
        Err(reason) => {
            let message = format!("cannot be read: {reason}");
            let allowed = "a shared library or an FMU, its path relative to the scenario's folder";
            section.wrong(report, key, message, allowed);
            return None;
        }
    };
    let answer_limit_s = section.get(keys::ANSWER_LIMIT_S)?;
    let inputs = section.get(keys::INPUTS).map(|inputs| (inputs, &keys::FMU_INPUTS[..]));
    let outputs = section.get(keys::OUTPUTS).map(|outputs| (outputs, OUTPUTS));
    let mut renamed = Vec::new();
    for (section, rows) in inputs.into_iter().chain(outputs) {
        for keys in rows {
            renamed.extend(called(report, section, keys)?);
        }
    }
    let (source, contents) = (of(path), Some(Contents(bytes)));
    let external = External { source, contents, answer_limit_s, dt_s, renamed };
    Some(NamedExternal { name, external })
}

const OUTPUTS: &[[Key<str>; 2]] = &[keys::FMU_OUTPUTS];

/// The variable in a place, in radians or in degrees; nothing where both are given, which is a problem.
pub(super) fn called(
    report: &mut Report,
    section: &Section,
    [in_radians, in_degrees]: &[Key<str>; 2],
) -> Option<Option<Renamed>> {
    let given = [in_radians, in_degrees].map(|key| section.get(*key).map(|name| (key, name)));
    let (key, name) = match given {
        [None, None] => return Some(None),
        [Some(_), Some(_)] => {
            let message = format!("is given beside {}", in_radians.name.as_str());
            section.wrong(report, *in_degrees, message, "one of both");
            return None;
        }
        [Some(found), None] | [None, Some(found)] => found,
    };
    let (place, in_degrees) = Place::of_key(key.name.as_str())?;
    Some(Some(Renamed { place, in_degrees, name: name.to_owned() }))
}
