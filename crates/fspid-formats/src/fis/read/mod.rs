//! Reading: a file taken apart, then put together as a system.

mod keys;
mod membership;
mod names;
mod output;
mod row;
mod rule;
mod source;
mod system;
mod value;
mod variable;

use std::collections::BTreeMap;

use fspid_fuzzy::system::{Parts, RuleBlock, System};

use crate::cursor::Cursor;
use crate::note::Reading;
use crate::report::Report;
use fspid_diagnostics::Problems;
use source::{FisSection, Source};
use system::Header;
use variable::Variable;

/// The system that a file describes.
///
/// # Errors
/// Every problem of the file (up to fifty, then that there are more), each with line, column and what
/// was expected.
pub fn read(text: &str) -> Result<Reading, Problems> {
    let cursor = Cursor::new(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let mut report = Report::default();
    let source = Source::of(cursor, &mut report);
    let parts = parts(&source, &mut report);
    if report.is_clean() {
        unbuildable(&parts, &mut report);
    }
    let notes = report.finish()?;
    Ok(Reading { parts, notes })
}

fn parts(source: &Source, report: &mut Report) -> Parts {
    let header = Header::of(source, report);
    let inputs = variables(&source.inputs, "input", report);
    let outputs = variables(&source.outputs, "output", report);
    let method = header.method(inputs.len());
    let mut inputs: Vec<_> = inputs.into_iter().map(|found| found.input(report)).collect();
    let mut outputs: Vec<_> =
        outputs.into_iter().map(|found| output::output(found, &method, report)).collect();
    names::settle(source, &mut inputs, &mut outputs, report);
    let rules = rule::rules(source, &inputs, &mut outputs, report);
    header.counted(inputs.len(), outputs.len(), source.rows.len(), report);
    header.explained(&inputs, &outputs, report);
    let block = RuleBlock {
        name: String::new(),
        description: String::new(),
        enabled: true,
        and: header.and.into(),
        or: header.or.into(),
        implication: header.implication.into(),
        activation: Default::default(),
        rules,
    };
    let (name, description) = (header.name, String::new());
    Parts { name, description, inputs, outputs, blocks: vec![block] }
}

/// The variables of one kind in the order of their numbers, which must not have gaps.
fn variables<'a>(
    sections: &BTreeMap<usize, FisSection<'a>>,
    word: &str,
    report: &mut Report,
) -> Vec<Variable<'a>> {
    if sections.is_empty() {
        report.whole(format!("there is no {word}; at least one is needed"));
    }
    let mut before = 0;
    let mut variables = Vec::new();
    for (&number, section) in sections {
        if report.is_full() {
            break;
        }
        if number != before + 1 {
            let message = format!("{word} {} is left out", before + 1);
            report.problem(section.place, &format!("{word} {number}"), message, "");
        }
        variables.push(Variable::of(section, word, number, report));
        before = number;
    }
    variables
}

/// What a system cannot be built from although every line could be read.
fn unbuildable(parts: &Parts, report: &mut Report) {
    if let Err(errors) = System::new(parts.clone()) {
        errors.iter().for_each(|error| report.whole(error.to_string()));
    }
}
