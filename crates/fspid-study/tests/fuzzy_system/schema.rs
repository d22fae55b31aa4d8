//! The schema allows what the reader allows.

use serde_json::Value;

use super::{EVERY_KEY, TIP, TYPE_2};

/// What is wrong with a value: the part of draft 2020-12 that the schema uses. A word that is not
/// known here fails the test.
fn fault(schema: &Value, value: &Value, path: &str) -> Option<String> {
    let words = schema.as_object().expect("a schema is an object");
    words.iter().find_map(|(word, rule)| word_fault(word, rule, (schema, value, path)))
}

fn word_fault(
    word: &str,
    rule: &Value,
    (schema, value, path): (&Value, &Value, &str),
) -> Option<String> {
    let members = || value.as_object().into_iter().flatten();
    let items = value.as_array();
    let inner = |rule: &Value, item: &Value, key: &str| fault(rule, item, &format!("{path}.{key}"));
    let good = match word {
        "$ref" => {
            let name = rule.as_str().and_then(|path| path.strip_prefix("#/$defs/"));
            let definitions = &fspid_scenario::fuzzy_system::schema()["$defs"];
            let found = name.and_then(|name| definitions.get(name)).expect("it is defined");
            return fault(found, value, path);
        }
        "$defs" | "$schema" | "title" | "description" | "default" => true,
        "properties" => {
            return members().find_map(|(key, item)| inner(rule.get(key)?, item, key));
        }
        "additionalProperties" => {
            let known = |key: &str| schema["properties"].get(key).is_some();
            let mut others = members().filter(|(key, _)| !known(key));
            if rule.is_object() {
                return others.find_map(|(key, item)| inner(rule, item, key));
            }
            rule == true || others.next().is_none()
        }
        "items" => {
            let mut all = items.into_iter().flatten().enumerate();
            return all.find_map(|(n, item)| inner(rule, item, &n.to_string()));
        }
        "oneOf" => {
            let ways = rule.as_array().expect("a list").iter();
            ways.filter(|way| fault(way, value, path).is_none()).count() == 1
        }
        "anyOf" => {
            let mut ways = rule.as_array().expect("a list").iter();
            ways.any(|way| fault(way, value, path).is_none())
        }
        "allOf" => {
            return rule.as_array().expect("a list").iter().find_map(|way| fault(way, value, path));
        }
        "not" => fault(rule, value, path).is_some(),
        "required" => value.as_object().is_none_or(|object| {
            let mut names = rule.as_array().expect("a list").iter();
            names.all(|name| object.contains_key(name.as_str().expect("a name")))
        }),
        "type" => is_of(rule.as_str().expect("one type"), value),
        "enum" => rule.as_array().expect("a list").contains(value),
        "const" => rule == value,
        "minimum" => value.as_f64().is_none_or(|x| x >= rule.as_f64().expect("a number")),
        "maximum" => value.as_f64().is_none_or(|x| x <= rule.as_f64().expect("a number")),
        "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > rule.as_f64().expect("a number")),
        "minItems" => items.is_none_or(|all| all.len() as u64 >= rule.as_u64().expect("a number")),
        "maxItems" => items.is_none_or(|all| all.len() as u64 <= rule.as_u64().expect("a number")),
        "minLength" | "pattern" => true,
        other => panic!("the test does not know `{other}`"),
    };
    (!good).then(|| format!("{path}: {word} {rule} for {value}"))
}

fn is_of(kind: &str, value: &Value) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number() || value.as_str() == Some("inf"),
        other => panic!("type {other}"),
    }
}

/// The file as JSON; an infinite number, which JSON does not have, is the text `inf`.
fn json(text: &str) -> Value {
    fn value(found: toml::Value) -> Value {
        match found {
            toml::Value::String(text) => Value::String(text),
            toml::Value::Integer(number) => number.into(),
            toml::Value::Float(number) => {
                serde_json::Number::from_f64(number).map_or(Value::from("inf"), Value::Number)
            }
            toml::Value::Boolean(found) => found.into(),
            toml::Value::Datetime(date) => Value::String(date.to_string()),
            toml::Value::Array(list) => list.into_iter().map(value).collect(),
            toml::Value::Table(table) => {
                Value::Object(table.into_iter().map(|(key, item)| (key, value(item))).collect())
            }
        }
    }
    value(toml::Value::Table(text.parse().expect("it is TOML")))
}

#[test]
fn the_schema_allows_every_key_and_refuses_what_is_wrong() {
    let schema = fspid_scenario::fuzzy_system::schema();
    for text in [TIP, EVERY_KEY, TYPE_2] {
        assert_eq!(fault(&schema, &json(text), "$"), None);
    }
    for (from, to) in [
        ("range = [0, 10]", "rnge = [0, 10]"),
        ("shape = \"gaussian\"", "shape = \"gausian\""),
        ("sigma = 1.5", "sgma = 1.5"),
        ("fallback = \"middle\"", "fallback = \"midle\""),
        ("schema = 1", "schema = 2"),
        ("lines =", "line ="),
    ] {
        let text = TIP.replacen(from, to, 1);
        assert!(fault(&schema, &json(&text), "$").is_some(), "{to}");
    }
}
