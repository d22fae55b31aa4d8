//! C99: a header, a source, and a program that asks them for the answers to vectors.

use fspid_numeric::Real;

use super::{File, Source};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors, .. } = source;
    let written = write::c(program, prefix, heading);
    vec![
        File::text(format!("{prefix}.h"), written.header),
        File::text(format!("{prefix}.c"), written.source),
        File::text(format!("{prefix}_check.c"), write::c_harness(program, prefix, vectors)),
    ]
}
