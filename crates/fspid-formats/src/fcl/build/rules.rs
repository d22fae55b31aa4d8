//! Rule blocks.

use fspid_fuzzy::system::{Activation, RuleBlock};
use fspid_fuzzy::{SNormKind, TNormKind};

use crate::fcl::Dialect;
use crate::fcl::connectives::{Connective, pair_of_and, pair_of_or};
use crate::fcl::draft::Block;
use crate::fcl::parser::is_section_word;
use crate::lexer::{Kind, Token};
use crate::names::Names;
use crate::report::Report;
use crate::rule::{self, Manner, Rank};
use fspid_diagnostics::Place;

/// The first rule that does not end with `;`.
pub(super) fn missing_sign(blocks: &[Block]) -> Option<Place> {
    let mut rules = blocks.iter().flat_map(|block| &block.rules);
    rules.find_map(|rule| {
        let mut tokens = rule.tokens;
        while !is_end(tokens.next) && !tokens.next.is(";") {
            tokens.advance();
        }
        is_end(tokens.next).then(|| tokens.next.place())
    })
}

fn is_end(token: Token) -> bool {
    token.kind == Kind::End || is_section_word(token.text)
}

/// A rule block with its rules, and where each of them begins.
pub(super) fn block(
    draft: &Block,
    dialect: Dialect,
    names: &Names,
    report: &mut Report,
) -> (RuleBlock, Vec<Place>) {
    let rank = if dialect == Dialect::JFuzzyLogic { Rank::InTurn } else { Rank::AndFirst };
    let manner = Manner { ends: is_section_word, rank };

    let (mut rules, mut places) = (Vec::new(), Vec::new());
    let (mut and_used, mut or_used) = (None, None);
    for (index, text) in draft.rules.iter().enumerate() {
        let mut reader = rule::Reader::new(text.tokens, names, report, manner);
        let found = reader.rule();
        (and_used, or_used) = (and_used.or(reader.and), or_used.or(reader.or));
        let next = reader.tokens.next;
        if let Some(mut rule) = found {
            rule.name = own_name(text.name, index);
            rules.push(rule);
            places.push(text.tokens.next.place());
            rule_end(next, report);
        }
    }
    let (and, or) = connectives(draft, dialect, [and_used, or_used], report);
    let block = RuleBlock {
        name: draft.name.clone(),
        description: String::new(),
        enabled: draft.enabled,
        and: and.into(),
        or: or.into(),
        implication: draft.act.unwrap_or(TNormKind::Minimum).into(),
        activation: Activation::General,
        rules,
    };
    (block, places)
}

/// A number that only counts is no name.
fn own_name(name: &str, index: usize) -> String {
    if name == (index + 1).to_string() { String::new() } else { name.into() }
}

fn rule_end(next: Token, report: &mut Report) {
    if !is_end(next) && !next.is(";") {
        report.problem(next.place(), next.text, "does not fit here", "`;`");
    }
}

/// The connectives by what a dialect makes of the statements of a block.
fn connectives(
    block: &Block,
    dialect: Dialect,
    used: [Option<Place>; 2],
    report: &mut Report,
) -> (TNormKind, SNormKind) {
    let pair = match block.last.filter(|_| dialect == Dialect::JFuzzyLogic) {
        Some(Connective::And) => block.and.and_then(|and| pair_of_and(&and.into())),
        Some(Connective::Or) => block.or.and_then(|or| pair_of_or(&or.into())),
        None => None,
    };
    let Some(pair) = pair else { return mirror_images(block, used, report) };
    let other =
        block.and.is_some_and(|and| and != pair.and) || block.or.is_some_and(|or| or != pair.or);
    if other {
        let message = format!(
            "jFuzzyLogic takes both connectives from the last of AND and OR: {} and {}",
            pair.and_word, pair.or_word
        );
        report.note(block.start.place(), message);
    }
    (pair.and, pair.or)
}

/// The standard wants *and* and *or* to be mirror images, and needs only one of them.
fn mirror_images(
    block: &Block,
    [and_used, or_used]: [Option<Place>; 2],
    report: &mut Report,
) -> (TNormKind, SNormKind) {
    let place = block.start.place();
    let mirror = |or| TNormKind::ALL.iter().copied().find(|and| and.dual() == or);
    let and = block.and.or(block.or.and_then(mirror)).unwrap_or(TNormKind::Minimum);
    let or = block.or.unwrap_or(and.dual());
    if block.and.is_some() && block.or.is_some() && and.dual() != or {
        let message =
            format!("`and` ({}) and `or` ({}) are no pair by De Morgan", and.name(), or.name());
        report.note(place, message);
    }
    if let (None, Some(used)) = (block.and, and_used) {
        report.note(used, format!("no AND is given; {} is assumed", and.name()));
    }
    if let (None, Some(used)) = (block.or, or_used) {
        report.note(used, format!("no OR is given; {} is assumed", or.name()));
    }
    (and, or)
}
