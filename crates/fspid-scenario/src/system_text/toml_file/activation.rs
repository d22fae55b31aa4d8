//! Which rules of a block act: a word, or a table with its numbers.

use fspid_fuzzy::system::{Activation, Comparison};
use serde_json::{Value, json};

use super::fields::{Fields, word};
use super::write::number;
use crate::keyed::document::{Item, Value as Written};
use crate::keyed::word::{Word, words};
use crate::toml_text::quoted;
use fspid_diagnostics::Report;

words! {
    /// Methods.
    Method {
        General = "general",
        First = "first",
        Last = "last",
        Highest = "highest",
        Lowest = "lowest",
        Proportional = "proportional",
        Threshold = "threshold",
    }
}

impl Method {
    /// The numbers that it needs.
    const fn needed(self) -> &'static [&'static str] {
        match self {
            Self::General | Self::Proportional => &[],
            Self::First | Self::Last => &["count", "threshold"],
            Self::Highest | Self::Lowest => &["count"],
            Self::Threshold => &["comparison", "threshold"],
        }
    }

    /// How it is written.
    fn example(self) -> String {
        match self.needed() {
            [] => format!("\"{}\"", self.name()),
            needed => {
                format!("{{ method = \"{}\", {} = … }}", self.name(), needed.join(" = …, "))
            }
        }
    }
}

/// Comparisons as they are written.
const COMPARISONS: [(&str, Comparison); 6] = [
    ("<", Comparison::Less),
    ("<=", Comparison::AtMost),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    (">=", Comparison::AtLeast),
    (">", Comparison::Greater),
];

/// The activation at `path`; general where there is none.
pub(super) fn read(report: &mut Report, item: Option<&Item>, path: &str) -> Option<Activation> {
    let Some(item) = item else { return Some(Activation::General) };
    if let Written::Text(text) = &item.value {
        let name = word(report, (item.place, path), text, ("method", Method::WORDS))?;
        return match Method::from_word(name)? {
            Method::General => Some(Activation::General),
            Method::Proportional => Some(Activation::Proportional),
            method @ (Method::First
            | Method::Last
            | Method::Highest
            | Method::Lowest
            | Method::Threshold) => {
                report.value(item.place, path, "more is needed", method.example());
                None
            }
        };
    }
    let mut fields = Fields::of(report, item, path, &in_words())?;
    let text = fields.text("method", &Method::WORDS.join(", "))?;
    let place = fields.get("method")?.item.place;
    let name = word(fields.report, (place, path), text, ("method", Method::WORDS))?;
    let method = Method::from_word(name)?;
    let mut keys = vec!["method"];
    keys.extend(method.needed());
    fields.only(&keys);
    match method {
        Method::First => Some(Activation::First {
            count: count(&mut fields)?,
            threshold: threshold(&mut fields)?,
        }),
        Method::Last => Some(Activation::Last {
            count: count(&mut fields)?,
            threshold: threshold(&mut fields)?,
        }),
        Method::Highest => Some(Activation::Highest { count: count(&mut fields)? }),
        Method::Lowest => Some(Activation::Lowest { count: count(&mut fields)? }),
        Method::Proportional => Some(Activation::Proportional),
        Method::Threshold => {
            let comparison = comparison(&mut fields)?;
            Some(Activation::Threshold { comparison, threshold: threshold(&mut fields)? })
        }
        Method::General => Some(Activation::General),
    }
}

fn count(fields: &mut Fields<'_>) -> Option<u32> {
    let allowed = "a whole number from 0 to 4294967295";
    let item = fields.required("count", allowed)?;
    let found = match item.value {
        Written::Integer(_, Some(value)) => u32::try_from(value).ok(),
        _ => None,
    };
    if found.is_none() {
        fields.wrong(item, "count", "not allowed", allowed);
    }
    found
}

fn threshold(fields: &mut Fields<'_>) -> Option<f64> {
    fields.number("threshold", "a finite number")
}

fn comparison(fields: &mut Fields<'_>) -> Option<Comparison> {
    let known = COMPARISONS.map(|(name, _)| name);
    let text = fields.text("comparison", &known.join(", "))?;
    let place = fields.get("comparison")?.item.place;
    let name = word(fields.report, (place, fields.path), text, ("comparison", &known))?;
    COMPARISONS.into_iter().find(|(sign, _)| *sign == name).map(|(_, comparison)| comparison)
}

/// The activation as it is written.
pub(super) fn write(activation: Activation) -> String {
    let counted = |method: &str, count: u32, threshold: Option<f64>| {
        let threshold = threshold.map(|t| format!(", threshold = {}", number(t)));
        format!("{{ method = \"{method}\", count = {count}{} }}", threshold.unwrap_or_default())
    };
    match activation {
        Activation::General => quoted("general"),
        Activation::Proportional => quoted("proportional"),
        Activation::First { count, threshold } => counted("first", count, Some(threshold)),
        Activation::Last { count, threshold } => counted("last", count, Some(threshold)),
        Activation::Highest { count } => counted("highest", count, None),
        Activation::Lowest { count } => counted("lowest", count, None),
        Activation::Threshold { comparison, threshold } => {
            let sign = COMPARISONS.into_iter().find(|(_, found)| *found == comparison);
            let sign = quoted(sign.map_or(">=", |(sign, _)| sign));
            let threshold = number(threshold);
            format!("{{ method = \"threshold\", comparison = {sign}, threshold = {threshold} }}")
        }
    }
}

pub(super) fn in_words() -> String {
    let words: Vec<String> = Method::ALL.iter().map(|method| method.example()).collect();
    words.join(", ")
}

pub(super) fn schema() -> Value {
    let way = |method: &Method| {
        let (name, needed) = (method.name(), method.needed());
        if needed.is_empty() {
            return json!({ "const": name });
        }
        let mut properties = serde_json::Map::new();
        properties.insert("method".to_owned(), json!({ "const": name }));
        for key in needed {
            let schema = match *key {
                "count" => json!({ "type": "integer", "minimum": 0 }),
                "comparison" => json!({ "enum": COMPARISONS.map(|(sign, _)| sign) }),
                _ => json!({ "type": "number" }),
            };
            properties.insert((*key).to_owned(), schema);
        }
        let required: Vec<&str> = std::iter::once("method").chain(needed.iter().copied()).collect();
        json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
    };
    let ways: Vec<Value> = Method::ALL.iter().map(way).collect();
    json!({ "oneOf": ways, "default": "general" })
}
