//! Functions: variables that are read off tables.

use crate::document::{Document, Extrapolate, FunctionInput, Mention, TableFunction};
use crate::finding::Findings;
use crate::xml::element::Element;
use crate::xml::{header, table};

/// What can stand in place of points without a grid.
pub(super) const UNGRIDDED: &str =
    "a griddedTableDef or griddedTableRef; put the points on a grid of breakpoints";

pub(super) fn read(element: Element<'_, '_>, document: &mut Document, findings: &mut Findings) {
    element.only(&["name"], findings);
    let mut function = TableFunction {
        name: element.required("name", findings),
        origin: element.origin(),
        ..TableFunction::default()
    };
    for part in element.children(findings) {
        match part.name() {
            "description" => function.description = part.prose(),
            "provenance" => function.provenance = header::provenance(part),
            "provenanceRef" => {
                part.leave_out("it points to a provenance that is not kept", findings)
            }
            "independentVarRef" => function.inputs.extend(input(part, findings)),
            "dependentVarRef" => function.output = table::mention(part, "varID", findings),
            "functionDefn" => definition(part, &mut function, document, findings),
            "independentVarPts" | "dependentVarPts" => part.refuse(
                "function",
                "independentVarRef, dependentVarRef and a functionDefn with a griddedTableDef",
                findings,
            ),
            _ => part.refuse(
                "function",
                "description, provenance, independentVarRef, dependentVarRef, functionDefn",
                findings,
            ),
        }
    }
    complete(element, &function, findings);
    document.functions.push(function);
}

fn complete(element: Element<'_, '_>, function: &TableFunction, findings: &mut Findings) {
    let parts = [
        (function.inputs.is_empty(), "independentVarRef"),
        (function.output.id.is_empty(), "dependentVarRef"),
        (function.table.id.is_empty(), "functionDefn"),
    ];
    let simple = element.child("independentVarPts").is_some();
    for (missing, part) in parts.into_iter().filter(|_| !simple) {
        let inside = element.elements().any(|child| child.name() == part);
        if missing && !inside {
            findings.problem(element.origin(), &function.name, "a part is missing", part);
        }
    }
}

fn input(reference: Element<'_, '_>, findings: &mut Findings) -> Option<FunctionInput> {
    reference.only(&["varID", "min", "max", "extrapolate", "interpolate"], findings);
    let interpolate = reference.attribute("interpolate").unwrap_or("linear");
    if interpolate != "linear" {
        let message = "this interpolation is not supported";
        findings.problem(reference.origin(), interpolate, message, "linear");
    }
    Some(FunctionInput {
        variable: table::mention(reference, "varID", findings),
        min: reference.number("min", findings),
        max: reference.number("max", findings),
        extrapolate: extrapolate(reference, findings)?,
    })
}

fn extrapolate(reference: Element<'_, '_>, findings: &mut Findings) -> Option<Extrapolate> {
    let word = reference.attribute("extrapolate").unwrap_or("neither");
    let kind = Extrapolate::named(word);
    if kind.is_none() {
        let known = Extrapolate::ALL.map(|(name, _)| name).join(", ");
        findings.problem(reference.origin(), word, "unknown way to extrapolate", known);
    }
    kind
}

fn definition(
    element: Element<'_, '_>,
    function: &mut TableFunction,
    document: &mut Document,
    findings: &mut Findings,
) {
    for part in element.children(findings) {
        match part.name() {
            "griddedTableRef" => function.table = table::mention(part, "gtID", findings),
            "griddedTableDef" | "griddedTable" => {
                let inside = table::read(part, Some(&function.name), findings);
                function.table = Mention { id: inside.id.clone(), origin: part.origin() };
                document.tables.push(inside);
            }
            _ => part.refuse("functionDefn", UNGRIDDED, findings),
        }
    }
}
