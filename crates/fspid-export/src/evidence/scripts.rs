//! Scripts that make what needs compilers and other tools.

use fspid_numeric::Real;

use super::{Subject, proof};
use crate::file::File;

pub(super) fn files<R: Real>(subject: &Subject<'_, R>) -> Vec<File> {
    let has_exponential = subject.program.function("exponential").is_some();
    let specified = if has_exponential {
        format!("-eva-use-spec {}_exponential", subject.prefix)
    } else {
        String::new()
    };
    let filled = |text: &str| {
        text.replace("@PREFIX@", subject.prefix)
            .replace("@SPECIFIED@", &specified)
            .replace("@SETPOINT@", &sample(subject, 0))
            .replace("@MEASUREMENT@", &sample(subject, 1))
            .replace("@COUNT@", &subject.vectors.len().to_string())
            // It stands between single quotation marks.
            .replace("@FIRST@", &proof::first_line(subject).replace('\'', "'\\''"))
    };
    vec![
        File::text("make-evidence.sh", filled(include_str!("scripts/make-evidence.sh"))),
        File::text("mutate.sh", filled(include_str!("scripts/mutate.sh"))),
        File::text("boards.c", filled(include_str!("scripts/boards.c"))),
        File::text("start.c", include_str!("scripts/start.c").to_owned()),
    ]
}

fn sample<R: Real>(subject: &Subject<'_, R>, place: usize) -> String {
    let members = subject.program.members(crate::program::Part::Sample);
    members.get(place).map_or_else(String::new, |member| member.name.clone())
}
