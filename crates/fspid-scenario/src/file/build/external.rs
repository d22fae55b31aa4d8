//! Controllers that are programs of their own.

use std::path::PathBuf;

use fspid_sim::external::Contents;
use fspid_sim::{External, ExternalSource, NamedExternal};

use crate::file::files::Files;
use crate::file::spec::controller as keys;
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// The external controller of a sound section.
pub(super) fn external(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    dt_s: f64,
) -> Option<NamedExternal> {
    let name = section.get(keys::NAME)?.to_owned();
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
    let (source, contents) = (of(path), Some(Contents(bytes)));
    let external = External { source, contents, answer_limit_s, dt_s };
    Some(NamedExternal { name, external })
}
