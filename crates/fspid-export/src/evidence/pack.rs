//! The tables and the first page of a pack.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use fspid_numeric::Real;

use super::run::Ran;
use super::{Finding, Subject, proof};
use crate::interpret::Branch;
use crate::program::{Precision, Program, Value};
use crate::targets::File;
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
        self.vector.map_or_else(|| "none".to_owned(), |vector| vector.to_string())
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
        let vectors: Vec<String> = findings.iter().map(|it| it.found()).collect();
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

/// What is asked where, and how often it held and did not.
pub(super) fn coverage<R: Real>(subject: &Subject<'_, R>, branches: &[Branch]) -> String {
    let mut text = "function,asked,held,did not\n".to_owned();
    for branch in branches {
        let asked = write::c_expression(subject.program, subject.prefix, &branch.condition);
        let row = [cell(&asked), branch.held.to_string(), branch.failed.to_string()];
        let _ = writeln!(text, "{},{}", branch.function, row.join(","));
    }
    text
}

/// Found and all of those that satisfy something.
fn counted(findings: &[Finding], is: impl Fn(&Finding) -> bool) -> (usize, usize) {
    let all = findings.iter().filter(|it| is(it));
    all.fold((0, 0), |(found, all), it| (found + usize::from(it.vector.is_some()), all + 1))
}

/// What is known of places that the vectors do not tell apart.
struct Known<'a> {
    /// The source, line by line.
    lines: Vec<&'a str>,
    /// What never goes the other way.
    one_way: &'a [(&'a str, String, bool)],
    is_mirrored: bool,
    has_numbers: bool,
}

impl Known<'_> {
    /// True for a line in a block that is never entered.
    fn is_unreached(&self, line: usize) -> bool {
        let depth =
            |line: usize| self.lines.get(line - 1).map_or(0, |it| it.len() - it.trim_start().len());
        let mut inside = depth(line);
        (1..line).rev().any(|above| {
            let begins = depth(above) < inside;
            inside = inside.min(depth(above));
            begins
                && self.one_way.iter().any(|(_, asked, held)| {
                    let opened = self.lines[above - 1].trim() == format!("if ({asked}) {{");
                    opened && !held
                })
        })
    }

    /// True where what a line writes is written again before it is read.
    fn is_overwritten(&self, line: usize) -> bool {
        let Some((left, _)) = self.lines.get(line - 1).and_then(|it| it.split_once(" = ")) else {
            return false;
        };
        let indentation = left.len() - left.trim_start().len();
        let name = left.split_whitespace().next_back().unwrap_or_default();
        let words =
            |it: &str| it.split(|c: char| !c.is_alphanumeric() && c != '_').any(|it| it == name);
        let next = self.lines[line..].iter().find(|it| words(it));
        next.is_some_and(|it| {
            let written = it.trim_start().strip_prefix(name).and_then(|it| it.strip_prefix(" = "));
            written.is_some_and(|value| !words(value))
                && it.len() - it.trim_start().len() == indentation
        })
    }

    /// Why a change is not found, as far as it can be told without running it.
    fn reason(&self, finding: &Finding) -> &'static str {
        let line = finding.line();
        let text = self.lines.get(line.wrapping_sub(1)).copied().unwrap_or_default();
        let (element, change) = (finding.mutant.element.as_str(), finding.mutant.change.as_str());
        let asks = self.one_way.iter().any(|(_, asked, _)| text.contains(asked.as_str()));
        let compares = matches!(change, "<= for <" | "< for <=");
        let above = &self.lines[line.saturating_sub(3)..line.min(self.lines.len())];
        let asks_sample = |it: &&str| it.contains("if (") && it.contains("setpoint_rad");
        let is_sample = element == "track" && above.iter().any(asks_sample);
        if self.is_unreached(line) {
            return "stands where no vector goes: coverage.csv";
        }
        match () {
            () if is_sample => "the step behind it holds such a sample alike",
            () if compares && (text.contains('?') || text.contains("if (strengths")) => {
                "both ways answer the same number where the two sides are equal"
            }
            () if element == "infer" && self.has_numbers && text.contains("->range") => {
                "the inputs are limited once more behind it, in spacings"
            }
            () if compares && text.contains("->range") => {
                "the end of the range is moved onto itself"
            }
            () if asks => "what is asked here never goes the other way: coverage.csv",
            () if self.is_mirrored && matches!(element, "sign" | "fill_grades" | "spacing") => {
                "the rules conclude the same for both inputs turned"
            }
            () if element == "set_sigma" && change == "the other sign" => "squared",
            () if element == "reset" => "written again before it is read: nothing has started",
            () if self.is_overwritten(line) => "written again before it is read",
            () if text.contains("| fault") => "no fault comes here that is not held",
            () if text.contains("saturated = 0") => "nothing sets it before",
            () if compares => "no vector meets the very end with another answer",
            () if change.starts_with("a thousandth") => "no vector tells a thousandth apart here",
            () => "not told apart by these vectors",
        }
    }
}

/// True where every rule concludes what the rule for both inputs turned concludes.
fn is_mirrored(program: &Program) -> bool {
    let tables = program.configuration.iter().filter(|it| it.is_rules());
    tables.map(|it| &it.value).all(|value| match value {
        Value::Bytes(cells) => cells.iter().eq(cells.iter().rev()),
        Value::Reals(cells) => cells.iter().eq(cells.iter().rev()),
        Value::Real(_) | Value::Byte(_) | Value::Truth(_) => false,
    })
}

/// The first page.
pub(super) fn front<R: Real>(subject: &Subject<'_, R>, findings: &[Finding], base: &Ran) -> String {
    let asked = |it: &Branch| write::c_expression(subject.program, subject.prefix, &it.condition);
    let one_way = base.branches.iter().filter(|it| it.held == 0 || it.failed == 0);
    let one_way: Vec<(&str, String, bool)> =
        one_way.map(|it| (it.function, asked(it), it.held > 0)).collect();
    let source = write::c(subject.program, subject.prefix, subject.heading).source;
    let known = Known {
        lines: source.lines().collect(),
        one_way: &one_way,
        is_mirrored: is_mirrored(subject.program),
        has_numbers: subject.program.function("lower_set").is_some(),
    };
    let row = |what: &str, (found, all): (usize, usize)| format!("| {what} | {all} | {found} |\n");
    let is_rule = |it: &Finding| it.mutant.is_design && it.mutant.element.contains(" of ");
    let is_comparison = |it: &Finding| {
        !it.mutant.is_design
            && matches!(it.mutant.change.as_str(), "<= for <" | "< for <=" | "negated")
    };
    let mut text = proof::first_line(subject);
    let _ = write!(
        text,
        "\n\n# Evidence for {}: data for a review, no qualification\n\n{}\n",
        subject.heading.name.replace('\n', " "),
        about(subject)
    );
    let _ = write!(
        text,
        "\n## Changes that the vectors find\n\nMeasured here by the interpreter of the program from which the C is \
         written, with the first {} vectors (of {}, {} are answered otherwise by the program itself). `make-evidence.sh` changes the \
         same lines of the C, compiles each and runs it; its count is in `results/`.\n\n| single change of | changes | \
         found |\n| --- | --- | --- |\n",
        subject.vectors.len().min(super::ASKED),
        subject.vectors.len(),
        base.different
    );
    text += &row("a rule", counted(findings, is_rule));
    text += &row(
        "another number of the design",
        counted(findings, |it| it.mutant.is_design && !is_rule(it)),
    );
    text += &row("a comparison in the code", counted(findings, is_comparison));
    text += &row(
        "anything else in the code",
        counted(findings, |it| !it.mutant.is_design && !is_comparison(it)),
    );
    text += &survivors(findings, &known);
    text += &ways(&base.branches, &one_way);
    text += FILES;
    text
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

fn survivors(findings: &[Finding], known: &Known<'_>) -> String {
    let left: Vec<&Finding> = findings.iter().filter(|it| it.vector.is_none()).collect();
    if left.is_empty() {
        return "\nEvery change is found.\n".to_owned();
    }
    let mut text =
        format!("\nNot found, {}:\n\n| where | change | why |\n| --- | --- | --- |\n", left.len());
    for finding in left {
        let why = known.reason(finding);
        let line = finding.line();
        let _ = writeln!(
            text,
            "| {} (line {line}) | {} | {why} |",
            finding.mutant.element, finding.mutant.change
        );
    }
    text
}

fn ways(branches: &[Branch], one_way: &[(&str, String, bool)]) -> String {
    let both = 2 * branches.len() - one_way.len();
    let mut text = format!(
        "\n## Ways that the vectors go\n\n{both} of {} outcomes of what the program asks (`coverage.csv`; \
         `make-evidence.sh` counts those of the compiled C).",
        2 * branches.len()
    );
    if !one_way.is_empty() {
        text += " These never go the other way:\n\n";
        for (function, asked, held) in one_way {
            let way = if *held { "always holds" } else { "never holds" };
            let _ = writeln!(text, "- `{function}`: `{asked}` {way}");
        }
    }
    text
}

const FILES: &str = "
## Files

| file | from | what it is |
| --- | --- | --- |
| `code/` | fspid | the export, with its vectors and the program that asks for them |
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
