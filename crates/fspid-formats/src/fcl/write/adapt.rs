//! The nearest system that a dialect can say.

use std::collections::BTreeSet;

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Activation, Conclusion, Defuzzifier, FallbackValue, Input, Membership, Output, OutputTerm,
    Parts, RuleBlock, Sampling,
};

use super::set;
use crate::adapt::{numbered_fallback, sampled, without_disabled_rules};
use crate::fcl::Dialect;
use crate::fcl::connectives::{self, Uses};
use crate::fcl::option::ADDS;
use crate::fcl::parser::is_section_word;
use crate::identifiers::{self, is_plain};
use crate::loss::Loss;
use crate::repeated;
use crate::rule::{RESERVED, arrange};

const NAMES: identifiers::Rule = identifiers::Rule {
    readable,
    documented: is_plain,
    description: "letters, digits and underscores, a digit not first",
};

/// A name that our reader reads back.
pub(super) fn readable(name: &str) -> bool {
    let reserved = RESERVED.iter().any(|word| word.eq_ignore_ascii_case(name));
    name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_alphanumeric() || c == '_')
        && !reserved
        && !is_section_word(name)
}

pub(super) fn adapted(parts: &Parts, dialect: Dialect, loss: &mut Loss) -> Parts {
    let mut parts = parts.clone();
    NAMES.apply(&mut parts, loss);
    case(&parts, loss);
    without_disabled_rules(&mut parts, loss);
    headings(&mut parts, dialect, loss);
    parts.inputs.iter_mut().for_each(|input| self::input(input, dialect, loss));
    parts.outputs.iter_mut().for_each(|output| self::output(output, dialect, loss));
    for block in &mut parts.blocks {
        self::block(block, loss);
        if dialect == Dialect::JFuzzyLogic {
            pair(block, loss);
        }
    }
    match dialect {
        Dialect::Fuzzylite => arrange(&mut parts, loss),
        Dialect::Iec => added(&parts, loss),
        Dialect::JFuzzyLogic => {}
    }
    parts
}

/// The standard has no word for adding equal conclusions up.
fn added(parts: &Parts, loss: &mut Loss) {
    for (index, output) in parts.outputs.iter().enumerate() {
        if repeated::adds_up(parts, index) {
            loss.note(format!(
                "`{}`: rules that conclude the same are added up, for which the standard has no word: {ADDS} says so to \
                 fspid, and other tools join them by ACCU",
                output.name
            ));
        }
    }
}

/// To the standard, names that differ in case only are the same.
fn case(parts: &Parts, loss: &mut Loss) {
    let mut seen = BTreeSet::new();
    let names = parts.inputs.iter().map(|i| &i.name).chain(parts.outputs.iter().map(|o| &o.name));
    for name in names {
        if !seen.insert(name.to_lowercase()) {
            loss.note(format!("`{name}` differs from another name in case only"));
        }
    }
}

/// Names of the system, its blocks and rules; blocks that are switched off.
fn headings(parts: &mut Parts, dialect: Dialect, loss: &mut Loss) {
    if !readable(&parts.name) {
        loss.note(format!("the name `{}` is written as `controller`", parts.name));
        parts.name = "controller".into();
    }
    if dialect != Dialect::Fuzzylite {
        let before = parts.blocks.len();
        parts.blocks.retain(|block| block.enabled);
        if parts.blocks.len() < before {
            loss.note("rule blocks that are switched off are left out");
        }
    }
    for (index, block) in parts.blocks.iter_mut().enumerate() {
        let missing = block.name.is_empty() && dialect == Dialect::Fuzzylite;
        if !missing && !is_block_name(&block.name) {
            let new = format!("Block{}", index + 1);
            if !block.name.is_empty() {
                loss.note(format!("the name `{}` is written as `{new}`", block.name));
            }
            block.name = new;
        }
        for rule in &mut block.rules {
            if !rule.name.is_empty() && !is_rule_name(&rule.name) {
                loss.note(format!("the rule's name `{}` is left out", rule.name));
                rule.name.clear();
            }
        }
    }
}

/// Not a word that begins a statement.
fn is_block_name(name: &str) -> bool {
    let statements = ["ACT", "ACCU", "ENABLED"];
    readable(name) && !statements.iter().any(|word| word.eq_ignore_ascii_case(name))
}

fn is_rule_name(name: &str) -> bool {
    readable(name) || name.chars().all(|c| c.is_ascii_digit())
}

fn input(input: &mut Input, dialect: Dialect, loss: &mut Loss) {
    for term in &mut input.terms {
        let what = format!("{}.{}", input.name, term.name);
        if term.lower.is_some() {
            loss.cannot(&what, "a type-2 set has no words in FCL", crate::adapt::TYPE_1);
        }
        set::adapt(&what, &mut term.membership, input.universe, dialect, loss);
    }
    if dialect == Dialect::Iec {
        return;
    }
    let kept = dialect == Dialect::Fuzzylite && input.out_of_range == OutOfRange::Clamp;
    if !kept && input.out_of_range != OutOfRange::Evaluate {
        loss.lose(&input.name, "moves or refuses values outside its range", "it takes any value");
        input.out_of_range = OutOfRange::Evaluate;
    }
    if dialect == Dialect::JFuzzyLogic {
        if input.universe.take().is_some() {
            loss.note(format!("`{}`: the range of an input is left out", input.name));
        }
        enabled(&input.name, input.enabled, loss);
    }
}

fn enabled(name: &str, enabled: bool, loss: &mut Loss) {
    if !enabled {
        let expected = "the standard's or fuzzylite's dialect";
        loss.cannot(name, "is switched off, which has no words in this dialect", expected);
    }
}

fn output(output: &mut Output, dialect: Dialect, loss: &mut Loss) {
    let weighs = output.defuzzifier.sampling().is_none();
    for term in &mut output.terms {
        let what = format!("{}.{}", output.name, term.name);
        match &mut term.conclusion {
            Conclusion::Set { membership, lower } => {
                if lower.is_some() {
                    let message = "a type-2 set has no words in FCL";
                    loss.cannot(&what, message, crate::adapt::TYPE_1);
                }
                if weighs {
                    set::adapt_weighed(&what, membership, dialect, loss);
                } else {
                    set::adapt(&what, membership, output.universe, dialect, loss);
                }
            }
            Conclusion::Interval(_) => {
                let message = "an interval has no words in FCL";
                loss.cannot(&what, message, crate::adapt::TYPE_1);
            }
            Conclusion::Constant(_) | Conclusion::Linear { .. } | Conclusion::Formula(_) => {}
        }
    }
    integrals(output, dialect, loss);
    if dialect == Dialect::Iec {
        return;
    }
    numbered_fallback(output);
    if dialect == Dialect::JFuzzyLogic {
        limits(output, loss);
        enabled(&output.name, output.enabled, loss);
    }
}

/// The *and* and *or* of a block, of which jFuzzyLogic knows pairs alone: those that its rules use decide.
fn pair(block: &mut RuleBlock, loss: &mut Loss) {
    let uses = Uses::of(&block.rules);
    let pair_of_or = connectives::pair_of_or(&block.or);
    let found = match (uses.and, uses.or) {
        (false, false) => Some(connectives::pair_of_and(&block.and).unwrap_or_default()),
        (false, true) => pair_of_or,
        (true, _) => connectives::pair_of_and(&block.and),
    };
    let Some(pair) = found else {
        let message = "jFuzzyLogic has no word for its connectives";
        loss.cannot(&block.name, message, connectives::words());
        return;
    };
    if uses.and && uses.or && pair_of_or != found {
        let message = "its rules use an *and* and an *or* that are no pair of jFuzzyLogic";
        loss.lose(&block.name, message, &format!("AND : {}, which sets both", pair.and_word));
    }
    (block.and, block.or) = (pair.and.into(), pair.or.into());
}

/// A set without a width has no area, and FCL reads it as a number that is averaged.
fn singletons(output: &Output, loss: &mut Loss) {
    let is_singleton = |term: &OutputTerm| {
        matches!(
            &term.conclusion,
            Conclusion::Set {
                membership: Membership::Shape { kind: ShapeKind::Singleton, .. },
                ..
            }
        )
    };
    if output.defuzzifier.sampling().is_some() && output.terms.iter().any(is_singleton) {
        let message = "a singleton among sets that are integrated is read as a number in FCL";
        loss.cannot(&output.name, message, "a weighted average, or a .toml file");
    }
}

fn integrals(output: &mut Output, dialect: Dialect, loss: &mut Loss) {
    singletons(output, loss);
    match dialect {
        Dialect::Iec => {}
        Dialect::JFuzzyLogic => {
            sampled(output, loss, dialect.sampling(), |found| found == dialect.sampling());
        }
        Dialect::Fuzzylite => {
            sampled(output, loss, dialect.sampling(), |found| {
                matches!(found, Sampling::Midpoint(_))
            });
            let usual = output.defuzzifier.sampling().is_none_or(|s| s == dialect.sampling());
            if !usual {
                let note =
                    "the resolution is written behind METHOD, where not every version reads it";
                loss.note(format!("`{}`: {note}", output.name));
            }
        }
    }
    if let Defuzzifier::WeightedSum(_) = output.defuzzifier
        && dialect != Dialect::Fuzzylite
    {
        let message = "a weighted sum has no words in this dialect";
        loss.cannot(&output.name, message, "fuzzylite's dialect");
    }
}

/// jFuzzyLogic has one default and no limits.
fn limits(output: &mut Output, loss: &mut Loss) {
    if output.clamp {
        let integrates = output.defuzzifier.sampling().is_some();
        match integrates {
            true => loss.note(format!("`{}`: an integral stays in its range", output.name)),
            false => loss.lose(&output.name, "its answer is limited to its range", "no limit"),
        }
        output.clamp = false;
    }
    if output.fallback.previous && output.fallback.value != FallbackValue::Nothing {
        loss.lose(&output.name, "has two defaults", "`NC`, the previous answer");
        output.fallback.value = FallbackValue::Nothing;
    }
}

fn block(block: &RuleBlock, loss: &mut Loss) {
    if block.activation != Activation::General {
        let expected = "every rule to act, or FLL";
        loss.cannot(&block.name, "the activation method has no words in FCL", expected);
    }
}
