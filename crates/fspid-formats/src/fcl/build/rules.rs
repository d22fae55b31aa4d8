//! Rule blocks.

use fspid_fuzzy::system::{Activation, RuleBlock};
use fspid_fuzzy::{SNormKind, TNormKind};

use crate::fcl::draft::Block;
use crate::fcl::parser::is_section_word;
use crate::lexer::{Kind, Token};
use crate::names::Names;
use crate::report::Report;
use crate::rule;
use fspid_diagnostics::Place;

/// A rule block with its rules, and where each of them begins; `missing_sign` becomes the place of the first rule without `;`.
pub(super) fn block(
    draft: &Block,
    names: &Names,
    missing_sign: &mut Option<Place>,
    report: &mut Report,
) -> (RuleBlock, Vec<Place>) {
    let (mut rules, mut places) = (Vec::new(), Vec::new());
    let (mut and_used, mut or_used) = (None, None);
    for (index, text) in draft.rules.iter().enumerate() {
        let mut reader = rule::Reader::new(text.tokens, names, report, is_section_word);
        let found = reader.rule();
        (and_used, or_used) = (and_used.or(reader.and), or_used.or(reader.or));
        let next = reader.tokens.next;
        if let Some(mut rule) = found {
            rule.name = own_name(text.name, index);
            rules.push(rule);
            places.push(text.tokens.next.place());
            rule_end(next, missing_sign, report);
        }
    }
    let (and, or) = connectives(draft, and_used, or_used, report);
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

fn rule_end(next: Token, missing_sign: &mut Option<Place>, report: &mut Report) {
    if next.kind == Kind::End || is_section_word(next.text) {
        missing_sign.get_or_insert(next.place());
    } else if !next.is(";") {
        report.problem(next.place(), next.text, "does not fit here", "`;`");
    }
}

/// The standard wants *and* and *or* to be mirror images, and needs only one of them.
fn connectives(
    block: &Block,
    and_used: Option<Place>,
    or_used: Option<Place>,
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
