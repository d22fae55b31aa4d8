//! The JSON Schema of tables, from the same keys as the check.

use serde_json::{Map, Value, json};

use super::{Checked, Choice, KeyName, KeyRow, Kind, Range, Table, Way};

/// Tells grids of rules from other texts, until marks are allowed.
pub(crate) const GRID_WORD: &str = "x-grid";
/// The same for grids of numbers and other lists.
pub(crate) const NUMBERS_WORD: &str = "x-numbers";

/// The JSON Schema (draft 2020-12) of files with these keys.
pub(crate) fn schema_of(spec: &'static Table, title: &str) -> Value {
    let mut schema = table(spec);
    schema.insert("$schema".to_owned(), json!("https://json-schema.org/draft/2020-12/schema"));
    schema.insert("title".to_owned(), json!(title));
    Value::Object(schema)
}

fn table(spec: &'static Table) -> Map<String, Value> {
    let mut schema = Map::new();
    schema.insert("description".to_owned(), json!(spec.doc));
    schema.insert("type".to_owned(), json!("object"));
    if spec.variants.is_empty() {
        let keys: Vec<KeyRow> = spec.keys().collect();
        schema.extend(object(&keys, None, spec.choices));
        return schema;
    }
    let variants: Vec<Value> = spec
        .variants
        .iter()
        .map(|variant| {
            let keys: Vec<KeyRow> = spec.keys().chain(variant.table.keys()).collect();
            let mut one = object(&keys, Some(variant.name), variant.table.choices);
            one.insert("description".to_owned(), json!(variant.table.doc));
            Value::Object(one)
        })
        .collect();
    schema.insert("oneOf".to_owned(), Value::Array(variants));
    schema
}

/// What the keys of an object may be.
fn object(keys: &[KeyRow], kind: Option<&str>, choices: &[Choice]) -> Map<String, Value> {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some(kind) = kind {
        properties.insert("kind".to_owned(), json!({ "const": kind }));
        required.push("kind");
    }
    for key in keys {
        let name = key.name().as_str();
        properties.insert(name.to_owned(), property(*key));
        if key.is_required() {
            required.push(name);
        }
    }
    let mut schema = Map::new();
    schema.insert("properties".to_owned(), Value::Object(properties));
    schema.insert("required".to_owned(), json!(required));
    schema.insert("additionalProperties".to_owned(), json!(false));
    let all: Vec<Value> = choices.iter().map(choice).collect();
    if !all.is_empty() {
        schema.insert("allOf".to_owned(), Value::Array(all));
    }
    schema
}

/// Exactly one of the ways, without a key of another.
fn choice(choice: &Choice) -> Value {
    let names = |names: &[KeyName]| names.iter().map(|name| name.as_str()).collect::<Vec<_>>();
    let keys = |way: &Way| [names(way.required), names(way.optional)].concat();
    let ways: Vec<Value> = choice
        .ways
        .iter()
        .map(|way| {
            let others = choice.ways.iter().filter(|other| !std::ptr::eq(*other, way));
            let foreign: Vec<Value> =
                others.flat_map(keys).map(|name| json!({ "required": [name] })).collect();
            // Of nothing nothing is to be left out, and an empty list is no schema.
            match foreign.is_empty() {
                true => json!({ "required": names(way.required) }),
                false => json!({ "required": names(way.required), "not": { "anyOf": foreign } }),
            }
        })
        .collect();
    json!({ "oneOf": ways })
}

fn property(key: KeyRow) -> Value {
    let mut schema = kind(key.kind());
    let unit = key.kind().unit();
    let doc =
        if unit.is_empty() { key.doc().to_owned() } else { format!("{} [{unit}]", key.doc()) };
    schema.insert("description".to_owned(), json!(doc));
    let default = match key.default() {
        Some(Checked::Number(number)) => Some(json!(number)),
        Some(Checked::Integer(integer)) => Some(json!(integer)),
        Some(Checked::Boolean(boolean)) => Some(json!(boolean)),
        Some(Checked::Text(text)) => Some(json!(text)),
        _ => None,
    };
    schema.extend(default.map(|default| ("default".to_owned(), default)));
    Value::Object(schema)
}

pub(crate) fn kind(kind: &'static Kind) -> Map<String, Value> {
    let schema = match kind {
        Kind::Number { range, .. } => number(*range),
        Kind::Integer { least, most } => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Text | Kind::Path => json!({ "type": "string", "minLength": 1 }),
        Kind::FreeText => json!({ "type": "string" }),
        Kind::Word(words) => json!({ "type": "string", "enum": words }),
        Kind::Preset(list) => json!({ "type": "string", "enum": list() }),
        Kind::Rules { names, grids } => {
            json!({ "oneOf": [
                { "type": "string", "enum": names() },
                { "type": "string", "pattern": "\\.toml$" },
                table(grids),
            ] })
        }
        Kind::Grid => json!({ "type": "string", GRID_WORD: true }),
        Kind::NumberGrid => {
            let row = json!({ "type": "array", "items": number(Range::Finite), "minItems": 7, "maxItems": 7 });
            json!({ "type": "array", "items": row, "minItems": 7, "maxItems": 7, NUMBERS_WORD: true })
        }
        Kind::Defuzzifier => {
            json!({ "type": "string", "pattern": "^(exact|(endpoints|midpoint|trapezoid|left-end|vertices):[0-9]+)$" })
        }
        Kind::Own { schema, .. } => schema(),
        Kind::Numbers { range, least, most, .. } => {
            json!({ "type": "array", "items": number(*range), "minItems": least, "maxItems": most })
        }
        Kind::Interval { range, .. } => {
            json!({ "type": "array", "items": number(*range), "minItems": 2, "maxItems": 2 })
        }
        Kind::Table(spec) => return table(spec),
        Kind::Tables { table: spec, least, most } => {
            json!({ "type": "array", "items": table(spec), "minItems": least, "maxItems": most })
        }
    };
    match schema {
        Value::Object(schema) => schema,
        _ => Map::new(),
    }
}

pub(crate) fn number(range: Range) -> Value {
    match range {
        Range::Finite => json!({ "type": "number" }),
        Range::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Range::NotNegative => json!({ "type": "number", "minimum": 0 }),
        Range::Between(least, most) => {
            json!({ "type": "number", "minimum": least, "maximum": most })
        }
        Range::PositiveUpTo(most) => {
            json!({ "type": "number", "exclusiveMinimum": 0, "maximum": most })
        }
        Range::UpTo(most) => json!({ "type": "number", "minimum": 0, "maximum": most }),
    }
}
