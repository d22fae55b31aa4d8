//! Check cases.

use crate::document::{Document, Shot, Signal};
use crate::finding::Findings;
use crate::xml::element::Element;

pub(super) fn read(data: Element<'_, '_>, document: &mut Document, findings: &mut Findings) {
    for part in data.children(findings) {
        match part.name() {
            "staticShot" => document.shots.push(shot(part, findings)),
            "provenance" | "provenanceRef" => {
                part.leave_out("the provenance of check cases is not kept", findings);
            }
            _ => part.refuse("checkData", "staticShot", findings),
        }
    }
}

fn shot(element: Element<'_, '_>, findings: &mut Findings) -> Shot {
    element.only(&["name", "refID"], findings);
    let mut shot = Shot {
        name: element.required("name", findings),
        origin: element.origin(),
        ..Shot::default()
    };
    for part in element.children(findings) {
        match part.name() {
            "description" => shot.description = part.prose(),
            "provenance" | "provenanceRef" => {
                part.leave_out("the provenance of check cases is not kept", findings);
            }
            "checkInputs" => shot.inputs = signals(part, findings),
            "internalValues" => shot.internals = signals(part, findings),
            "checkOutputs" => shot.outputs = signals(part, findings),
            _ => part.refuse(
                "staticShot",
                "description, checkInputs, internalValues, checkOutputs",
                findings,
            ),
        }
    }
    shot
}

fn signals(part: Element<'_, '_>, findings: &mut Findings) -> Vec<Signal> {
    let mut signals = Vec::new();
    for element in part.children(findings) {
        if element.name() == "signal" {
            signals.push(signal(element, findings));
        } else {
            element.refuse(part.name(), "signal", findings);
        }
    }
    signals
}

fn signal(element: Element<'_, '_>, findings: &mut Findings) -> Signal {
    let mut signal = Signal { origin: element.origin(), ..Signal::default() };
    let mut valued = false;
    for part in element.children(findings) {
        match part.name() {
            "signalName" => (signal.variable, signal.by_name) = (part.prose(), true),
            "varID" | "signalID" => (signal.variable, signal.by_name) = (part.prose(), false),
            "signalUnits" => signal.units = part.prose(),
            "signalValue" => (signal.value, valued) = (part.single(findings), true),
            "tol" => signal.tolerance = Some(part.single(findings)),
            _ => part.refuse(
                "signal",
                "signalName or varID, signalUnits, signalValue, tol",
                findings,
            ),
        }
    }
    if signal.variable.is_empty() || !valued {
        let expected = "signalName or varID, and signalValue";
        findings.problem(element.origin(), "signal", "a part is missing", expected);
    }
    signal
}
