//! Lua 5.3: a module, a script that asks it for the answers to vectors, and one that runs it on ArduPilot.

use fspid_numeric::Real;

use super::{Source, Written};
use crate::file::File;
use crate::write;

const NO_SCRIPT: &str =
    "no script for ArduPilot: it counts milliseconds, and the period is no whole number of them";

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Written {
    let Source { program, prefix, heading, vectors, .. } = source;
    let mut files = vec![
        File::text(format!("{prefix}.lua"), write::lua(program, heading)),
        File::text(format!("{prefix}_check.lua"), write::lua_harness(program, prefix, vectors)),
    ];
    let mut notes = Vec::new();
    // A fuzzy system alone moves no servo.
    if heading.angles.is_some() {
        match write::ardupilot(program, prefix, heading) {
            Some(text) => files.push(File::text(format!("{prefix}_ardupilot.lua"), text)),
            None => notes.push(NO_SCRIPT.to_owned()),
        }
    }
    Written { files, notes }
}
