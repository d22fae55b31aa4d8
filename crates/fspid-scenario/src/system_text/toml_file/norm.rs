//! Norms: a word, or a formula in the two grades.

use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{SNorm, TNorm};
use serde_json::{Value, json};

use super::fields::{Fields, word};
use super::formula::{formula, formula_schema};
use crate::keyed::document::{Item, Value as Written};
use crate::toml_text::quoted;
use fspid_diagnostics::Report;

/// The two grades of a norm's formula.
const GRADES: [&str; 2] = ["a", "b"];

macro_rules! norm {
    ($norm:ident, $kind:ident, $read:ident, $words:ident, $schema:ident, $write:ident) => {
        /// The norm at `path`; the default where there is none.
        pub(super) fn $read(report: &mut Report, item: Option<&Item>, path: &str) -> Option<$norm> {
            let Some(item) = item else { return Some($norm::default()) };
            let known: Vec<&str> = $kind::ALL.iter().map(|kind| kind.name()).collect();
            if let Written::Text(text) = &item.value {
                let at = (item.place, path);
                let name = word(report, at, text, ("norm", &known))?;
                return $kind::from_name(name).map($norm::Kind);
            }
            let mut fields = Fields::of(report, item, path, &$words())?;
            fields.only(&["formula"]);
            formula(&mut fields, "formula", &GRADES).map($norm::Formula)
        }

        pub(super) fn $words() -> String {
            let known: Vec<&str> = $kind::ALL.iter().map(|kind| kind.name()).collect();
            format!("{}, or {{ formula = \"…\" }} in a and b", known.join(", "))
        }

        pub(super) fn $schema() -> Value {
            let known: Vec<&str> = $kind::ALL.iter().map(|kind| kind.name()).collect();
            json!({ "oneOf": [{ "enum": known }, formula_schema()], "default": $norm::default_name() })
        }

        pub(super) fn $write(norm: &$norm) -> String {
            match norm {
                $norm::Kind(kind) => quoted(kind.name()),
                $norm::Formula(formula) => format!("{{ formula = {} }}", quoted(formula.text())),
            }
        }
    };
}

trait DefaultName {
    fn default_name() -> &'static str;
}

impl DefaultName for TNorm {
    fn default_name() -> &'static str {
        TNormKind::Minimum.name()
    }
}

impl DefaultName for SNorm {
    fn default_name() -> &'static str {
        SNormKind::Maximum.name()
    }
}

norm!(TNorm, TNormKind, read_and, and_in_words, and_schema, write_and);
norm!(SNorm, SNormKind, read_or, or_in_words, or_schema, write_or);
