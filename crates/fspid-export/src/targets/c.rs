//! C99: a header, a source, a program that asks them for the answers to vectors, and what lets fspid fly them.

use fspid_numeric::Real;

use super::Source;
use crate::file::File;
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Vec<File> {
    let Source { program, prefix, heading, vectors, flown } = source;
    let written = write::c(program, prefix, heading);
    let mut files = vec![
        File::text(format!("{prefix}.h"), written.header),
        File::text(format!("{prefix}.c"), written.source),
        File::text(format!("{prefix}_check.c"), write::c_harness(program, prefix, vectors)),
        File::text("CMakeLists.txt", write::cmake(prefix)),
        File::text("library.json", write::platformio(prefix, program.precision)),
    ];
    if let Some(sketch) = write::sketch(program, prefix, heading) {
        files.push(File::text(format!("arduino/{prefix}_sketch/{prefix}_sketch.ino"), sketch));
    }
    if let Some(flown) = flown {
        let selftest = write::c_selftest(program, flown.controller, prefix, heading);
        files.push(File::text(format!("{prefix}_selftest.c"), selftest));
        let period_s = flown.controller.config().dt_s.to_f64();
        let adapter = write::c_external(program, prefix, period_s, heading);
        files.extend([
            File::text("external/fspid_external.h", write::EXTERNAL_HEADER.to_owned()),
            File::text(format!("external/{prefix}_external.c"), adapter),
        ]);
    }
    files
}
