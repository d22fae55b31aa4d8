//! Structured Text: a function block, and a program that asks it for the answers to vectors.

use fspid_numeric::Real;

use super::{Source, Written};
use crate::file::File;
use crate::vectors::{SEED, telling};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Written {
    let Source { program, prefix, heading, vectors, .. } = source;
    let stretches = match (&source.flown, heading.angles) {
        (Some(flown), Some(angles)) => {
            let most = write::MOST_SAMPLES.min(vectors.len());
            telling(flown.controller, program, (angles, SEED), most)
        }
        _ => vec![vectors.iter().map(|vector| vector.sample.clone()).collect()],
    };
    let files = vec![
        File::text(format!("{prefix}.st"), write::structured_text(program, prefix, heading)),
        File::text(
            format!("{prefix}_check.st"),
            write::structured_text_check(program, prefix, heading, &stretches),
        ),
    ];
    let notes = vec![format!(
        "the function block is FB_{prefix}, the program that checks it PRG_{prefix}_check"
    )];
    Written { files, notes }
}
