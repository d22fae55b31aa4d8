//! What each variable is: given, constant, calculated, or read off a table.

use crate::compile::names::Names;
use crate::document::{Document, Role, TableFunction, Variable};
use crate::expression::Expression;
use crate::finding::Findings;

/// A variable and how its value comes about.
pub(super) struct Definition<'a> {
    pub(super) slot: usize,
    pub(super) kind: Kind<'a>,
    pub(super) limits: Option<(f64, f64)>,
    pub(super) answer: bool,
}

/// How a value comes about.
#[derive(Clone, Copy)]
pub(super) enum Kind<'a> {
    Given,
    Constant(f64),
    Formula(&'a Expression),
    Table(&'a TableFunction),
}

/// One definition for each variable, in order.
pub(super) fn definitions<'a>(
    document: &'a Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Vec<Definition<'a>> {
    let functions = functions_by_output(document, names, findings);
    let variables = document.variables.iter().zip(functions).enumerate();
    variables
        .map(|(slot, (variable, function))| Definition {
            slot,
            kind: kind(variable, function, findings),
            limits: limits(variable),
            answer: variable.roles.iter().any(|role| role.is_answer()),
        })
        .collect()
}

/// For each variable the function that makes it.
fn functions_by_output<'a>(
    document: &'a Document,
    names: &Names<'_>,
    findings: &mut Findings,
) -> Vec<Option<&'a TableFunction>> {
    let mut makers = vec![None; document.variables.len()];
    for function in &document.functions {
        let output = &function.output;
        let index = names.variable(&output.id, output.origin, findings);
        let maker = index.and_then(|index| makers.get_mut(index));
        if let Some(maker) = maker
            && maker.replace(function).is_some()
        {
            let message = "two functions make this variable";
            findings.problem(output.origin, &output.id, message, "one of them");
        }
    }
    makers
}

fn kind<'a>(
    variable: &'a Variable,
    function: Option<&'a TableFunction>,
    findings: &mut Findings,
) -> Kind<'a> {
    let given = variable.roles.iter().any(|role| role.is_given());
    match (&variable.formula, function, variable.initial) {
        (Some(_), Some(_), _) => contradiction(variable, "a calculation and a function", findings),
        (Some(_), None, _) if given && !is_state(variable) => {
            contradiction(variable, "a calculation and the mark of an input", findings)
        }
        (None, Some(_), _) if given && !is_state(variable) => {
            contradiction(variable, "a function and the mark of an input", findings)
        }
        (Some(formula), None, _) => Kind::Formula(formula),
        (None, Some(function), _) => Kind::Table(function),
        (None, None, Some(value)) if !given => Kind::Constant(value),
        (None, None, _) => {
            if !given {
                let message = format!(
                    "`{}` has neither value nor calculation: taken as an input; say <isInput/> if it is one",
                    variable.id
                );
                findings.note(variable.origin, message);
            }
            Kind::Given
        }
    }
}

fn is_state(variable: &Variable) -> bool {
    variable.roles.contains(&Role::State)
}

fn contradiction<'a>(variable: &Variable, what: &str, findings: &mut Findings) -> Kind<'a> {
    let message = format!("this variable has {what}");
    findings.problem(variable.origin, &variable.id, message, "one of them");
    Kind::Given
}

fn limits(variable: &Variable) -> Option<(f64, f64)> {
    let limited = variable.min.is_some() || variable.max.is_some();
    let (min, max) =
        (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
    limited.then_some((min, max))
}
