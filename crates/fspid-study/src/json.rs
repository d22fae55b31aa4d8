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
pub(crate) fn present(mut object: Value) -> Value {
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
pub(crate) fn merged<const N: usize>(objects: [Value; N]) -> Value {
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
