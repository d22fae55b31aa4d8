//! Tables whose keys depend on what is in them: checked key by key, with every problem reported.

use crate::keyed::document::{Item, Member, Value};
use fspid_diagnostics::{Report, Span, excerpt, nearest};

/// The members of a table in the order in which they are written.
pub(super) fn in_order(members: &[Member]) -> Vec<&Member> {
    let mut members: Vec<&Member> = members.iter().collect();
    members.sort_by_key(|member| member.place.start);
    members
}

/// The path of a key below another.
pub(super) fn below(path: &str, name: &str) -> String {
    let is_bare = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.chars().all(is_bare) {
        format!("{path}.{name}")
    } else {
        format!("{path}.\"{}\"", excerpt(name))
    }
}

/// A table that is being read.
pub(super) struct Fields<'a> {
    pub(super) report: &'a mut Report,
    pub(super) members: &'a [Member],
    pub(super) place: Span,
    pub(super) path: &'a str,
}

impl<'a> Fields<'a> {
    /// The table in `item`; `allowed` says what should be there.
    pub(super) fn of(
        report: &'a mut Report,
        item: &'a Item,
        path: &'a str,
        allowed: &str,
    ) -> Option<Self> {
        let Value::Table(members) = &item.value else {
            let message = format!("expected a table, not {}", item.value.type_name());
            report.value(item.place, path, message, allowed);
            return None;
        };
        Some(Self { report, members, place: item.place, path })
    }

    pub(super) fn get(&self, name: &str) -> Option<&'a Member> {
        self.members.iter().find(|member| member.name == name)
    }

    /// The value of a key that must be there.
    pub(super) fn required(&mut self, name: &str, allowed: &str) -> Option<&'a Item> {
        let found = self.get(name).map(|member| &member.item);
        if found.is_none() && !self.is_mistyped(name) {
            self.report.missing(self.place, &below(self.path, name), "missing key", allowed);
        }
        found
    }

    /// A key that is there under a mistyped name is not missed as well.
    fn is_mistyped(&self, name: &str) -> bool {
        let known = [name];
        self.members.iter().any(|member| nearest(&member.name, &known).is_some())
    }

    /// A finite number that must be there.
    pub(super) fn number(&mut self, name: &str, allowed: &str) -> Option<f64> {
        let item = self.required(name, allowed)?;
        let found = any_number(item).filter(|value| value.is_finite());
        if found.is_none() {
            self.wrong(item, name, "not a finite number", allowed);
        }
        found
    }

    /// A text that must be there.
    pub(super) fn text(&mut self, name: &str, allowed: &str) -> Option<&'a str> {
        let item = self.required(name, allowed)?;
        let Value::Text(text) = &item.value else {
            self.wrong(item, name, "not a text", allowed);
            return None;
        };
        Some(text)
    }

    /// A value that is not what it should be.
    pub(super) fn wrong(&mut self, item: &Item, name: &str, message: &str, allowed: &str) {
        self.report.value(item.place, &below(self.path, name), message, allowed);
    }

    /// Reports every key that is not known.
    pub(super) fn only(&mut self, known: &[&str]) {
        for member in self.members.iter().filter(|m| !known.contains(&m.name.as_str())) {
            let meant = nearest(&member.name, known);
            let message = match meant {
                Some(meant) => format!("unknown key; did you mean `{meant}`?"),
                None => "unknown key".to_owned(),
            };
            self.report.missing(
                member.place,
                &below(self.path, &member.name),
                message,
                known.join(", "),
            );
        }
    }
}

/// A number, finite or not.
pub(super) fn any_number(item: &Item) -> Option<f64> {
    match item.value {
        Value::Integer(value, _) | Value::Float(value) => Some(value),
        _ => None,
    }
}

/// A word out of a list; an unknown one is reported with the one that was probably meant.
pub(super) fn word<'k>(
    report: &mut Report,
    (place, path): (Span, &str),
    text: &str,
    (what, known): (&str, &[&'k str]),
) -> Option<&'k str> {
    let found = known.iter().copied().find(|word| *word == text);
    if found.is_none() {
        let meant = nearest(text, known).map(|meant| format!("; did you mean `{meant}`?"));
        let message = format!("unknown {what}{}", meant.unwrap_or_default());
        report.value(place, path, message, known.join(", "));
    }
    found
}
