//! Fuzzy sets: `{ shape = "gaussian", centre = 0, sigma = 1.5 }`, `{ formula = "…" }`.

use fspid_fuzzy::FuzzyError;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Membership, Term};
use serde_json::{Map, Value, json};

use super::fields::{Fields, any_number, below, in_order, word};
use super::formula::formula;
use crate::keyed::document::{Item, Value as Written};
use fspid_diagnostics::Report;

/// Where the groups of a shape with any number of parameters stand.
const GROUPS: &str = "points";

/// The variables of a set's formula: `x`, the inputs and the outputs.
pub(super) type Names<'a> = &'a [&'a str];

/// The terms of an input, in the order of the file.
pub(super) fn terms(
    report: &mut Report,
    item: Option<&Item>,
    path: &str,
    names: Names<'_>,
    mut found: impl FnMut(&str, &Item),
) -> Option<Vec<Term>> {
    let Some(item) = item else { return Some(Vec::new()) };
    let before = report.count();
    let fields = Fields::of(report, item, path, &terms_in_words())?;
    let (members, report) = (fields.members, fields.report);
    let mut terms = Vec::new();
    for member in in_order(members) {
        let path = below(path, &member.name);
        found(&member.name, &member.item);
        if let Some((membership, lower)) = set(report, &member.item, &path, names) {
            terms.push(Term { name: member.name.clone(), membership, lower });
        }
    }
    (report.count() == before).then_some(terms)
}

/// A set and, if it is an interval type-2 set, its lower membership function.
pub(super) fn set(
    report: &mut Report,
    item: &Item,
    path: &str,
    names: Names<'_>,
) -> Option<(Membership, Option<Membership>)> {
    let lower = match &item.value {
        Written::Table(members) => members.iter().find(|member| member.name == "lower"),
        _ => None,
    };
    let upper = membership(report, item, path, (names, true));
    let lower = match lower {
        Some(member) => {
            Some(membership(report, &member.item, &below(path, "lower"), (names, false))?)
        }
        None => None,
    };
    Some((upper?, lower))
}

fn membership(
    report: &mut Report,
    item: &Item,
    path: &str,
    (names, may_have_lower): (Names<'_>, bool),
) -> Option<Membership> {
    let mut fields = Fields::of(report, item, path, &set_in_words())?;
    let height = match fields.get("height") {
        Some(_) => fields.number("height", "a number above 0, at most 1")?,
        None => 1.0,
    };
    let mut known = vec!["height"];
    known.extend(may_have_lower.then_some("lower"));
    if fields.get("formula").is_some() {
        known.push("formula");
        fields.only(&known);
        return formula(&mut fields, "formula", names)
            .map(|formula| Membership::Formula { formula, height });
    }
    let kind = shape_kind(&mut fields)?;
    known.push("shape");
    let params = if kind.repeats() {
        known.push(GROUPS);
        fields.only(&known);
        groups(&mut fields, kind)
    } else {
        known.extend(kind.params().iter().map(|param| param.name));
        fields.only(&known);
        named(&mut fields, kind)
    }?;
    allowed_together(&mut fields, kind, &params)?;
    Some(Membership::Shape { kind, params, height })
}

fn shape_kind(fields: &mut Fields<'_>) -> Option<ShapeKind> {
    let known: Vec<&str> = ShapeKind::ALL.iter().map(|kind| kind.name()).collect();
    let item = fields.required("shape", &set_in_words())?;
    let Written::Text(text) = &item.value else {
        fields.wrong(item, "shape", "not a text", &known.join(", "));
        return None;
    };
    let path = below(fields.path, "shape");
    ShapeKind::from_name(word(fields.report, (item.place, &path), text, ("shape", &known))?)
}

/// Parameters by their names.
fn named(fields: &mut Fields<'_>, kind: ShapeKind) -> Option<Vec<f64>> {
    let before = fields.report.count();
    let mut params = Vec::new();
    for param in kind.params() {
        let Some(item) = fields.required(param.name, param.range.text()) else { continue };
        match any_number(item).filter(|value| param.range.allows(*value)) {
            Some(value) => params.push(value),
            None => fields.wrong(item, param.name, "not allowed", param.range.text()),
        }
    }
    let complete = params.len() == kind.params().len() && fields.report.count() == before;
    complete.then_some(params)
}

/// Parameters in groups: `points = [[0, 0], [1, 1]]`.
fn groups(fields: &mut Fields<'_>, kind: ShapeKind) -> Option<Vec<f64>> {
    let width = kind.params().len();
    let names: Vec<&str> = kind.params().iter().map(|param| param.name).collect();
    let allowed = format!("a list of [{}]", names.join(", "));
    let item = fields.required(GROUPS, &allowed)?;
    let Written::Array(rows) = &item.value else {
        fields.wrong(item, GROUPS, "not a list", &allowed);
        return None;
    };
    let before = fields.report.count();
    let mut params = Vec::new();
    for row in rows {
        match &row.value {
            Written::Array(numbers) if numbers.len() == width => {
                for (number, param) in numbers.iter().zip(kind.params()) {
                    match any_number(number).filter(|value| param.range.allows(*value)) {
                        Some(value) => params.push(value),
                        None => fields.wrong(number, GROUPS, "not allowed", param.range.text()),
                    }
                }
            }
            _ => fields.wrong(row, GROUPS, "not a point", &allowed),
        }
    }
    (fields.report.count() == before).then_some(params)
}

/// Whether the parameters go together; what is wrong is told at its own key.
fn allowed_together(fields: &mut Fields<'_>, kind: ShapeKind, params: &[f64]) -> Option<()> {
    let Err(error) = kind.check(params) else { return Some(()) };
    match error {
        FuzzyError::Parameter { name, allowed, .. } => {
            let key = if kind.repeats() { GROUPS } else { name };
            let item = fields.get(key).map(|member| &member.item)?;
            fields.wrong(item, key, "not allowed", allowed);
        }
        other => fields.report.missing(fields.place, fields.path, other.to_string(), ""),
    }
    None
}

pub(super) fn terms_in_words() -> String {
    format!("a table of names, each with {}", set_in_words())
}

pub(super) fn set_in_words() -> String {
    "{ shape = \"triangle\", left = 0, peak = 1, right = 2 } or another shape, or { formula = \"…\" }"
        .to_owned()
}

pub(super) fn terms_schema() -> Value {
    json!({ "type": "object", "additionalProperties": set_reference() })
}

/// A set, by its name in the schema.
pub(super) fn set_reference() -> Value {
    json!({ "$ref": "#/$defs/set" })
}

/// What the schema refers to by name.
pub(super) fn definitions() -> Value {
    json!({ "set": set_schema(true), "lower_set": set_schema(false) })
}

/// A set; `lower` says whether it may have a lower membership function.
fn set_schema(lower: bool) -> Value {
    let mut ways: Vec<Value> =
        ShapeKind::ALL.iter().map(|kind| shape_schema(*kind, lower)).collect();
    let formula = [("formula", json!({ "type": "string" }))];
    ways.push(object_schema(formula.into_iter().collect(), &["formula"], lower));
    json!({ "oneOf": ways })
}

fn shape_schema(kind: ShapeKind, lower: bool) -> Value {
    let mut properties = vec![("shape", json!({ "const": kind.name() }))];
    let mut required = vec!["shape"];
    if kind.repeats() {
        let width = kind.params().len();
        let row = json!({ "type": "array", "items": { "type": "number" }, "minItems": width, "maxItems": width });
        properties.push((GROUPS, json!({ "type": "array", "items": row })));
        required.push(GROUPS);
    } else {
        for param in kind.params() {
            let schema = json!({ "type": "number", "description": param.range.text() });
            properties.push((param.name, schema));
            required.push(param.name);
        }
    }
    object_schema(properties, &required, lower)
}

fn object_schema(properties: Vec<(&str, Value)>, required: &[&str], lower: bool) -> Value {
    let mut all: Map<String, Value> =
        properties.into_iter().map(|(name, schema)| (name.to_owned(), schema)).collect();
    let height = json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1, "default": 1 });
    all.insert("height".to_owned(), height);
    if lower {
        all.insert("lower".to_owned(), json!({ "$ref": "#/$defs/lower_set" }));
    }
    json!({ "type": "object", "properties": all, "required": required, "additionalProperties": false })
}
