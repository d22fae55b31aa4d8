//! Names that tell things apart: the format knows everything by number and does not need them.

use std::collections::BTreeSet;

use fspid_fuzzy::system::{Input, Output};

use super::source::Source;
use crate::report::{Report, clipped};
use fspid_diagnostics::Place;

/// Names what has no name, and renames what has the name of something before it.
pub(super) fn settle(
    source: &Source,
    inputs: &mut [Input],
    outputs: &mut [Output],
    report: &mut Report,
) {
    let places = source.inputs.values().chain(source.outputs.values()).map(|section| section.place);
    let names = inputs.iter_mut().map(|input| &mut input.name);
    let names = names.chain(outputs.iter_mut().map(|output| &mut output.name));
    differ(names.zip(places), report);
    for (input, section) in inputs.iter_mut().zip(source.inputs.values()) {
        let names = input.terms.iter_mut().map(|term| &mut term.name);
        differ(numbered(names).map(|name| (name, section.place)), report);
    }
    for (output, section) in outputs.iter_mut().zip(source.outputs.values()) {
        let names = output.terms.iter_mut().map(|term| &mut term.name);
        differ(numbered(names).map(|name| (name, section.place)), report);
    }
}

/// `mf1`, `mf2`, … where a label is empty.
fn numbered<'n>(
    names: impl Iterator<Item = &'n mut String>,
) -> impl Iterator<Item = &'n mut String> {
    names.enumerate().map(|(index, name)| {
        if name.trim().is_empty() {
            *name = format!("mf{}", index + 1);
        }
        name
    })
}

fn differ<'n>(names: impl Iterator<Item = (&'n mut String, Place)>, report: &mut Report) {
    let mut seen = BTreeSet::new();
    let mut copies = 1_usize;
    for (name, place) in names {
        let first = name.clone();
        while seen.contains(name.as_str()) {
            copies += 1;
            *name = format!("{first} ({copies})");
        }
        if *name != first {
            let (first, shown) = (clipped(&first), clipped(name));
            report.note(place, format!("`{first}` is there already; this one is called `{shown}`"));
        }
        seen.insert(name.clone());
    }
}
