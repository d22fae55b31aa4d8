use std::sync::LazyLock;

use fspid_scenario::file;
use serde_json::Value;

use crate::file::shipped;

/// Built once: it is asked for every value of every text.
pub(crate) static SCHEMA: LazyLock<Value> = LazyLock::new(file::schema);

/// Whether a value is valid: the part of draft 2020-12 that the schema uses. `None` where it is,
/// or the first thing that is not. A word of the schema that is not known here fails the test.
pub(crate) fn fault(schema: &Value, value: &Value, path: &str) -> Option<String> {
    let object = schema.as_object().expect("a schema is an object");
    object.iter().find_map(|(word, rule)| word_fault((word, rule), schema, value, path))
}

fn word_fault(
    (word, rule): (&String, &Value),
    schema: &Value,
    value: &Value,
    path: &str,
) -> Option<String> {
    let list = || rule.as_array().expect("a list");
    let is_valid = |rule: &&Value| fault(rule, value, path).is_none();
    let good = match word.as_str() {
        "items" => return items_fault(rule, value, path),
        // Within the document only.
        "$ref" => {
            let name = rule.as_str().expect("a text").trim_start_matches("#/$defs/");
            return fault(&SCHEMA["$defs"][name], value, path);
        }
        "properties" => return properties_fault(rule, value, path),
        "allOf" => return list().iter().find_map(|rule| fault(rule, value, path)),
        "anyOf" => list().iter().any(|rule| is_valid(&rule)),
        "oneOf" => list().iter().filter(is_valid).count() == 1,
        "not" => !is_valid(&rule),
        "required" => value.as_object().is_none_or(|members| {
            let mut names = list().iter().map(|key| key.as_str().expect("a name"));
            names.all(|name| members.contains_key(name))
        }),
        "additionalProperties" => {
            let known = schema["properties"].as_object().expect("an object");
            let closed = rule == false;
            let mut keys = value.as_object().into_iter().flat_map(|members| members.keys());
            !closed || keys.all(|key| known.contains_key(key))
        }
        _ => is_allowed(word, rule, value),
    };
    (!good).then(|| format!("{path}: {word} {rule}"))
}

fn items_fault(rule: &Value, value: &Value, path: &str) -> Option<String> {
    let mut items = value.as_array()?.iter().enumerate();
    items.find_map(|(i, item)| fault(rule, item, &format!("{path}[{i}]")))
}

fn properties_fault(rule: &Value, value: &Value, path: &str) -> Option<String> {
    let mut members = value.as_object()?.iter();
    members.find_map(|(key, item)| fault(rule.get(key)?, item, &format!("{path}.{key}")))
}

/// The words that look at the value alone.
fn is_allowed(word: &str, rule: &Value, value: &Value) -> bool {
    let number = value.as_f64();
    let bound = || rule.as_f64().expect("a number");
    let size = || value.as_array().map_or(0, Vec::len) as f64;
    match word {
        "$schema" | "$defs" | "title" | "description" | "default" => true,
        "type" => match rule.as_str() {
            Some("object") => value.is_object(),
            Some("array") => value.is_array(),
            Some("string") => value.is_string(),
            Some("boolean") => value.is_boolean(),
            Some("integer") => value.is_i64(),
            Some("number") => value.is_number(),
            other => panic!("type {other:?}"),
        },
        "const" => value == rule,
        "enum" => rule.as_array().expect("a list").contains(value),
        "minimum" => number.is_none_or(|number| number >= bound()),
        "maximum" => number.is_none_or(|number| number <= bound()),
        "exclusiveMinimum" => number.is_none_or(|number| number > bound()),
        "minItems" => size() >= bound(),
        "maxItems" => size() <= bound(),
        "minLength" => value.as_str().is_none_or(|text| !text.is_empty()),
        "pattern" => value.as_str().is_none_or(|text| match rule.as_str() {
            Some("\\.toml$") => text.ends_with(".toml"),
            _ => text.parse::<fspid_fuzzy::Defuzzifier>().is_ok(),
        }),
        other => panic!("the test knows no `{other}`"),
    }
}

/// A text as the schema sees it.
pub(crate) fn as_json(text: &str) -> Value {
    let value: toml::Value = toml::from_str(text).expect("it is TOML");
    serde_json::to_value(value).expect("it has no dates")
}

#[test]
fn every_shipped_scenario_and_the_starter_are_valid_by_the_schema() {
    let schema = file::schema();
    let starter = ("starter".to_owned(), file::starter().to_owned());
    for (name, text) in shipped().into_iter().chain([starter]) {
        assert_eq!(fault(&schema, &as_json(&text), ""), None, "{name}");
    }
}

#[test]
fn every_carried_aircraft_and_the_template_of_one_are_valid_by_the_schema_of_aircraft() {
    let schema = file::aircraft_schema();
    let template = ("template", file::starter_named("aircraft").expect("a template").text);
    for (name, text) in fspid_data::AIRCRAFT.into_iter().chain([template]) {
        assert_eq!(fault(&schema, &as_json(text), ""), None, "{name}");
        for (from, to) in [("kind = ", "sort = "), ("title = ", "called = ")] {
            let wrong = text.replacen(from, to, 1);
            assert!(file::parse_aircraft(&wrong, name, None).is_err(), "{name}: {to}");
            assert!(fault(&schema, &as_json(&wrong), "").is_some(), "{name}: {to}");
        }
    }
}

#[test]
fn what_the_check_refuses_of_form_the_schema_refuses_too() {
    let schema = file::schema();
    let changes = [
        ("schema = 1", "schema = 2"),
        ("name = \"my first flight\"", ""),
        ("preset = \"navion-paper\"", "preset = \"concorde\""),
        ("preset = \"navion-paper\"", "preset = \"navion-paper\"\nnumerator = [1.0]"),
        ("preset = \"navion-paper\"", "numerator = [1.0]"),
        ("sample_period_s = 0.01", "sample_period_s = 0.0"),
        ("sample_period_s = 0.01", "sample_perod_s = 0.01"),
        ("kind = \"step\"", "kind = \"steep\""),
        ("kind = \"step\"", "kind = \"square\""),
        ("kp = 1.0\n", "kp = \"fast\"\n"),
        ("kp = 1.0\n", ""),
        ("kp = 1.0\n", "kp = 1.0\nisa = { gain = 1.0 }\n"),
        ("table = \"mirrored\"", "table = \"tilted\""),
        (
            "table = \"mirrored\"",
            "numbers = { delta_kp = [[0]], delta_ki = [[0]], delta_kd = [[0]] }",
        ),
        ("table = \"mirrored\"", "table = \"mirrored\"\nsystem = \"mine.fis\""),
        ("range = 5.0", "range = -5.0"),
        ("kp_min", "kp_least"),
    ];
    for (from, to) in changes {
        let text = file::starter().replacen(from, to, 1);
        assert_ne!(text, file::starter(), "{from}");
        assert!(fault(&schema, &as_json(&text), "").is_some(), "{from} -> {to}");
        assert!(file::parse(&text, "x", None, &[]).is_err(), "{from} -> {to}");
    }
}

#[test]
fn every_key_of_the_schema_has_a_description() {
    fn walk(schema: &Value, path: &str) {
        if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
            for (key, property) in properties {
                let path = format!("{path}.{key}");
                assert!(
                    key == "kind"
                        || property["description"].as_str().is_some_and(|doc| doc.len() > 4),
                    "{path}"
                );
                walk(property, &path);
            }
        }
        for inner in ["oneOf", "allOf"] {
            schema
                .get(inner)
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .for_each(|one| walk(one, path));
        }
        schema.get("items").into_iter().for_each(|items| walk(items, path));
    }
    walk(&file::schema(), "");
}
