//! Definitions of variables.

use crate::document::{Role, Variable};
use crate::finding::Findings;
use crate::xml::element::Element;
use crate::xml::math;

/// What can stand inside.
const INSIDE: &str = "description, provenance, calculation, isInput, isControl, isDisturbance, isState, isStateDeriv, \
                      isOutput, isStdAIAA, uncertainty";

const ATTRIBUTES: [&str; 11] = [
    "name",
    "varID",
    "units",
    "axisSystem",
    "sign",
    "alias",
    "symbol",
    "initialValue",
    "minValue",
    "maxValue",
    "order",
];

pub(super) fn read(definition: Element<'_, '_>, findings: &mut Findings) -> Variable {
    definition.only(&ATTRIBUTES, findings);
    let mut variable = attributes(definition, findings);
    for part in definition.children(findings) {
        match (part.name(), Role::named(part.name())) {
            (_, Some(role)) => variable.roles.push(role),
            ("description", _) => variable.description = part.prose(),
            ("calculation", _) => variable.formula = math::calculation(part, findings),
            ("provenance" | "provenanceRef", _) => {
                part.leave_out("the provenance of a variable is not kept", findings);
            }
            ("uncertainty", _) => part.leave_out("values are taken as certain", findings),
            _ => part.refuse("variableDef", INSIDE, findings),
        }
    }
    limits_in_order(definition, &variable, findings);
    variable
}

fn attributes(definition: Element<'_, '_>, findings: &mut Findings) -> Variable {
    Variable {
        id: definition.required("varID", findings),
        name: definition.required("name", findings),
        units: definition.required("units", findings),
        sign: definition.optional("sign"),
        symbol: definition.optional("symbol"),
        initial: definition.number("initialValue", findings),
        min: definition.number("minValue", findings),
        max: definition.number("maxValue", findings),
        origin: definition.origin(),
        ..Variable::default()
    }
}

fn limits_in_order(definition: Element<'_, '_>, variable: &Variable, findings: &mut Findings) {
    if let (Some(min), Some(max)) = (variable.min, variable.max)
        && !(min <= max)
    {
        let message = format!("minValue {min} is above maxValue {max}");
        findings.problem(definition.origin(), &variable.id, message, "limits in order");
    }
}
