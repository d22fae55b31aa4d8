//! What was probably meant where the nearest word is none, or another one.

use fspid_diagnostics::nearest;

use crate::keyed::check::value;
use crate::keyed::document::Value;
use crate::keyed::{KeyRow, Kind};

/// Top-level tables in which nothing can be free.
pub(crate) const FIXED: [&str; 5] = ["requirement", "dispersion", "tuning", "contest", "set"];

/// Parts of a PID that are no kind of their own; the nearest word would drop what they have.
const PARTS: [(&str, &str); 3] = [
    ("pd", "a PD controller is \"pid\" with ki = 0"),
    ("pi", "a PI controller is \"pid\" with kd = 0"),
    ("i", "a controller with an integral alone is \"pid\" with kp = 0 and kd = 0"),
];

/// What follows an unknown word: the one that was probably meant.
pub(super) fn of_word(text: &str, known: &[&str]) -> String {
    let part = PARTS.iter().find(|(part, _)| text.eq_ignore_ascii_case(part));
    if let Some((_, told)) = part.filter(|_| known.contains(&"pid")) {
        return format!("; {told}");
    }
    nearest(text, known).map_or_else(String::new, |meant| format!("; did you mean \"{meant}\"?"))
}

/// The key of this table that differs from one of another kind by its last `s` alone.
pub(super) fn singular_or_plural(name: &str, keys: &[KeyRow]) -> Option<KeyRow> {
    let is_other = |key: &&KeyRow| {
        let known = key.name().as_str();
        known.strip_suffix('s') == Some(name) || name.strip_suffix('s') == Some(known)
    };
    keys.iter().find(is_other).copied()
}

/// The place of a key in the one table of this one that has it: `nominal.kp`.
pub(super) fn in_table(name: &str, keys: &[KeyRow]) -> Option<String> {
    let has = |key: &&KeyRow| match key.kind() {
        Kind::Table(table) => table.keys().any(|key| key.name().as_str() == name),
        _ => false,
    };
    let mut tables = keys.iter().filter(has);
    match (tables.next(), tables.next()) {
        (Some(table), None) => Some(format!("{}.{name}", table.name().as_str())),
        _ => None,
    }
}

/// What follows the key's name in a message: the key, and what it holds where that is more than a value.
pub(super) fn of_key(key: KeyRow) -> String {
    format!("did you mean `{}`: {}?", key.name().as_str(), value::allowed(key.kind()))
}

/// What follows where a range stands for a number that may be tuned.
pub(super) fn of_range(found: &Value, path: &str) -> &'static str {
    let root = path.split(['.', '[']).next().unwrap_or_default();
    match found {
        Value::Table(_) | Value::Array(_) if !FIXED.contains(&root) => {
            "; a number that `fspid tune` may choose is { tune = [lower, upper] }"
        }
        _ => "",
    }
}
