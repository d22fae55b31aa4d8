//! What answers for programs have in common.

use serde_json::{Map, Value, json};

/// The key of the version of an answer's shape.
const SCHEMA: &str = "schema";

/// Pretty JSON with a line end. Every answer says the version of its shape, the first one where it has none of its own.
#[must_use]
pub fn answer_text(answer: &Value) -> String {
    match answer.as_object() {
        Some(keys) if !keys.contains_key(SCHEMA) => {
            let first = (SCHEMA.to_owned(), json!(1));
            let rest = keys.iter().map(|(key, value)| (key.clone(), value.clone()));
            let whole: Map<_, _> = std::iter::once(first).chain(rest).collect();
            format!("{:#}\n", Value::Object(whole))
        }
        _ => format!("{answer:#}\n"),
    }
}

/// The answer with a table `null` of why these keys are null in it, of those that are somewhere.
#[must_use]
pub fn with_null_reasons(mut answer: Value, reasons: &[(&str, &str)]) -> Value {
    let found = reasons.iter().filter(|(key, _)| holds_null(&answer, key));
    let table = by_name(found.map(|(key, reason)| ((*key).to_owned(), json!(reason))));
    if let (Some(table), Some(keys)) = (table, answer.as_object_mut()) {
        keys.insert("null".to_owned(), Value::Object(table));
    }
    answer
}

/// True where a key is null, or a list of which an entry is.
fn holds_null(value: &Value, key: &str) -> bool {
    let is_null = |value: &Value| match value {
        Value::Array(list) => list.iter().any(Value::is_null),
        value => value.is_null(),
    };
    match value {
        Value::Object(keys) => keys
            .iter()
            .any(|(name, value)| (name == key && is_null(value)) || holds_null(value, key)),
        Value::Array(list) => list.iter().any(|value| holds_null(value, key)),
        _ => false,
    }
}

/// A number, or in words which of the numbers that JSON does not have.
pub(crate) fn finite(value: f64) -> Value {
    match value {
        value if value.is_finite() => json!(value),
        f64::INFINITY => json!("infinite"),
        f64::NEG_INFINITY => json!("-infinite"),
        _ => json!("not a number"),
    }
}

/// The same for each of some numbers.
pub(crate) fn finite_all(values: &[f64]) -> Value {
    values.iter().copied().map(finite).collect()
}

/// An object without its keys that have no value.
#[must_use]
pub fn present(mut object: Value) -> Value {
    if let Some(keys) = object.as_object_mut() {
        keys.retain(|_, value| !value.is_null());
    }
    object
}

/// A list, or nothing for one that has nothing in it.
pub(crate) fn unless_empty<T>(list: &[T], one: fn(&T) -> Value) -> Option<Value> {
    (!list.is_empty()).then(|| list.iter().map(one).collect())
}

/// The keys of several objects as one object, in their order.
#[must_use]
pub fn merged<const N: usize>(objects: [Value; N]) -> Value {
    let maps = objects.into_iter().filter_map(|object| match object {
        Value::Object(keys) => Some(keys),
        _ => None,
    });
    Value::Object(maps.flatten().collect())
}

/// Values by their names, or nothing where there are none.
pub(crate) fn by_name(values: impl Iterator<Item = (String, Value)>) -> Option<Map<String, Value>> {
    let all: Map<_, _> = values.collect();
    (!all.is_empty()).then_some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_null_has_its_reason_in_the_table_and_what_is_never_null_has_none() {
        let answer = json!({ "points": [{ "period_s": null, "gain": 2.0 }, { "period_s": 1.0 }], "ends": [null] });
        let reasons =
            [("period_s", "it does not swing"), ("gain", "none"), ("ends", "there is no end")];
        let told = with_null_reasons(answer.clone(), &reasons);
        let table = json!({ "period_s": "it does not swing", "ends": "there is no end" });
        assert_eq!(told["null"], table);
        assert_eq!(with_null_reasons(answer.clone(), &[("gain", "none")]), answer);
    }
}
