//! Calculations in MathML's content markup.

use core::f64::consts::{E, PI};

use crate::expression::{Expression, Function};
use crate::finding::Findings;
use crate::xml::element::{Element, number};

/// The formula of a `calculation`, or `None` with a problem.
pub(super) fn calculation(part: Element<'_, '_>, findings: &mut Findings) -> Option<Expression> {
    let math = only_child(part, "<math>", findings)?;
    if math.name() == "math" {
        operand(only_child(math, "one formula", findings)?, findings)
    } else {
        math.refuse("calculation", "math", findings);
        None
    }
}

fn only_child<'a, 'i>(
    parent: Element<'a, 'i>,
    expected: &str,
    findings: &mut Findings,
) -> Option<Element<'a, 'i>> {
    let children = parent.children(findings);
    if let [child] = children.as_slice() {
        return Some(*child);
    }
    let message = format!("the number of elements inside is {}", children.len());
    findings.problem(parent.origin(), parent.name(), message, expected);
    None
}

fn operand(element: Element<'_, '_>, findings: &mut Findings) -> Option<Expression> {
    match element.name() {
        "cn" => numeral(element, findings),
        "ci" => Some(variable(element)),
        "apply" => application(element, findings),
        "piecewise" => piecewise(element, findings),
        "pi" => Some(Expression::Number(PI)),
        "exponentiale" => Some(Expression::Number(E)),
        "true" => Some(Expression::Number(1.0)),
        "false" => Some(Expression::Number(0.0)),
        _ => {
            let expected = "cn, ci, apply, piecewise, pi, exponentiale, true, false";
            element.refuse("a formula", expected, findings);
            None
        }
    }
}

fn numeral(element: Element<'_, '_>, findings: &mut Findings) -> Option<Expression> {
    if !matches!(element.attribute("type"), None | Some("real" | "integer")) {
        let word = element.attribute("type").unwrap_or_default();
        findings.problem(element.origin(), word, "this type of <cn> is not read", "real, integer");
        return None;
    }
    number(&element.text(), element.origin(), findings).map(Expression::Number)
}

fn variable(element: Element<'_, '_>) -> Expression {
    Expression::Variable { id: element.prose(), origin: element.origin() }
}

/// `<apply>`: a function and its operands. Some files put a lone `<piecewise>` into one, which means itself.
fn application(apply: Element<'_, '_>, findings: &mut Findings) -> Option<Expression> {
    let children = apply.children(findings);
    match children.as_slice() {
        [lone] if lone.name() == "piecewise" => piecewise(*lone, findings),
        [head, operands @ ..] => {
            let function = function(*head, findings);
            let operands = all(operands, findings);
            applied(*head, function?, operands?, findings)
        }
        [] => {
            findings.problem(
                apply.origin(),
                "apply",
                "nothing is applied",
                "a function and operands",
            );
            None
        }
    }
}

fn all(elements: &[Element<'_, '_>], findings: &mut Findings) -> Option<Vec<Expression>> {
    let read: Vec<_> = elements.iter().map(|&element| operand(element, findings)).collect();
    read.into_iter().collect()
}

fn applied(
    head: Element<'_, '_>,
    function: Function,
    operands: Vec<Expression>,
    findings: &mut Findings,
) -> Option<Expression> {
    if let Some(expected) = function.refuses(operands.len()) {
        let message = format!("the number of operands is {}", operands.len());
        findings.problem(head.origin(), head.name(), message, expected);
        return None;
    }
    Some(Expression::Apply(function, operands))
}

/// The function that an element names; `csymbol` names it by its text.
fn function(head: Element<'_, '_>, findings: &mut Findings) -> Option<Function> {
    let symbol = head.prose();
    let name = if head.name() == "csymbol" { symbol.as_str() } else { head.name() };
    let found = Function::named(name).filter(|&function| function != Function::Piecewise);
    if found.is_none() {
        findings.problem(head.origin(), name, "unknown function", Function::names());
    }
    found
}

fn piecewise(element: Element<'_, '_>, findings: &mut Findings) -> Option<Expression> {
    let children = element.children(findings);
    let mut operands = Vec::new();
    let mut otherwise = Vec::new();
    for part in &children {
        let inside = all(&part.children(findings), findings)?;
        match (part.name(), inside.len()) {
            ("piece", 2) => operands.extend(inside),
            ("otherwise", 1) if otherwise.is_empty() => otherwise = inside,
            _ => {
                let expected = "pieces of a value and a condition, and one <otherwise>";
                part.refuse("piecewise", expected, findings);
                return None;
            }
        }
    }
    operands.append(&mut otherwise);
    applied(element, Function::Piecewise, operands, findings)
}
