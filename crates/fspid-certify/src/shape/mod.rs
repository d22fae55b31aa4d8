//! What a certificate's file may hold: every key with its kind and its range, checked before anything is
//! computed, all problems at once.

mod certificate;

use std::fmt;

use serde_json::{Map, Value};

pub(super) use certificate::CERTIFICATE;

/// Most problems that are told; of more, only how many there are.
const MOST_TOLD: usize = 50;
/// Most characters of what was found.
const MOST_FOUND: usize = 60;

/// What a value may be.
#[derive(Debug)]
pub(super) enum Shape {
    /// A finite number within both ends.
    Number(f64, f64),
    /// A finite number above 0, up to a largest.
    Positive(f64),
    /// A whole number within both ends.
    Whole(u64, u64),
    /// One of some words.
    Word(&'static [&'static str]),
    /// A text of 1 to so many characters, without control characters.
    Text(usize),
    /// A SHA-256 in hexadecimal digits, not all of them 0.
    Digest,
    /// `true` or `false`.
    Truth,
    /// The shape, or `null`.
    OrNull(&'static Shape),
    /// A list of so many.
    List(&'static Shape, [usize; 2]),
    /// Keys and values.
    Object(&'static [Key]),
    /// Keys and values that depend on the word at a key.
    Kinds(&'static str, &'static [(&'static str, &'static [Key])]),
}

/// A key of an object.
#[derive(Debug)]
pub(super) struct Key {
    name: &'static str,
    shape: Shape,
    needed: bool,
}

const fn key(name: &'static str, shape: Shape) -> Key {
    Key { name, shape, needed: true }
}

const fn optional(name: &'static str, shape: Shape) -> Key {
    Key { name, shape, needed: false }
}

/// Something that is wrong at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// Keys and indices from the root; empty for the whole.
    pub path: String,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.path.as_str() {
            "" => f.write_str(&self.what),
            path => write!(f, "{path}: {}", self.what),
        }
    }
}

/// Everything that is wrong with a value; empty if it has the shape.
pub(super) fn problems(shape: &Shape, value: &Value, twice: &[String]) -> Vec<Wrong> {
    let mut walk = Walk { path: String::new(), wrong: Vec::new(), untold: 0 };
    for path in twice {
        walk.path.clone_from(path);
        walk.tell("stands more than once".to_owned());
    }
    walk.path.clear();
    walk.visit(shape, value);
    if walk.untold > 0 {
        let what = format!("and {} problems more", walk.untold);
        walk.wrong.push(Wrong { path: String::new(), what });
    }
    walk.wrong
}

struct Walk {
    path: String,
    wrong: Vec<Wrong>,
    untold: usize,
}

impl Walk {
    fn tell(&mut self, what: String) {
        if self.wrong.len() < MOST_TOLD {
            self.wrong.push(Wrong { path: self.path.clone(), what });
        } else {
            self.untold += 1;
        }
    }

    fn expect(&mut self, good: bool, value: &Value, allowed: impl FnOnce() -> String) {
        if !good {
            self.tell(format!("found {}; allowed are {}", found(value), allowed()));
        }
    }

    fn below(&mut self, step: &str, visit: impl FnOnce(&mut Self)) {
        let length = self.path.len();
        self.path.push_str(step);
        visit(self);
        self.path.truncate(length);
    }

    fn visit(&mut self, shape: &Shape, value: &Value) {
        match shape {
            Shape::OrNull(_) if value.is_null() => {}
            Shape::OrNull(shape) => self.visit(shape, value),
            Shape::List(each, sizes) => self.list(each, *sizes, value),
            Shape::Object(keys) => self.object(value, |walk, map| walk.keys(keys, None, map)),
            Shape::Kinds(tag, kinds) => {
                self.object(value, |walk, map| walk.kinds(tag, kinds, map));
            }
            Shape::Number(..)
            | Shape::Positive(_)
            | Shape::Whole(..)
            | Shape::Word(_)
            | Shape::Text(_)
            | Shape::Truth
            | Shape::Digest => self.expect(is_single(shape, value), value, || allowed(shape)),
        }
    }

    fn list(&mut self, each: &Shape, [least, most]: [usize; 2], value: &Value) {
        let Some(values) = value.as_array() else {
            return self.expect(false, value, || "lists".to_owned());
        };
        if !(least..=most).contains(&values.len()) {
            let allowed = match (least, most) {
                (least, most) if least == most => format!("{most}"),
                (least, most) => format!("{least} to {most}"),
            };
            // What is in it counts no more.
            return self.tell(format!("a list of {}; allowed are {allowed}", values.len()));
        }
        for (place, value) in values.iter().enumerate() {
            self.below(&format!("[{place}]"), |walk| walk.visit(each, value));
        }
    }

    fn object(&mut self, value: &Value, visit: impl FnOnce(&mut Self, &Map<String, Value>)) {
        match value.as_object() {
            Some(map) => visit(self, map),
            None => self.expect(false, value, || "keys with values".to_owned()),
        }
    }

    fn at(&mut self, key: &str, visit: impl FnOnce(&mut Self)) {
        let dot = if self.path.is_empty() { "" } else { "." };
        let step: String = key.chars().take(MOST_FOUND).collect();
        self.below(&format!("{dot}{step}"), visit);
    }

    fn keys(&mut self, keys: &[Key], tag: Option<&str>, map: &Map<String, Value>) {
        for (name, value) in map.iter().filter(|(name, _)| Some(name.as_str()) != tag) {
            let known = keys.iter().find(|key| key.name == name);
            self.at(name, |walk| match known {
                Some(key) => walk.visit(&key.shape, value),
                None => walk.tell("is not a key of a certificate".to_owned()),
            });
        }
        for key in keys.iter().filter(|key| key.needed && !map.contains_key(key.name)) {
            self.at(key.name, |walk| walk.tell("is missing".to_owned()));
        }
    }

    fn kinds(&mut self, tag: &str, kinds: &[(&str, &[Key])], map: &Map<String, Value>) {
        let kind = map.get(tag).and_then(Value::as_str);
        let known = kinds.iter().find(|(name, _)| Some(*name) == kind);
        match (known, map.get(tag)) {
            (Some((_, keys)), _) => self.keys(keys, Some(tag), map),
            (None, Some(value)) => self.at(tag, |walk| {
                let names: Vec<&str> = kinds.iter().map(|(name, _)| *name).collect();
                walk.expect(false, value, || quoted(&names));
            }),
            (None, None) => self.at(tag, |walk| walk.tell("is missing".to_owned())),
        }
    }
}

fn is_single(shape: &Shape, value: &Value) -> bool {
    let number = || value.as_f64().filter(|number| number.is_finite());
    match shape {
        Shape::Number(least, most) => number().is_some_and(|it| it >= *least && it <= *most),
        Shape::Positive(most) => number().is_some_and(|it| it > 0.0 && it <= *most),
        Shape::Whole(least, most) => {
            value.as_u64().is_some_and(|it| (*least..=*most).contains(&it))
        }
        Shape::Word(words) => value.as_str().is_some_and(|text| words.contains(&text)),
        Shape::Text(most) => value.as_str().is_some_and(|text| {
            (1..=*most).contains(&text.chars().count()) && !text.chars().any(char::is_control)
        }),
        Shape::Digest => value.as_str().is_some_and(is_digest),
        Shape::Truth => value.is_boolean(),
        Shape::OrNull(_) | Shape::List(..) | Shape::Object(_) | Shape::Kinds(..) => false,
    }
}

fn is_digest(text: &str) -> bool {
    let digit = |c: u8| c.is_ascii_digit() || (b'a'..=b'f').contains(&c);
    text.len() == 64 && text.bytes().all(digit) && text.bytes().any(|c| c != b'0')
}

fn allowed(shape: &Shape) -> String {
    match shape {
        Shape::Number(least, most) if (-least).total_cmp(most).is_eq() => {
            format!("finite numbers up to {most:?} in magnitude")
        }
        Shape::Number(least, most) => format!("numbers from {least:?} to {most:?}"),
        Shape::Positive(most) => format!("numbers above 0, up to {most:?}"),
        Shape::Whole(least, most) => format!("whole numbers from {least} to {most}"),
        Shape::Word(words) => quoted(words),
        Shape::Text(most) => format!("texts of 1 to {most} characters without line breaks"),
        Shape::Digest => "64 hexadecimal digits in lower case, not all of them 0".to_owned(),
        Shape::Truth => "true and false".to_owned(),
        Shape::OrNull(shape) => allowed(shape),
        Shape::List(..) => "lists".to_owned(),
        Shape::Object(_) | Shape::Kinds(..) => "keys with values".to_owned(),
    }
}

fn quoted(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    words.join(", ")
}

/// What was found, shortened.
fn found(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Array(values) => format!("a list of {}", values.len()),
        Value::Object(map) => format!("an object of {} keys", map.len()),
        Value::String(text) if text.chars().count() > MOST_FOUND => {
            format!("a text of {} characters", text.chars().count())
        }
        Value::Bool(_) | Value::Number(_) | Value::String(_) => value.to_string(),
    }
}
