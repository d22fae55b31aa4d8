//! Data for a review of an export in C: what each part of the design is in the code, and which vector fails without it.
//!
//! Nothing here qualifies anything. Every change of the program that [`mutants`] lists is run by the interpreter against
//! the vectors; the same changes are written as lines of the C, so that a script does it with a compiler too.

mod mutants;
mod pack;
mod proof;
mod run;
mod scripts;

use std::collections::BTreeMap;

use fspid_core::Controller;
use fspid_numeric::Real;

use crate::program::Program;
use crate::targets::File;
use crate::vectors::Vector;
use crate::write::{self, Heading};
use mutants::Mutant;

/// What the evidence is about.
pub(crate) struct Subject<'a, R> {
    pub(crate) program: &'a Program,
    pub(crate) controller: &'a Controller<R>,
    pub(crate) prefix: &'a str,
    pub(crate) heading: &'a Heading<'a>,
    pub(crate) vectors: &'a [Vector<R>],
    /// The files of the export.
    pub(crate) code: &'a [File],
}

/// A change of the program, and what found it.
struct Finding {
    mutant: Mutant,
    /// Lines of the source that it changes, from 1, with what they then say.
    lines: Vec<(usize, String)>,
    /// The first vector with another answer, from 1.
    vector: Option<usize>,
}

/// So many vectors, the directed ones and the first of those that are drawn, are asked for each change; the script asks
/// for all. More take longer and were not seen to find more.
pub(super) const ASKED: usize = 6000;

/// The files of a pack.
pub(crate) fn files<R: Real>(subject: &Subject<'_, R>) -> Vec<File> {
    let base = run::run(subject.program, subject.vectors);
    let findings = findings(subject);
    let mut files: Vec<File> = subject
        .code
        .iter()
        .map(|file| File { name: format!("code/{}", file.name), bytes: file.bytes.clone() })
        .collect();
    files.extend(pack::tables(&findings));
    files.push(File::text("coverage.csv", pack::coverage(subject, &base.branches)));
    files.extend(proof::files(subject));
    files.extend(scripts::files(subject));
    files.push(File::text("README.md", pack::front(subject, &findings, &base)));
    files
}

/// Every change, asked for on all processors.
fn findings<R: Real>(subject: &Subject<'_, R>) -> Vec<Finding> {
    let all = mutants::all(subject.program);
    let text = |program: &Program| write::c(program, subject.prefix, subject.heading).source;
    let original = text(subject.program);
    let count = std::thread::available_parallelism().map_or(1, usize::from);
    let asked = &subject.vectors[..subject.vectors.len().min(ASKED)];
    let answered = |mutant: &Mutant| {
        let program = mutant.of(subject.program);
        let changed = text(&program);
        let lines = original.lines().zip(changed.lines()).zip(1..);
        let lines = lines.filter(|((before, after), _)| before != after);
        let lines = lines.map(|((_, after), line)| (line, after.to_owned())).collect();
        let vector = run::first_different(&program, asked);
        Finding { mutant: mutant.clone(), lines, vector }
    };
    let mut findings = BTreeMap::new();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..count)
            .map(|first| {
                let (all, answered) = (&all, &answered);
                scope.spawn(move || {
                    let own = all.iter().enumerate().skip(first).step_by(count);
                    own.map(|(index, mutant)| (index, answered(mutant))).collect::<Vec<_>>()
                })
            })
            .collect();
        for thread in threads {
            // A change that is lost would look like one that nobody has made.
            findings.extend(thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    findings.into_values().filter(|finding| !finding.lines.is_empty()).collect()
}
