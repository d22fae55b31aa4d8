//! A functional mock-up unit: an archive with the description, the sources and a library for this machine.

use fspid_numeric::Real;

use super::{Source, Written};
use crate::compile::shared_library;
use crate::compose::{Refusal, observed};
use crate::file::File;
use crate::write::fmu::{Fmu, Parts, Version, parts};
use crate::zip::archive;

/// The archive; what was left out of it is told.
pub(super) fn files<R: Real>(source: &Source<'_, R>, version: Version) -> Result<Written, Refusal> {
    let Source { program, prefix, heading, flown, .. } = source;
    let is_system = flown.is_none();
    let program = match is_system {
        true => (*program).clone(),
        false => observed((*program).clone()),
    };
    let period_s = flown.as_ref().map(|flown| flown.period_s);
    let Parts { mut texts, to_compile, sources } =
        parts(&Fmu { program: &program, prefix, heading, version, period_s });
    let note = match library(&to_compile, &sources, version) {
        Ok((platform, bytes)) => {
            let ending = std::env::consts::DLL_SUFFIX;
            texts.push(File { name: format!("binaries/{platform}/{prefix}{ending}"), bytes });
            format!("the FMU holds its sources and a library for {platform}")
        }
        Err(reason) => format!("the FMU holds its sources only: {reason}"),
    };
    let files = vec![File { name: format!("{prefix}.fmu"), bytes: archive(&texts) }];
    Ok(Written { files, notes: vec![note] })
}

/// The folder of this machine's libraries, and one.
fn library(
    files: &[File],
    sources: &[String],
    version: Version,
) -> Result<(String, Vec<u8>), String> {
    if cfg!(target_family = "wasm") {
        return Err("a page has no compiler".to_owned());
    }
    let platform = version.platform().ok_or("FMI has no name for this machine")?;
    Ok((platform, shared_library(files, sources)?))
}
