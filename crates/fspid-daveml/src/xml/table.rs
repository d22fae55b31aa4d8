//! Breakpoints and tables.

use crate::document::{Breakpoints, GridTable, Mention};
use crate::finding::Findings;
use crate::xml::element::Element;
use crate::xml::header;

pub(super) fn breakpoints(definition: Element<'_, '_>, findings: &mut Findings) -> Breakpoints {
    definition.only(&["name", "bpID", "units"], findings);
    let mut read = Breakpoints {
        id: definition.required("bpID", findings),
        name: definition.optional("name"),
        units: definition.optional("units"),
        origin: definition.origin(),
        ..Breakpoints::default()
    };
    for part in definition.children(findings) {
        match part.name() {
            "bpVals" => read.values = part.numbers(findings),
            "description" => read.description = part.prose(),
            _ => part.refuse("breakpointDef", "description, bpVals", findings),
        }
    }
    read
}

/// A table; one inside of a function may go without an identifier and then has the name of the function.
pub(super) fn read(
    definition: Element<'_, '_>,
    function: Option<&str>,
    findings: &mut Findings,
) -> GridTable {
    definition.only(&["name", "gtID", "units"], findings);
    let mut table = GridTable {
        id: identifier(definition, function, findings),
        name: definition.optional("name"),
        units: definition.optional("units"),
        origin: definition.origin(),
        ..GridTable::default()
    };
    for part in definition.children(findings) {
        match part.name() {
            "description" => table.description = part.prose(),
            "provenance" => table.provenance = header::provenance(part),
            "provenanceRef" => {
                part.leave_out("it points to a provenance that is not kept", findings)
            }
            "breakpointRefs" => table.breakpoints = references(part, findings),
            "dataTable" => table.values = part.numbers(findings),
            "confidenceBound" | "uncertainty" => {
                part.leave_out("values are taken as certain", findings);
            }
            _ => part.refuse(
                definition.name(),
                "description, provenance, breakpointRefs, dataTable, uncertainty",
                findings,
            ),
        }
    }
    table
}

fn identifier(
    definition: Element<'_, '_>,
    function: Option<&str>,
    findings: &mut Findings,
) -> String {
    match (definition.optional("gtID"), function) {
        (id, Some(function)) if id.is_empty() => format!("table of {function}"),
        (id, None) if id.is_empty() => definition.required("gtID", findings),
        (id, _) => id,
    }
}

fn references(part: Element<'_, '_>, findings: &mut Findings) -> Vec<Mention> {
    let mut mentions = Vec::new();
    for reference in part.children(findings) {
        if reference.name() == "bpRef" {
            mentions.push(mention(reference, "bpID", findings));
        } else {
            reference.refuse("breakpointRefs", "bpRef", findings);
        }
    }
    mentions
}

/// A mention of something by an attribute.
pub(super) fn mention(
    element: Element<'_, '_>,
    attribute: &str,
    findings: &mut Findings,
) -> Mention {
    Mention { id: element.required(attribute, findings), origin: element.origin() }
}
