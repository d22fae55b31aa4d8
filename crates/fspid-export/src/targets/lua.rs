//! Lua 5.3: a module, a script that asks it for the answers to vectors, and one that runs it on ArduPilot.

use fspid_numeric::Real;

use super::{File, Source};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors } = source;
    let mut files = vec![
        File::text(format!("{prefix}.lua"), write::lua(program, heading)),
        File::text(format!("{prefix}_check.lua"), write::lua_harness(program, prefix, vectors)),
    ];
    let script = write::ardupilot(program, prefix, heading);
    files.extend(script.map(|text| File::text(format!("{prefix}_ardupilot.lua"), text)));
    files
}

pub(super) fn notes<R: Real>(source: &Source<'_, R>) -> Vec<String> {
    match write::ardupilot(source.program, source.prefix, source.heading) {
        Some(_) => Vec::new(),
        None => vec![NO_SCRIPT.to_owned()],
    }
}

const NO_SCRIPT: &str =
    "no script for ArduPilot: it counts milliseconds, and the period is no whole number of them";
