//! The tables and the first page of a pack.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use fspid_numeric::Real;

use super::equivalent::Judge;
use super::run::Ran;
use super::{Finding, Subject, proof};
use crate::file::File;
use crate::interpret::Branch;
use crate::program::Precision;
use crate::write;

/// A cell of a table.
fn cell(text: &str) -> String {
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

impl Finding {
    fn line(&self) -> usize {
        self.lines.first().map_or(0, |(line, _)| *line)
    }

    /// What is changed: a part of the design by its name, one of the code by its function and line.
    fn name(&self) -> String {
        let Self { mutant, .. } = self;
        if mutant.is_design {
            return mutant.element.clone();
        }
        format!("{}, line {}", mutant.element, self.line())
    }

    fn found(&self) -> String {
        match (self.vector, self.equivalent) {
            (Some(vector), _) => vector.to_string(),
            // The last column has no comma, so that a script finds it.
            (None, Some(why)) => format!("equivalent: {}", why.replace(',', ";")),
            (None, None) => "none".to_owned(),
        }
    }

    /// The same in a word.
    fn vectors(&self) -> String {
        match (self.vector, self.equivalent) {
            (None, Some(_)) => "equivalent".to_owned(),
            _ => self.found(),
        }
    }
}

/// Changes with what found them; elements with lines and vectors; lines and vectors with elements.
pub(super) fn tables(findings: &[Finding]) -> Vec<File> {
    let mut mutants = "number,of,element,change,line,text,vector\n".to_owned();
    let mut trace: BTreeMap<(bool, String), Vec<&Finding>> = BTreeMap::new();
    let mut by_line: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    let mut by_vector: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for (finding, number) in findings.iter().zip(1..) {
        let of = if finding.mutant.is_design { "design" } else { "code" };
        let name = finding.name();
        for (line, text) in &finding.lines {
            let row = [cell(&name), cell(&finding.mutant.change), line.to_string(), cell(text)];
            let _ = writeln!(mutants, "{number},{of},{},{}", row.join(","), finding.found());
            push(by_line.entry(*line).or_default(), &name);
        }
        if let Some(vector) = finding.vector {
            push(by_vector.entry(vector).or_default(), &name);
        }
        trace.entry((!finding.mutant.is_design, name)).or_default().push(finding);
    }
    vec![
        File::text("mutants.csv", mutants),
        File::text("trace.csv", traced(&trace)),
        File::text("lines.csv", reversed("line,elements\n", &by_line)),
        File::text("by-vector.csv", reversed("first vector that fails,elements\n", &by_vector)),
    ]
}

fn push(names: &mut Vec<String>, name: &str) {
    if !names.iter().any(|known| known == name) {
        names.push(name.to_owned());
    }
}

fn traced(trace: &BTreeMap<(bool, String), Vec<&Finding>>) -> String {
    let mut text = "of,element,lines,changes,first vector that fails\n".to_owned();
    for ((is_code, name), findings) in trace {
        let mut lines: Vec<usize> =
            findings.iter().flat_map(|it| it.lines.iter().map(|(line, _)| *line)).collect();
        lines.sort_unstable();
        lines.dedup();
        let lines: Vec<String> = lines.iter().map(usize::to_string).collect();
        let changes: Vec<&str> = findings.iter().map(|it| it.mutant.change.as_str()).collect();
        let vectors: Vec<String> = findings.iter().map(|it| it.vectors()).collect();
        let of = if *is_code { "code" } else { "design" };
        let row = [cell(name), lines.join(" "), cell(&changes.join("; ")), vectors.join(" ")];
        let _ = writeln!(text, "{of},{}", row.join(","));
    }
    text
}

fn reversed(header: &str, rows: &BTreeMap<usize, Vec<String>>) -> String {
    let mut text = header.to_owned();
    for (row, names) in rows {
        let _ = writeln!(text, "{row},{}", cell(&names.join("; ")));
    }
    text
}

/// What is asked where, how often it held and did not, and why it never goes the other way.
pub(super) fn coverage<R: Real>(
    subject: &Subject<'_, R>,
    judge: &Judge<'_>,
    branches: &[Branch],
) -> String {
    let mut text = "function,asked,held,did not,why never the other way\n".to_owned();
    for branch in branches {
        let asked = write::c_expression(subject.program, subject.prefix, &branch.condition);
        let why = match branch.held == 0 || branch.failed == 0 {
            true => judge.one_way(branch).unwrap_or_else(|| "not known".to_owned()),
            false => String::new(),
        };
        let row = [cell(&asked), branch.held.to_string(), branch.failed.to_string(), cell(&why)];
        let _ = writeln!(text, "{},{}", branch.function, row.join(","));
    }
    text
}

/// All of those that satisfy something, found, shown to change nothing, and not told apart.
fn counted(findings: &[Finding], is: impl Fn(&Finding) -> bool) -> [usize; 4] {
    let mut counts = [0; 4];
    for finding in findings.iter().filter(|it| is(it)) {
        let place = match (finding.vector, finding.equivalent) {
            (Some(_), _) => 1,
            (None, Some(_)) => 2,
            (None, None) => 3,
        };
        counts[0] += 1;
        counts[place] += 1;
    }
    counts
}

/// The first page.
pub(super) fn front<R: Real>(
    subject: &Subject<'_, R>,
    judge: &Judge<'_>,
    findings: &[Finding],
    base: &Ran,
) -> String {
    let [all, found, equivalent, left] = counted(findings, |_| true);
    let mut text = proof::first_line(subject);
    let _ = write!(
        text,
        "\n\n{all} single changes: {found} found by a vector, {equivalent} shown to change nothing, {left} not told apart.\n\n\
         # Evidence for {}: data for a review, no qualification\n\n{}\n",
        subject.heading.name.replace('\n', " "),
        about(subject)
    );
    if let Some(elevator) = subject.heading.elevator {
        let _ = writeln!(text, "\n{elevator}");
    }
    let _ = writeln!(text, "\n{}", of_the_loop(subject));
    let _ = write!(
        text,
        "\n## Changes that the vectors find\n\nMeasured here by the interpreter of the program from which the C is \
         written, with the first {} vectors (of {}, {} are answered otherwise by the program itself). `make-evidence.sh` changes the \
         same lines of the C, compiles each and runs it; its count is in `results/`.\n\n| single change of | changes | \
         found | shown to change nothing | not told apart |\n| --- | --- | --- | --- | --- |\n",
        subject.vectors.len().min(super::ASKED),
        subject.vectors.len(),
        base.different
    );
    for (what, is) in KINDS {
        let [all, found, equivalent, left] = counted(findings, is);
        let _ = writeln!(text, "| {what} | {all} | {found} | {equivalent} | {left} |");
    }
    text += &survivors(findings);
    text += &ways(subject, judge, &base.branches);
    text += FILES;
    text
}

/// What is known of the loop, and that nothing else here speaks of it.
fn of_the_loop<R: Real>(subject: &Subject<'_, R>) -> String {
    let known = match subject.its_loop {
        Some(it) => format!("Of the loop of that scenario the program says: {}.", it.words),
        None => "Nobody asked here how its loop stands.".to_owned(),
    };
    format!(
        "## The loop\n\n{known} Everything below says that the code is the design, and nothing of whether the design is good: \
         `fspid verify`, `fspid analyse` and `fspid certify` of the scenario with the SHA-256 above do."
    )
}

type Kind = (&'static str, fn(&Finding) -> bool);

const KINDS: [Kind; 4] = [
    ("a rule", is_rule),
    ("another number of the design", |it| it.mutant.is_design && !is_rule(it)),
    ("a comparison in the code", is_comparison),
    ("anything else in the code", |it| !it.mutant.is_design && !is_comparison(it)),
];

fn is_rule(finding: &Finding) -> bool {
    finding.mutant.is_design && finding.mutant.element.contains(" of ")
}

fn is_comparison(finding: &Finding) -> bool {
    let compares = matches!(finding.mutant.change.as_str(), "<= for <" | "< for <=" | "negated");
    !finding.mutant.is_design && compares
}

fn about<R: Real>(subject: &Subject<'_, R>) -> String {
    let numbers = match subject.program.precision {
        Precision::Single => "32 bits",
        Precision::Double => "64 bits",
    };
    format!(
        "| | |\n| --- | --- |\n| design | SHA-256 {} |\n| written by | fspid {} |\n| options | target c, numbers of {}, \
         angles in {}, {} vectors |\n| licence of the code | MIT or Apache-2.0, at your choice; the design is yours |\n\
         | tools and their versions, hashes of all files | `results/tools.txt`, `results/files.sha256`, by \
         `make-evidence.sh` |\n| all again | `sh make-evidence.sh`, behind the same `fspid export` |\n",
        subject.heading.digest,
        env!("CARGO_PKG_VERSION"),
        numbers,
        if subject.heading.angles == Some(crate::Angles::Degrees) { "degrees" } else { "radians" },
        subject.vectors.len()
    )
}

/// What no vector finds, those first of which nobody knows why.
fn survivors(findings: &[Finding]) -> String {
    let mut left: Vec<&Finding> = findings.iter().filter(|it| it.vector.is_none()).collect();
    if left.is_empty() {
        return "\nEvery change is found.\n".to_owned();
    }
    left.sort_by_key(|it| it.equivalent.is_some());
    let mut text = format!(
        "\n{SHOWN}\nNot found, {}:\n\n| where | change | why |\n| --- | --- | --- |\n",
        left.len()
    );
    for finding in left {
        let why = finding.equivalent.map_or_else(
            || "not told apart by these vectors".to_owned(),
            |why| format!("equivalent: {why}"),
        );
        let (element, change, line) =
            (&finding.mutant.element, &finding.mutant.change, finding.line());
        let _ = writeln!(text, "| {element} (line {line}) | {change} | {why} |");
    }
    text
}

const SHOWN: &str = "\"Equivalent\" holds with the numbers of the design, from a reset on, for every sequence of calls with any samples, \
where nobody else writes into the memory. \"Intervals\" means: with intervals of floats in place of numbers, bounds of the memory are found \
that no call leaves, and within them both programs are the same once ways that are never gone are left out.\n";

fn ways<R: Real>(subject: &Subject<'_, R>, judge: &Judge<'_>, branches: &[Branch]) -> String {
    let ways = |it: &Branch| usize::from(it.held > 0) + usize::from(it.failed > 0);
    let both: usize = branches.iter().map(ways).sum();
    let one_way: Vec<&Branch> = branches.iter().filter(|it| ways(it) < 2).collect();
    let why: Vec<Option<String>> = one_way.iter().map(|it| judge.one_way(it)).collect();
    let known = why.iter().flatten().count();
    let mut text = format!(
        "\n## Ways that the vectors go\n\n{both} of {} outcomes of what the program asks (`coverage.csv`; \
         `make-evidence.sh` counts those of the compiled C). Of what goes one way, {known} are shown never to go the other \
         and {} are not.",
        2 * branches.len(),
        one_way.len() - known
    );
    if !one_way.is_empty() {
        text += " These never go the other way:\n\n";
    }
    for (branch, why) in one_way.iter().zip(why) {
        let asked = write::c_expression(subject.program, subject.prefix, &branch.condition);
        let way = if branch.held > 0 { "always holds" } else { "never holds" };
        let why = why.unwrap_or_else(|| "not known why".to_owned());
        let _ = writeln!(text, "- `{}`: `{asked}` {way}; {why}", branch.function);
    }
    text
}

const FILES: &str = "
## Files

| file | from | what it is |
| --- | --- | --- |
| `code/` | fspid | the export, with its vectors and the program that asks for them |
| `code.sha256`, `pack.sha256` | fspid | digests of all files of the export, and of the pack but this page, which the script compares first |
| `trace.csv` | fspid | element of the design or the code, its lines in the C, for each change the first vector that fails |
| `lines.csv`, `by-vector.csv` | fspid | the same the other ways: from a line, and from a vector that is the first to fail, to elements |
| `mutants.csv` | fspid | every change: the line of the C as it then is, and the first vector that fails |
| `coverage.csv` | fspid | what the program asks, how often it held and did not |
| `eva_main.c`, `sweep.c` | fspid | what the proof is asked, and the sweep over all numbers of 32 bits, of which an export of 64 has none |
| `make-evidence.sh`, `mutate.sh` | fspid | make everything below with a compiler, gcov, cppcheck, Frama-C and QEMU |
| `results/` | the script | warnings, vectors at each level, changes of the C compiled and run, branches by gcov, MISRA findings, the \
proof, the sweep, flash, frames, instructions (not cycles), tools, hashes |

## Findings of cppcheck's MISRA addon that may be there

None that is mandatory or required. Advisory ones, and why they stay:

| rule | why |
| --- | --- |
| 8.7 | what others call has external linkage, whether or not this program calls it |
| 8.9 | the tables of the self test stand outside of the one function that reads them, so that they can be read |
| 12.1 | every operation stands in brackets; the addon misses those behind a `?` |
| 15.5 | a sample that cannot be used ends the step at once |
| 19.2 | the bits of a number are read and made by a union: C has no other way without a library |

A vector has the number of its line in `code/vectors.csv`, counted from 1 behind the header.
";
