//! Rules as tables, for what the words of a rule cannot say: names that are no words, powers.
//!
//! `{ when = { all = [{ input = "x", is = "low" }, { not = … }] }, then = [{ output = "y", is = "high" }] }`

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Consequent, Parts, Rule, Statement, Variable};

use super::super::fields::{Fields, any_number, below, word};
use super::super::write::number;
use super::Vocabulary;
use crate::keyed::document::{Item, Value as Written};
use crate::toml_text::quoted;
use fspid_diagnostics::Report;

/// Deepest nesting that is read; the system's own limit is lower.
const DEPTH: usize = 200;

/// The rule in a table with `when`, `then` and perhaps `weight`.
pub(super) fn read(fields: &mut Fields<'_>, vocabulary: Vocabulary<'_>) -> Option<Rule> {
    let when = fields.required("when", "a condition")?;
    let path = below(fields.path, "when");
    let antecedent = antecedent(fields.report, when, &path, (vocabulary, 0));
    let then = fields.required("then", "a list of conclusions")?;
    let path = below(fields.path, "then");
    let consequents = list(fields.report, then, &path, |report, item, path| {
        consequent(report, item, path, vocabulary)
    });
    let weight = match fields.get("weight") {
        Some(_) => fields.number("weight", "a number from 0 to 1")?,
        None => 1.0,
    };
    Some(Rule {
        name: String::new(),
        enabled: true,
        antecedent: antecedent?,
        consequents: consequents?,
        weight,
    })
}

/// Every item of a list; nothing if one of them is wrong.
fn list<T>(
    report: &mut Report,
    item: &Item,
    path: &str,
    mut one: impl FnMut(&mut Report, &Item, &str) -> Option<T>,
) -> Option<Vec<T>> {
    let Written::Array(items) = &item.value else {
        report.value(item.place, path, "not a list", "a list");
        return None;
    };
    let read: Vec<Option<T>> = items
        .iter()
        .enumerate()
        .map(|(index, item)| one(report, item, &format!("{path}[{index}]")))
        .collect();
    read.into_iter().collect()
}

const CONDITIONS: &str = "\"always\", { all = [ … ] }, { any = [ … ] }, { not = … }, \
                          { input = \"…\", is = \"…\" } or { output = \"…\", is = \"…\" }";

fn antecedent(
    report: &mut Report,
    item: &Item,
    path: &str,
    (vocabulary, depth): (Vocabulary<'_>, usize),
) -> Option<Antecedent> {
    let inner = (vocabulary, depth + 1);
    if matches!(&item.value, Written::Text(text) if text == "always") {
        return Some(Antecedent::Always);
    }
    if depth > DEPTH {
        report.missing(item.place, path, "nested too deeply", "");
        return None;
    }
    let mut fields = Fields::of(report, item, path, CONDITIONS)?;
    for (name, join) in [("all", Antecedent::All as fn(_) -> _), ("any", Antecedent::Any)] {
        if let Some(member) = fields.get(name) {
            fields.only(&[name]);
            let path = below(path, name);
            let parts = list(fields.report, &member.item, &path, |report, item, path| {
                antecedent(report, item, path, inner)
            });
            return parts.map(join);
        }
    }
    if let Some(member) = fields.get("not") {
        fields.only(&["not"]);
        let part = antecedent(fields.report, &member.item, &below(path, "not"), inner)?;
        return Some(Antecedent::Not(Box::new(part)));
    }
    statement(&mut fields, vocabulary).map(Antecedent::Is)
}

fn statement(fields: &mut Fields<'_>, vocabulary: Vocabulary<'_>) -> Option<Statement> {
    let of_output = fields.get("output").is_some();
    fields.only(&[if of_output { "output" } else { "input" }, "is", "hedges"]);
    let (variable, terms) = if of_output {
        let (output, terms) = output(fields, vocabulary)?;
        (Variable::Output(output), terms)
    } else {
        let (input, terms) = input(fields, vocabulary)?;
        (Variable::Input(input), terms)
    };
    let hedges = hedges(fields)?;
    let term = match fields.get("is") {
        Some(_) => Some(one_of(fields, "is", ("term", &terms))?),
        None => None,
    };
    Some(Statement { variable, term, hedges })
}

fn consequent(
    report: &mut Report,
    item: &Item,
    path: &str,
    vocabulary: Vocabulary<'_>,
) -> Option<Consequent> {
    let mut fields = Fields::of(report, item, path, "{ output = \"…\", is = \"…\" }")?;
    fields.only(&["output", "is", "hedges"]);
    let (output, terms) = output(&mut fields, vocabulary)?;
    let hedges = hedges(&mut fields)?;
    let term = one_of(&mut fields, "is", ("term", &terms))?;
    Some(Consequent { output, term, hedges })
}

/// The position of a variable, and the names of its terms.
type Found<'a> = (usize, Vec<&'a str>);

fn input<'a>(fields: &mut Fields<'_>, vocabulary: Vocabulary<'a>) -> Option<Found<'a>> {
    let known: Vec<&str> = vocabulary.inputs.iter().map(|input| input.name.as_str()).collect();
    let position = one_of(fields, "input", ("input", &known))?;
    let terms = &vocabulary.inputs.get(position)?.terms;
    Some((position, terms.iter().map(|term| term.name.as_str()).collect()))
}

fn output<'a>(fields: &mut Fields<'_>, vocabulary: Vocabulary<'a>) -> Option<Found<'a>> {
    let known: Vec<&str> = vocabulary.outputs.iter().map(|output| output.name.as_str()).collect();
    let position = one_of(fields, "output", ("output", &known))?;
    let terms = &vocabulary.outputs.get(position)?.terms;
    Some((position, terms.iter().map(|term| term.name.as_str()).collect()))
}

/// The position of the word at a key among those that are known.
fn one_of(fields: &mut Fields<'_>, name: &str, (what, known): (&str, &[&str])) -> Option<usize> {
    let text = fields.text(name, &known.join(", "))?;
    let place = fields.get(name)?.item.place;
    let path = below(fields.path, name);
    word(fields.report, (place, &path), text, (what, known))?;
    known.iter().position(|known| *known == text)
}

fn hedges(fields: &mut Fields<'_>) -> Option<Vec<Hedge>> {
    let Some(member) = fields.get("hedges") else { return Some(Vec::new()) };
    let path = below(fields.path, "hedges");
    list(fields.report, &member.item, &path, hedge)
}

/// A hedge by its name, or a power by its number.
fn hedge(report: &mut Report, item: &Item, path: &str) -> Option<Hedge> {
    let known: Vec<&str> = Hedge::NAMED.iter().map(|hedge| hedge.name()).collect();
    let found = match (&item.value, any_number(item)) {
        (Written::Text(text), _) => Hedge::from_name(text),
        (_, Some(power)) => Hedge::power(power).ok(),
        _ => None,
    };
    if found.is_none() {
        let allowed = format!("{}, or a power above 0", known.join(", "));
        report.value(item.place, path, "no hedge", allowed);
    }
    found
}

/// The keys of the rule, without name and switch.
pub(super) fn write(rule: &Rule, parts: &Parts) -> Vec<String> {
    let conclusions: Vec<String> = rule
        .consequents
        .iter()
        .map(|found| clause(Variable::Output(found.output), Some(found.term), &found.hedges, parts))
        .collect();
    let mut pairs = vec![
        format!("when = {}", condition(&rule.antecedent, parts)),
        format!("then = [{}]", conclusions.join(", ")),
    ];
    if rule.weight < 1.0 {
        pairs.push(format!("weight = {}", number(rule.weight)));
    }
    pairs
}

fn condition(antecedent: &Antecedent, parts: &Parts) -> String {
    let joined = |word: &str, list: &[Antecedent]| {
        let written: Vec<String> = list.iter().map(|part| condition(part, parts)).collect();
        format!("{{ {word} = [{}] }}", written.join(", "))
    };
    match antecedent {
        Antecedent::Always => quoted("always"),
        Antecedent::All(list) => joined("all", list),
        Antecedent::Any(list) => joined("any", list),
        Antecedent::Not(part) => format!("{{ not = {} }}", condition(part, parts)),
        Antecedent::Is(found) => clause(found.variable, found.term, &found.hedges, parts),
    }
}

fn clause(variable: Variable, term: Option<usize>, hedges: &[Hedge], parts: &Parts) -> String {
    let (kind, name, term) = match variable {
        Variable::Input(index) => {
            let input = parts.inputs.get(index);
            let term = term.and_then(|term| input?.terms.get(term)).map(|term| &term.name);
            ("input", input.map(|input| &input.name), term)
        }
        Variable::Output(index) => {
            let output = parts.outputs.get(index);
            let term = term.and_then(|term| output?.terms.get(term)).map(|term| &term.name);
            ("output", output.map(|output| &output.name), term)
        }
    };
    let mut pairs = vec![format!("{kind} = {}", quoted(name.map_or("", String::as_str)))];
    if !hedges.is_empty() {
        let words: Vec<String> = hedges.iter().map(|hedge| hedge_in_words(*hedge)).collect();
        pairs.push(format!("hedges = [{}]", words.join(", ")));
    }
    pairs.extend(term.map(|term| format!("is = {}", quoted(term))));
    format!("{{ {} }}", pairs.join(", "))
}

fn hedge_in_words(hedge: Hedge) -> String {
    match hedge {
        Hedge::Power(power) => number(power),
        named => quoted(named.name()),
    }
}
