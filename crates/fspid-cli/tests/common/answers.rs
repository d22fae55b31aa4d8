//! Every answer that a test asks for as JSON is held against its published schema in `docs/answers`.
//!
//! The schemas are learned from the answers themselves: `checks/answers/learn.sh` has this module put each answer of these
//! tests into a folder (`FSPID_ANSWERS`), and makes of them what stands in `docs/answers`. They use few words of JSON
//! Schema, which are all that is understood here.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

/// Commands with others below them.
const GROUPS: [&str; 2] = ["aircraft", "campaign"];
/// Options that ask for an answer of another shape.
const VARIANTS: [&str; 8] =
    ["--all", "--rule", "--check", "--list", "--paths", "--front", "--sets", "--cases"];

/// Holds an answer against its schema, if it is one.
pub(crate) fn hold(words: &[&str], output: &Output) {
    if let Err(what) = held(words, output) {
        panic!("{what}");
    }
}

/// The same, for those who go on: what an answer has that its schema does not say.
pub(crate) fn held(words: &[&str], output: &Output) -> Result<(), String> {
    let is_json = words.windows(2).any(|pair| pair == ["--format", "json"]);
    let (Some(_), true) = (output.status.code(), is_json) else { return Ok(()) };
    // A closed pipe, a full disk: there is no answer, and the tests of these say so themselves.
    let Ok(answer) = serde_json::from_slice::<Value>(&output.stdout) else { return Ok(()) };
    let name = match answer.get("error") {
        Some(_) => "error".to_owned(),
        None => name(words),
    };
    // A schema is no answer, and its shape is that of JSON Schema.
    if name == "schema" {
        return Ok(());
    }
    if let Some(folder) = std::env::var_os("FSPID_ANSWERS") {
        kept(&PathBuf::from(folder).join(name), &output.stdout);
        return Ok(());
    }
    let file = published().join(format!("{name}.schema.json"));
    let text = std::fs::read_to_string(&file).map_err(|_| {
        format!("there is no docs/answers/{name}.schema.json: see checks/answers/learn.sh")
    })?;
    let schema: Value = serde_json::from_str(&text).expect("a schema");
    fits(&schema, &answer, "").map_err(|what| {
        format!(
            "`fspid {}` answers what docs/answers/{name}.schema.json does not say: {what}; checks/answers/learn.sh learns it",
            words.join(" ")
        )
    })
}

pub(crate) fn published() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/answers")
}

/// What an answer is called: the command, and what it was asked for.
fn name(words: &[&str]) -> String {
    let below = usize::from(words.first().is_some_and(|first| GROUPS.contains(first)));
    let mut name: Vec<&str> = words.iter().take(1 + below).copied().collect();
    let variant = |word: &&&str| VARIANTS.contains(&word.split('=').next().unwrap_or_default());
    name.extend(words.iter().filter(variant).map(|word| {
        let word = word.split('=').next().unwrap_or_default();
        word.trim_start_matches('-')
    }));
    // A list of rules is asked for by `--rule list`.
    if words.windows(2).any(|pair| pair == ["--rule", "list"]) {
        name.push("list");
    }
    name.join("-")
}

fn kept(folder: &Path, answer: &[u8]) {
    let mut hasher = DefaultHasher::new();
    answer.hash(&mut hasher);
    std::fs::create_dir_all(folder).expect("a folder");
    std::fs::write(folder.join(format!("{:016x}.json", hasher.finish())), answer).expect("written");
}

/// Whether a value fits a schema, or where it does not.
pub(crate) fn fits(schema: &Value, value: &Value, at: &str) -> Result<(), String> {
    if let Some(only) = schema.get("const")
        && only != value
    {
        return Err(format!("{at} is {value}, allowed is {only}"));
    }
    let types: Vec<&str> = match &schema["type"] {
        Value::String(one) => vec![one],
        Value::Array(many) => many.iter().filter_map(Value::as_str).collect(),
        // Of nothing that was ever seen nothing is said.
        _ => return Ok(()),
    };
    let own = of_type(value);
    let is_known = types.contains(&own) || (own == "integer" && types.contains(&"number"));
    if !is_known {
        return Err(format!("{at} is of type {own}, allowed is {}", types.join(" or ")));
    }
    match value {
        Value::Array(items) => items
            .iter()
            .enumerate()
            .try_for_each(|(place, item)| fits(&schema["items"], item, &format!("{at}[{place}]"))),
        Value::Object(keys) => {
            let required = schema["required"].as_array().into_iter().flatten();
            for key in required.filter_map(Value::as_str) {
                if !keys.contains_key(key) {
                    return Err(format!("{at} has no {key}"));
                }
            }
            keys.iter().try_for_each(|(key, value)| {
                let below = format!("{at}.{key}");
                match (schema["properties"].get(key), &schema["additionalProperties"]) {
                    (Some(schema), _) | (None, schema @ Value::Object(_)) => {
                        fits(schema, value, &below)
                    }
                    (None, _) => Err(format!("{below} is not known")),
                }
            })
        }
        _ => Ok(()),
    }
}

fn of_type(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}

#[test]
fn an_answer_that_departs_from_its_schema_is_told_with_its_place() {
    let schema = serde_json::json!({
        "type": "object",
        "required": ["schema"],
        "properties": {
            "schema": { "const": 1 },
            "found": {
                "type": "array",
                "items": { "type": ["number", "null"] },
            },
            "by_name": { "type": "object", "additionalProperties": { "type": "string" } },
            "never": {},
        },
    });
    let told = |answer: Value| fits(&schema, &answer, "");
    let good = serde_json::json!({
        "schema": 1,
        "found": [1, 2.5, null],
        "by_name": { "any name": "here" },
        "never": [null],
    });
    assert_eq!(told(good), Ok(()));
    for (answer, what) in [
        (serde_json::json!({}), "has no schema"),
        (serde_json::json!({ "schema": 2 }), ".schema is 2"),
        (serde_json::json!({ "schema": 1, "found": [1, "2"] }), ".found[1] is of type string"),
        (serde_json::json!({ "schema": 1, "by_name": { "a": 1 } }), ".by_name.a is of type"),
        (serde_json::json!({ "schema": 1, "more": 1 }), ".more is not known"),
    ] {
        let refused = told(answer).expect_err(what);
        assert!(refused.contains(what), "{refused}");
    }
}

/// The schema was learned from requirements without a beginning and without an altitude in metres.
#[test]
fn every_condition_of_a_requirement_is_known_to_the_schema_of_verify() {
    let text = std::fs::read_to_string(published().join("verify.schema.json")).expect("readable");
    let schema: Value = serde_json::from_str(&text).expect("a schema");
    let requirement = &schema["properties"]["requirements"]["items"]["properties"];
    let known = &requirement["conditions"]["properties"];
    for (name, _) in fspid_scenario::requirement::Conditions::default().numbers() {
        assert_eq!(known[name]["type"], "number", "{name}");
    }
}
