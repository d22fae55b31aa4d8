//! Simulink: the C with an S-function around it.

use fspid_numeric::Real;

use super::Source;
use crate::compose::Refusal;
use crate::file::File;
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Result<Vec<File>, Refusal> {
    let Source { program, prefix, heading, .. } = source;
    super::matlab::short(prefix)?;
    let written = write::c(program, prefix, heading);
    let flown = source.flown.as_ref().ok_or(Refusal::NoController)?;
    let function = write::simulink(program, prefix, flown.period_s, heading);
    Ok(vec![
        File::text(format!("{prefix}.h"), written.header),
        File::text(format!("{prefix}.c"), written.source),
        File::text(format!("{prefix}_sfun.c"), function),
        File::text("build.m", write::simulink_build(prefix)),
    ])
}
