//! Lua 5.3: a module, and a script that asks it for the answers to vectors.

use fspid_numeric::Real;

use super::{File, Source};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors, .. } = source;
    vec![
        File::text(format!("{prefix}.lua"), write::lua(program, heading)),
        File::text(format!("{prefix}_check.lua"), write::lua_harness(program, prefix, vectors)),
    ]
}
