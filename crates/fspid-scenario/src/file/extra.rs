//! What is asked of a scenario from outside of its file: changes, ready sets, files of requirements.

use crate::file::files::Files;
use crate::keyed::check;
use crate::keyed::document::{self, Item, Member, Value};
use crate::requirement::SET_NAMES;
use crate::requirement::keys;
use crate::requirement::keys::REQUIREMENT_FILE;
use fspid_diagnostics::{Report, Span, excerpt, nearest};

/// Everything that comes from outside of a scenario's file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extra<'a> {
    /// Changes such as `controller.FSPID.nominal.kp=2.5`, applied before the check.
    pub overrides: &'a [String],
    /// Ready sets with their choices, such as `mil-f-8785c:level=2,category=C`.
    pub sets: &'a [String],
    /// Files of requirements: their names and texts.
    pub requirement_files: &'a [(String, String)],
}

/// Adds requirements to the document, where the check finds them with all others.
pub(super) fn apply(
    report: &mut Report,
    files: &mut Files<'_>,
    document: &mut Item,
    extra: &Extra<'_>,
) {
    let mut entries = Vec::new();
    for text in extra.sets {
        files.digest(text);
        entries.extend(set_entry(report, text));
    }
    for (name, text) in extra.requirement_files {
        files.digest(text);
        entries.extend(file_entries(report, name, text));
    }
    if !entries.is_empty() {
        append(document, entries);
    }
}

/// Puts entries behind those of the file; what the file has in their place is left for the check.
fn append(document: &mut Item, entries: Vec<Item>) {
    let Value::Table(members) = &mut document.value else {
        return;
    };
    match members.iter_mut().find(|member| member.name == "requirement") {
        Some(member) => {
            if let Value::Array(items) = &mut member.item.value {
                items.extend(entries);
            }
        }
        None => {
            let place = entries.first().map_or(document.place, |entry| entry.place);
            let item = Item { place, value: Value::Array(entries) };
            members.push(Member { name: "requirement".to_owned(), place, item });
        }
    }
}

/// The entry of `NAME` or `NAME:key=value,key=value`.
fn set_entry(report: &mut Report, text: &str) -> Option<Item> {
    let origin = format!("--set {}", excerpt(text));
    let (name, choices) = text.split_once(':').unwrap_or((text, ""));
    let name = name.trim();
    let source = report.add_source(Some(origin.clone()), text);
    let place = Span { source, start: 0, end: text.len() };
    if !SET_NAMES.contains(&name) {
        let meant = nearest(name, &SET_NAMES).map(|meant| format!("; did you mean \"{meant}\"?"));
        let message = format!("unknown set{}", meant.unwrap_or_default());
        let allowed = format!("a ready set: {}; or a change: path=value", SET_NAMES.join(", "));
        report.value(place, "", message, allowed);
        return None;
    }
    let value = Value::Text(name.to_owned());
    let mut members = vec![Member { name: "set".to_owned(), place, item: Item { place, value } }];
    for choice in choices.split(',').map(str::trim).filter(|choice| !choice.is_empty()) {
        let Some((key, value)) = choice.split_once('=') else {
            let allowed = "choices such as level=2,category=C";
            report.value(place, "", format!("`{}` has no `=`", excerpt(choice)), allowed);
            return None;
        };
        if members.iter().any(|member| member.name == key.trim()) {
            let message = format!("`{}` is chosen twice", excerpt(key.trim()));
            report.value(place, "", message, "each choice once");
            return None;
        }
        let item = document::read_value(report, origin.clone(), value.trim())?;
        members.push(Member { name: key.trim().to_owned(), place: item.place, item });
    }
    Some(Item { place, value: Value::Table(members) })
}

/// The entries of a file of requirements.
fn file_entries(report: &mut Report, name: &str, text: &str) -> Vec<Item> {
    let document = document::read(report, Some(name.to_owned()), text);
    let section = document.and_then(|item| check::table(report, &REQUIREMENT_FILE, &item, ""));
    let Some(list) = section.as_ref().and_then(|section| section.get(keys::REQUIREMENT)) else {
        return Vec::new();
    };
    match &list.value {
        Value::Array(items) if !items.is_empty() => items.clone(),
        _ => {
            let allowed = "tables under [[requirement]] in double brackets";
            report.missing(list.place, "requirement", "there is none", allowed);
            Vec::new()
        }
    }
}
