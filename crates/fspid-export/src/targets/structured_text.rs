//! Structured Text: a function block, and a program that asks it for the answers to vectors.

use fspid_numeric::Real;

use super::{File, Source};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors, .. } = source;
    let samples: Vec<Vec<R>> = vectors.iter().map(|vector| vector.sample.clone()).collect();
    vec![
        File::text(format!("{prefix}.st"), write::structured_text(program, prefix, heading)),
        File::text(
            format!("{prefix}_check.st"),
            write::structured_text_check(program, prefix, heading, &samples),
        ),
    ]
}
