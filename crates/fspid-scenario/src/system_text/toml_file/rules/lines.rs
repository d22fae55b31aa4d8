//! Rules in words, one a line.

use fspid_formats::rule_text::{self, RuleReader};
use fspid_fuzzy::system::{Parts, Rule, RuleBlock};

use super::super::fields::Fields;
use super::super::formula::within;
use super::{Vocabulary, grid, tree};
use crate::keyed::document::{Item, Value as Written};
use crate::toml_text::quoted;
use fspid_diagnostics::{Report, Span};

/// The rules of a text or list, with their places.
pub(super) fn read(
    report: &mut Report,
    item: &Item,
    path: &str,
    vocabulary: Vocabulary<'_>,
) -> Option<Vec<(Rule, Span)>> {
    let before = report.count();
    let mut rules = Vec::new();
    match &item.value {
        Written::Text(_) => {
            let lines = grid::lines_of(report.text(item.place), item.place);
            for (place, line) in lines.iter().filter(|(_, line)| !line.trim().starts_with('#')) {
                rules.extend(
                    in_words(report, (*place, path), line, vocabulary).map(|r| (r, *place)),
                );
            }
        }
        Written::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                let path = format!("{path}[{index}]");
                rules.extend(one(report, item, &path, vocabulary).map(|rule| (rule, item.place)));
            }
        }
        _ => {
            let message = format!("expected rules, not {}", item.value.type_name());
            report.value(item.place, path, message, super::in_words());
        }
    }
    (report.count() == before).then_some(rules)
}

/// A rule of a list: a text, or a table with its name and switch.
fn one(report: &mut Report, item: &Item, path: &str, vocabulary: Vocabulary<'_>) -> Option<Rule> {
    if let Written::Text(text) = &item.value {
        return in_words(report, (item.place, path), text, vocabulary);
    }
    let mut fields = Fields::of(report, item, path, &super::in_words())?;
    let is_tree = fields.get("when").is_some();
    let own: &[&str] = if is_tree { &["when", "then", "weight"] } else { &["rule"] };
    let mut known = vec!["name", "enabled"];
    known.extend(own);
    fields.only(&known);
    let rule = if is_tree {
        tree::read(&mut fields, vocabulary)?
    } else {
        let text = fields.text("rule", &super::in_words())?;
        let place = fields.get("rule")?.item.place;
        in_words(fields.report, (place, path), text, vocabulary)?
    };
    let name = match fields.get("name") {
        Some(_) => fields.text("name", "a text in quotes")?.to_owned(),
        None => String::new(),
    };
    let enabled = match fields.get("enabled").map(|member| &member.item) {
        None => true,
        Some(Item { value: Written::Boolean(enabled), .. }) => *enabled,
        Some(item) => {
            fields.wrong(item, "enabled", "not a switch", "true or false");
            return None;
        }
    };
    Some(Rule { name, enabled, ..rule })
}

/// A rule in words; what is wrong is told at its own word.
fn in_words(
    report: &mut Report,
    (place, path): (Span, &str),
    text: &str,
    vocabulary: Vocabulary<'_>,
) -> Option<Rule> {
    let problems = match vocabulary.reader.read(text) {
        Ok(rule) => return Some(rule),
        Err(problems) => problems.list,
    };
    for problem in problems {
        let position = problem.place.map_or(0, |at| at.byte_in(text));
        let word = problem.found.len();
        let place = within(report.text(place), text, place, (position, word));
        if problem.found.is_empty() {
            report.missing(place, path, problem.message, problem.allowed);
        } else {
            report.value(place, path, problem.message, problem.allowed);
        }
    }
    None
}

/// The rules of a block as a list.
pub(super) fn write(block: &RuleBlock, parts: &Parts) -> String {
    let reader = RuleReader::new(&parts.inputs, &parts.outputs);
    let line = |rule| format!("    {},\n", written(rule, parts, &reader));
    let lines: Vec<String> = block.rules.iter().map(line).collect();
    match lines.is_empty() {
        true => "lines = []\n".to_owned(),
        false => format!("lines = [\n{}]\n", lines.concat()),
    }
}

fn written(rule: &Rule, parts: &Parts, reader: &RuleReader) -> String {
    let plain = Rule { name: String::new(), enabled: true, ..rule.clone() };
    let words = words_of(&plain, parts, reader);
    if let (Some(words), true, true) = (&words, rule.enabled, rule.name.is_empty()) {
        return quoted(words);
    }
    let mut pairs = Vec::new();
    if !rule.name.is_empty() {
        pairs.push(format!("name = {}", quoted(&rule.name)));
    }
    if !rule.enabled {
        pairs.push("enabled = false".to_owned());
    }
    match words {
        Some(words) => pairs.push(format!("rule = {}", quoted(&words))),
        None => pairs.extend(tree::write(rule, parts)),
    }
    format!("{{ {} }}", pairs.join(", "))
}

/// The rule in words, if it has words that are read back as the same rule.
fn words_of(rule: &Rule, parts: &Parts, reader: &RuleReader) -> Option<String> {
    let words = rule_text::write(rule, parts).ok()?;
    reader.read(&words).is_ok_and(|found| found == *rule).then_some(words)
}
