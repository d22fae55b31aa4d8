//! C99: a header, a source, and a program that asks them for the answers to vectors.

use fspid_numeric::Real;

use super::{File, Source};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors, .. } = source;
    let written = write::c(program, prefix, heading);
    let mut files = vec![
        File::text(format!("{prefix}.h"), written.header),
        File::text(format!("{prefix}.c"), written.source),
        File::text(format!("{prefix}_check.c"), write::c_harness(program, prefix, vectors)),
        File::text("CMakeLists.txt", write::cmake(prefix)),
        File::text("library.json", write::platformio(prefix)),
    ];
    if let Some(sketch) = write::sketch(program, prefix, heading) {
        files.push(File::text(format!("arduino/{prefix}_sketch/{prefix}_sketch.ino"), sketch));
    }
    files
}
