//! Rules and statements for people; not to be read back.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Consequent, Parts, Rule, Statement, Variable};

/// The rule in words: `if service is poor or food is rancid then tip is cheap with 0.5`.
pub(super) fn rule(rule: &Rule, parts: &Parts) -> String {
    let then: Vec<String> = rule.consequents.iter().map(|c| consequent(c, parts)).collect();
    let weight = match rule.weight < 1.0 {
        true => format!(" with {}", rule.weight),
        false => String::new(),
    };
    format!("if {} then {}{weight}", condition(&rule.antecedent, parts, 0), then.join(" and "))
}

/// A condition; in brackets where what is around it binds tighter.
fn condition(antecedent: &Antecedent, parts: &Parts, around: u8) -> String {
    let joined = |list: &[Antecedent], word: &str, own: u8| {
        let inner: Vec<String> = list.iter().map(|part| condition(part, parts, own + 1)).collect();
        let text = inner.join(word);
        if around > own && list.len() > 1 { format!("({text})") } else { text }
    };
    match antecedent {
        Antecedent::Always => "always".to_owned(),
        Antecedent::Is(found) => statement(found, parts),
        Antecedent::Any(list) => joined(list, " or ", 0),
        Antecedent::All(list) => joined(list, " and ", 1),
        Antecedent::Not(part) => format!("not {}", condition(part, parts, 2)),
    }
}

/// The statement in words: `service is very poor`.
pub(super) fn statement(statement: &Statement, parts: &Parts) -> String {
    let (name, term) = match statement.variable {
        Variable::Input(index) => {
            let input = parts.inputs.get(index);
            let term = statement.term.and_then(|term| input?.terms.get(term));
            (input.map(|input| &input.name), term.map(|term| &term.name))
        }
        Variable::Output(index) => {
            let output = parts.outputs.get(index);
            let term = statement.term.and_then(|term| output?.terms.get(term));
            (output.map(|output| &output.name), term.map(|term| &term.name))
        }
    };
    clause(name, &statement.hedges, term)
}

fn consequent(consequent: &Consequent, parts: &Parts) -> String {
    let output = parts.outputs.get(consequent.output);
    let term = output.and_then(|output| output.terms.get(consequent.term));
    clause(output.map(|o| &o.name), &consequent.hedges, term.map(|term| &term.name))
}

fn clause(name: Option<&String>, hedges: &[Hedge], term: Option<&String>) -> String {
    let mut words = vec![name.map_or("", String::as_str).to_owned(), "is".to_owned()];
    words.extend(hedges.iter().map(|hedge| match hedge {
        Hedge::Power(power) => format!("(to the power {power})"),
        named => named.name().to_owned(),
    }));
    words.extend(term.cloned());
    words.join(" ")
}

/// What a rule is called: its name, or its number, with its block where there are several.
pub(super) fn name(parts: &Parts, block: usize, rule: usize) -> String {
    let found = parts.blocks.get(block);
    let own = found.and_then(|block| block.rules.get(rule)).map_or("", |rule| &rule.name);
    let own = if own.is_empty() { format!("rule {}", rule + 1) } else { own.to_owned() };
    match (parts.blocks.len(), found.map_or("", |block| &block.name)) {
        (1, _) => own,
        (_, "") => format!("block {}, {own}", block + 1),
        (_, name) => format!("{name}, {own}"),
    }
}
