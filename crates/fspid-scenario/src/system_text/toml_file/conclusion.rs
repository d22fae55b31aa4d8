//! What rules may conclude: a number, `{ constant = 1, slopes = { … } }`, `{ between = [1, 2] }`,
//! `{ value = "…" }`, or a fuzzy set.

use fspid_fuzzy::system::{Conclusion, OutputTerm};
use serde_json::{Value, json};

use super::fields::{Fields, any_number, below, in_order};
use super::formula::formula;
use super::membership::{self, Names};
use crate::keyed::document::{Item, Value as Written};
use fspid_diagnostics::Report;

/// The variables that a conclusion may name.
#[derive(Clone, Copy)]
pub(super) struct Variables<'a> {
    /// Names of the inputs.
    pub(super) inputs: Names<'a>,
    /// Names of the inputs, then of the outputs: formulas may ask for the last answers.
    pub(super) of_values: Names<'a>,
    /// `x` and those.
    pub(super) of_sets: Names<'a>,
}

/// The terms of an output, in the order of the file.
pub(super) fn terms(
    report: &mut Report,
    item: Option<&Item>,
    path: &str,
    variables: Variables<'_>,
    mut found: impl FnMut(&str, &Item),
) -> Option<Vec<OutputTerm>> {
    let Some(item) = item else { return Some(Vec::new()) };
    let before = report.count();
    let fields = Fields::of(report, item, path, &terms_in_words())?;
    let (members, report) = (fields.members, fields.report);
    let mut terms = Vec::new();
    for member in in_order(members) {
        let path = below(path, &member.name);
        found(&member.name, &member.item);
        if let Some(conclusion) = conclusion(report, &member.item, &path, variables) {
            terms.push(OutputTerm { name: member.name.clone(), conclusion });
        }
    }
    (report.count() == before).then_some(terms)
}

fn conclusion(
    report: &mut Report,
    item: &Item,
    path: &str,
    variables: Variables<'_>,
) -> Option<Conclusion> {
    if let Some(number) = any_number(item) {
        return Some(Conclusion::Constant(number));
    }
    let has = |name: &str| match &item.value {
        Written::Table(members) => members.iter().any(|member| member.name == name),
        _ => false,
    };
    if has("constant") || has("slopes") {
        return linear(&mut Fields::of(report, item, path, "")?, variables.inputs);
    }
    if has("between") {
        return interval(&mut Fields::of(report, item, path, "")?);
    }
    // A singleton is a shape, and has a `value` as well.
    if has("value") && !has("shape") {
        let mut fields = Fields::of(report, item, path, "")?;
        fields.only(&["value"]);
        return formula(&mut fields, "value", variables.of_values).map(Conclusion::Formula);
    }
    if !matches!(item.value, Written::Table(_)) {
        let message = format!("expected a number or a table, not {}", item.value.type_name());
        report.value(item.place, path, message, one_in_words());
        return None;
    }
    let (membership, lower) = membership::set(report, item, path, variables.of_sets)?;
    Some(Conclusion::Set { membership, lower })
}

fn linear(fields: &mut Fields<'_>, inputs: Names<'_>) -> Option<Conclusion> {
    fields.only(&["constant", "slopes"]);
    let constant = fields.number("constant", "a finite number")?;
    let Some(slopes) = fields.get("slopes") else { return Some(Conclusion::Constant(constant)) };
    let path = below(fields.path, "slopes");
    let mut slopes =
        Fields::of(fields.report, &slopes.item, &path, "numbers by the names of inputs")?;
    let before = slopes.report.count();
    slopes.only(inputs);
    let mut coefficients = Vec::new();
    for name in inputs {
        coefficients.push(match slopes.get(name) {
            Some(_) => slopes.number(name, "a finite number").unwrap_or(0.0),
            None => 0.0,
        });
    }
    (slopes.report.count() == before).then_some(Conclusion::Linear { coefficients, constant })
}

fn interval(fields: &mut Fields<'_>) -> Option<Conclusion> {
    let allowed = "[lower, upper], lower not above upper";
    fields.only(&["between"]);
    let item = fields.required("between", allowed)?;
    let ends = match &item.value {
        Written::Array(items) => items.iter().filter_map(any_number).collect(),
        _ => Vec::new(),
    };
    match *ends.as_slice() {
        [lower, upper] if lower <= upper => Some(Conclusion::Interval([lower, upper])),
        _ => {
            fields.wrong(item, "between", "not an interval", allowed);
            None
        }
    }
}

pub(super) fn terms_in_words() -> String {
    format!("a table of names, each with {}", one_in_words())
}

fn one_in_words() -> String {
    let set = membership::set_in_words();
    format!(
        "a number, {{ constant = 1, slopes = {{ an_input = 2 }} }}, {{ between = [1, 2] }}, {{ value = \"…\" }}, or {set}"
    )
}

pub(super) fn terms_schema() -> Value {
    let number = json!({ "type": "number" });
    let table = |properties: Value, required: &[&str]| json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false });
    let slopes = json!({ "type": "object", "additionalProperties": number });
    let ends = json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
    let ways = [
        number.clone(),
        table(json!({ "constant": number, "slopes": slopes }), &["constant"]),
        table(json!({ "between": ends }), &["between"]),
        table(json!({ "value": { "type": "string" } }), &["value"]),
        membership::set_reference(),
    ];
    json!({ "type": "object", "additionalProperties": { "oneOf": ways } })
}

#[cfg(test)]
mod tests {
    use fspid_fuzzy::membership::ShapeKind;
    use fspid_fuzzy::system::{Conclusion, Membership};

    /// Its `value` used to be taken for a formula, beside which a `shape` is refused.
    #[test]
    fn a_singleton_may_be_concluded_as_a_set_and_comes_back() {
        let text = r#"
schema = 1
kind = "fuzzy-system"
name = "s"
[[input]]
name = "x"
range = [0, 1]
[input.terms]
on = { shape = "linear-s", foot = -1, shoulder = 0 }
[[output]]
name = "y"
range = [0, 10]
sampling = "endpoints:11"
[output.terms]
u = { shape = "singleton", value = 3 }
[[rules]]
lines = ["if x is on then y is u"]
"#;
        let first = super::super::parse(text, "s.toml").expect("a system");
        let written = super::super::write(first.parts());
        let again = super::super::parse(&written, "s.toml").expect("a system again");
        let membership =
            Membership::Shape { kind: ShapeKind::Singleton, params: vec![3.0], height: 1.0 };
        let expected = Conclusion::Set { membership, lower: None };
        for system in [&first, &again] {
            assert_eq!(system.parts().outputs[0].terms[0].conclusion, expected);
        }
    }
}
