//! Outputs without a `DEFUZZIFY` section: the rest of the system is read as far as it goes.

use std::collections::BTreeSet;

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Rule, RuleBlock, Variable as About};

use crate::fcl::draft::{Block, Role, Set, Term, Variable};
use crate::lexer::{Kind, Token};
use crate::report::Report;

/// Puts the outputs that have no section last and gives them the terms that rules name; answers how
/// many there are.
pub(super) fn without_a_section<'a>(
    variables: &mut Vec<Variable<'a>>,
    blocks: &[Block<'a>],
    report: &mut Report,
) -> usize {
    let is_without =
        |variable: &Variable| variable.role == Role::Output && variable.section.is_none();
    let (without, with): (Vec<_>, Vec<_>) = variables.drain(..).partition(is_without);
    let count = without.len();
    variables.extend(with);
    for mut variable in without {
        let name = variable.name;
        let message = format!(
            "`{}` has no DEFUZZIFY section: it is left out, and what rules conclude about it",
            name.text
        );
        report.note(name.place(), message);
        variable.terms = terms(name, blocks);
        variables.push(variable);
    }
    count
}

/// The terms of a variable that rules name.
fn terms<'a>(name: Token<'a>, blocks: &[Block<'a>]) -> Vec<Term<'a>> {
    let mut found: Vec<Term> = Vec::new();
    let mut seen = BTreeSet::new();
    for rule in blocks.iter().flat_map(|block| &block.rules) {
        let mut tokens = rule.tokens;
        while tokens.next.kind != Kind::End && !tokens.next.is_any(&[";", "END_RULEBLOCK", "RULE"])
        {
            let asked = tokens.advance().is(name.text) && tokens.eat("is");
            if !asked {
                continue;
            }
            while Hedge::from_name(&tokens.next.text.to_ascii_lowercase()).is_some() {
                tokens.advance();
            }
            let term = tokens.next;
            if term.kind == Kind::Word && seen.insert(term.text.to_lowercase()) {
                found.push(Term { name: term, set: Set::Unknown });
            }
        }
    }
    found
}

/// Leaves out what is said about outputs behind the last of `variables`.
pub(super) fn leave_out(rules: &mut [RuleBlock], variables: &[Variable], report: &mut Report) {
    let outputs = variables.iter().filter(|variable| variable.is_output()).count();
    let mut gone = 0;
    for block in rules {
        let before = block.rules.len();
        block.rules.retain_mut(|rule| keeps(rule, outputs));
        gone += before - block.rules.len();
    }
    if gone > 0 {
        report.note_whole(format!("{gone} rules about outputs that are left out are left out"));
    }
}

fn keeps(rule: &mut Rule, outputs: usize) -> bool {
    rule.consequents.retain(|consequent| consequent.output < outputs);
    !rule.consequents.is_empty() && !asks_beyond(&rule.antecedent, outputs)
}

/// True if a condition asks about an output that is not there.
fn asks_beyond(antecedent: &Antecedent, outputs: usize) -> bool {
    antecedent.asks(&|variable| matches!(variable, About::Output(output) if output >= outputs))
}
