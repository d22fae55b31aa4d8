//! The digest of JSON in a canonical form: keys in order, no blanks, shortest digits.

use serde_json::Value;
use sha2::{Digest as _, Sha256};

/// SHA-256 of a value without one of its keys, in hexadecimal digits.
///
/// What means the same has the same digest, however it is laid out.
pub(super) fn digest(value: &Value, without: &str) -> String {
    let mut hasher = Sha256::new();
    add(&mut hasher, value, Some(without));
    hexadecimal(hasher)
}

/// SHA-256 of the bytes of a text, in hexadecimal digits, as programs beside this one compute it of a file.
pub(super) fn of_text(text: &str) -> String {
    let mut hasher = Sha256::new();
    hasher.update(text.as_bytes());
    hexadecimal(hasher)
}

fn hexadecimal(hasher: Sha256) -> String {
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn add(hasher: &mut Sha256, value: &Value, without: Option<&str>) {
    match value {
        Value::Object(map) => {
            let mut keys: Vec<&String> = map.keys().collect();
            keys.retain(|key| Some(key.as_str()) != without);
            keys.sort_unstable();
            hasher.update(b"{");
            for key in keys {
                hasher.update(Value::from(key.as_str()).to_string().as_bytes());
                hasher.update(b":");
                map.get(key).into_iter().for_each(|value| add(hasher, value, None));
                hasher.update(b",");
            }
            hasher.update(b"}");
        }
        Value::Array(values) => {
            hasher.update(b"[");
            for value in values {
                add(hasher, value, None);
                hasher.update(b",");
            }
            hasher.update(b"]");
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {
            hasher.update(value.to_string().as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_of_a_file_is_that_of_other_programs() {
        let of_nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(of_text(""), of_nothing);
    }

    #[test]
    fn the_order_of_keys_does_not_matter_and_every_value_does() {
        let of = |text: &str| digest(&serde_json::from_str(text).expect("JSON"), "own");
        let one = of(r#"{"a": 1.5, "b": [1, {"own": 2}], "own": "x"}"#);
        assert_eq!(one, of(r#"{"own": "y", "b": [1, {"own": 2}], "a": 1.50}"#));
        for other in [
            r#"{"a": 1.5, "b": [1, {"own": 3}]}"#,
            r#"{"a": 1.5000000000000002, "b": [1, {"own": 2}]}"#,
            r#"{"a": 1.5, "b": [[1], {"own": 2}]}"#,
            r#"{"a": 1.5, "b": [1, {"own": 2}], "c": null}"#,
        ] {
            assert_ne!(one, of(other), "{other}");
        }
    }
}
