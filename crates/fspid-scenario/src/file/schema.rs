//! The JSON Schemas of scenario files and of aircraft files, from the same specification as the check.

use serde_json::{Map, Value, json};

use crate::file::spec::{AIRCRAFT_FILE, SCENARIO};
use crate::file::tunable;
use crate::keyed::check::FIXED;
use crate::keyed::schema::{GRID_WORD, NUMBERS_WORD, schema_of};

/// The JSON Schema (draft 2020-12) of scenario files.
#[must_use]
pub fn schema() -> Value {
    let mut schema = schema_of(&SCENARIO, "fspid scenario");
    if let Some(tables) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        tables
            .iter_mut()
            .filter(|(name, _)| !FIXED.contains(&name.as_str()))
            .for_each(|(_, table)| allow_marks(table));
    }
    schema["$defs"] = tunable::schemas();
    schema
}

/// The JSON Schema (draft 2020-12) of aircraft files, in which nothing is marked free.
#[must_use]
pub fn aircraft_schema() -> Value {
    let mut schema = schema_of(&AIRCRAFT_FILE, "fspid aircraft");
    forget_marks(&mut schema);
    schema
}

/// Takes out what tells where a mark may stand.
fn forget_marks(schema: &mut Value) {
    match schema {
        Value::Object(words) => {
            words.remove(GRID_WORD);
            words.remove(NUMBERS_WORD);
            words.values_mut().for_each(forget_marks);
        }
        Value::Array(items) => items.iter_mut().for_each(forget_marks),
        _ => {}
    }
}

/// Lets a mark stand in place of every number and every grid of rules.
fn allow_marks(schema: &mut Value) {
    match schema {
        Value::Object(words) => {
            let of = match words.get("type").and_then(Value::as_str) {
                Some("number") => Some("mark"),
                Some("string") if words.contains_key(GRID_WORD) => Some("rules"),
                Some("array") if words.contains_key(NUMBERS_WORD) => Some("numbers"),
                _ => None,
            };
            words.values_mut().for_each(allow_marks);
            if let Some(of) = of {
                let kept = ["description", "default"]
                    .into_iter()
                    .filter_map(|word| words.remove_entry(word))
                    .collect::<Map<String, Value>>();
                words.remove(GRID_WORD);
                words.remove(NUMBERS_WORD);
                let plain = Value::Object(std::mem::replace(words, kept));
                let marked = json!({ "$ref": format!("#/$defs/{of}") });
                words.insert("anyOf".to_owned(), json!([plain, marked]));
            }
        }
        Value::Array(items) => items.iter_mut().for_each(allow_marks),
        _ => {}
    }
}
