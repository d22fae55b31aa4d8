//! Quantities with names, told once for people and once for programs.

use serde_json::{Map, Value, json};

use fspid_scenario::aircraft::number::{short, significant};
use fspid_scenario::aircraft::units::{Kind, Units};

/// Significant digits of a quantity in a text.
const DIGITS: usize = 6;

/// What is known, in the order in which it is told.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facts(Vec<Fact>);

#[derive(Clone, Debug, PartialEq)]
struct Fact {
    /// For people; empty for what only programs are told.
    name: String,
    /// For programs, without the unit.
    key: &'static str,
    kind: Kind,
    told: Told,
}

#[derive(Clone, Debug, PartialEq)]
enum Told {
    Number(f64),
    Range(f64, f64),
}

impl Facts {
    /// A quantity in SI.
    pub(super) fn number(mut self, name: &str, key: &'static str, kind: Kind, si: f64) -> Self {
        self.0.push(Fact { name: name.to_owned(), key, kind, told: Told::Number(si) });
        self
    }

    /// A range of a quantity in SI.
    pub(super) fn range(
        mut self,
        name: &str,
        key: &'static str,
        kind: Kind,
        range: fspid_aircraft::Range,
    ) -> Self {
        let told = Told::Range(range.min, range.max);
        self.0.push(Fact { name: name.to_owned(), key, kind, told });
        self
    }

    /// Lines of names, values and units.
    pub(super) fn text(&self, units: Units) -> String {
        let names = self.0.iter().map(|fact| fact.name.chars().count());
        let width = names.max().unwrap_or(0);
        let mut out = String::new();
        for fact in &self.0 {
            let (name, value) = (&fact.name, fact.told(units));
            out.push_str(&format!("  {name:width$}  {value}\n"));
        }
        out
    }

    /// Values by keys that end with their unit.
    pub(super) fn json(&self, units: Units) -> Value {
        let entries = self.0.iter().map(|fact| (fact.key(units), fact.json(units)));
        Value::Object(entries.collect::<Map<String, Value>>())
    }
}

impl Fact {
    fn key(&self, units: Units) -> String {
        key(self.key, self.kind, units)
    }

    fn told(&self, units: Units) -> String {
        let (unit, value) = (units.of(self.kind), |si: f64| units.told(self.kind, si));
        let text = match self.told {
            Told::Number(si) => significant(value(si), DIGITS),
            Told::Range(min, max) if min == f64::NEG_INFINITY && max == f64::INFINITY => {
                return "any".to_owned();
            }
            Told::Range(min, max) => format!("{} to {}", end(value(min)), end(value(max))),
        };
        format!("{text} {}", unit.symbol).trim_end().to_owned()
    }

    fn json(&self, units: Units) -> Value {
        let value = |si: f64| json!(units.told(self.kind, si));
        match self.told {
            Told::Number(si) => value(si),
            Told::Range(min, max) => json!([value(min), value(max)]),
        }
    }
}

/// An end of a range as it was given: rounding of the way to SI and back is no part of it.
fn end(value: f64) -> String {
    short(value, DIGITS)
}

/// A key that ends with the unit of its values.
pub(super) fn key(name: &str, kind: Kind, units: Units) -> String {
    match units.of(kind).key {
        "" => name.to_owned(),
        unit => format!("{name}_{unit}"),
    }
}
