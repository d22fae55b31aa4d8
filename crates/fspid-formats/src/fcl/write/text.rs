//! The text of a system that a dialect can say.

use std::collections::BTreeSet;

use fspid_fuzzy::system::{
    Conclusion, FallbackValue, Input, Membership, Output, Parts, RuleBlock, SNorm, Sampling,
};
use fspid_fuzzy::{OutOfRange, SNormKind};

use super::norm::s_norm_word;
use super::statement::{range, statement};
use super::{options, set};
use crate::adapt::{check_formula, formula_names, is_asked};
use crate::fcl::{Dialect, connectives};
use crate::loss::Loss;
use crate::number::{written as number, written_all};
use crate::repeated;
use crate::rule::{self, Style};
use crate::vocabulary::methods;
use crate::vocabulary::norms::{STANDARD_ACCU, STANDARD_ACT, STANDARD_AND, STANDARD_OR};

/// Writes a system whose parts have been adapted.
pub(super) struct Writer<'w> {
    pub(super) parts: &'w Parts,
    pub(super) dialect: Dialect,
    pub(super) loss: &'w mut Loss,
}

impl<'w> Writer<'w> {
    pub(super) fn text(&mut self) -> String {
        let parts = self.parts;
        let mut text = self.marks();
        text += &self.comment(&parts.description);
        text += &format!("FUNCTION_BLOCK {}\n", parts.name);
        text += &declarations("VAR_INPUT", parts.inputs.iter().map(|input| &input.name));
        text += &declarations("VAR_OUTPUT", parts.outputs.iter().map(|output| &output.name));
        parts.inputs.iter().for_each(|input| text += &self.input(input));
        parts.outputs.iter().for_each(|output| text += &self.output(output));
        parts.blocks.iter().for_each(|block| text += &self.block(block));
        if self.dialect == Dialect::Iec {
            text += &options::written(parts);
        }
        text + "\nEND_FUNCTION_BLOCK\n"
    }

    /// A first line by which the dialect is known again.
    fn marks(&self) -> String {
        match self.dialect {
            Dialect::Iec => String::new(),
            Dialect::Fuzzylite => "# FCL in the dialect of fuzzylite\n".into(),
            Dialect::JFuzzyLogic => "// FCL in the dialect of jFuzzyLogic\n".into(),
        }
    }

    /// A description, on one line.
    fn comment(&mut self, description: &str) -> String {
        if description.is_empty() {
            return String::new();
        }
        self.loss.note(format!("a description is written as a comment: `{description}`"));
        let line = description.replace("*)", "* )").replace(char::is_control, " ");
        match self.dialect {
            Dialect::Iec => format!("(* {line} *)\n"),
            Dialect::Fuzzylite => format!("# {line}\n"),
            Dialect::JFuzzyLogic => format!("// {line}\n"),
        }
    }

    pub(super) fn extended(&self) -> bool {
        self.dialect == Dialect::Fuzzylite
    }

    fn input(&mut self, input: &Input) -> String {
        let mut text = format!("\n{}FUZZIFY {}\n", self.comment(&input.description), input.name);
        if self.extended() {
            text += &switches(input.enabled, input.out_of_range == OutOfRange::Clamp);
            text += &statement("RANGE := ", &range(input.universe));
        }
        for term in &input.terms {
            self.formulas(&format!("{}.{}", input.name, term.name), &term.membership);
            let set = set::written(&term.membership, self.dialect).unwrap_or_default();
            text += &statement(&format!("TERM {} := ", term.name), &set);
        }
        text + "END_FUZZIFY\n"
    }

    fn output(&mut self, output: &Output) -> String {
        let mut text =
            format!("\n{}DEFUZZIFY {}\n", self.comment(&output.description), output.name);
        if self.extended() {
            text += &switches(output.enabled, output.clamp);
        }
        for term in &output.terms {
            let set = self.conclusion(&format!("{}.{}", output.name, term.name), &term.conclusion);
            text += &statement(&format!("TERM {} := ", term.name), &set);
        }
        text += &statement("METHOD : ", &self.method(output));
        if self.extended() {
            let word = self.s_norm(&output.name, &output.aggregation, SNormKind::ALL);
            text += &statement("ACCU : ", &word);
        }
        text += &default(output, self.dialect);
        if output.universe.is_some() {
            text += &statement("RANGE := ", &range(output.universe));
        }
        text + "END_DEFUZZIFY\n"
    }

    fn method(&mut self, output: &Output) -> String {
        let word = methods::row_of(output.defuzzifier).map_or("", |row| row.word());
        if self.dialect == Dialect::Iec && !methods::STANDARD.contains(&word) {
            let message = "the method has no word in the standard";
            self.loss.cannot(&output.name, message, methods::STANDARD.join(", "));
        }
        match output.defuzzifier.sampling() {
            Some(Sampling::Midpoint(count)) if self.extended() && count != 1000 => {
                format!("{word} {count}")
            }
            _ => word.into(),
        }
    }

    fn conclusion(&mut self, name: &str, conclusion: &Conclusion) -> String {
        match conclusion {
            Conclusion::Set { membership, .. } => {
                self.formulas(name, membership);
                set::written(membership, self.dialect).unwrap_or_default()
            }
            Conclusion::Constant(value) => number(*value),
            Conclusion::Linear { coefficients, constant } if self.extended() => {
                format!("Linear {}", written_all(&[coefficients, &[*constant][..]].concat()))
            }
            Conclusion::Formula(formula) if self.dialect != Dialect::Iec => {
                check_formula(name, formula, &formula_names(self.parts), self.loss);
                format!("FUNCTION {}", formula.text())
            }
            Conclusion::Linear { .. } | Conclusion::Formula(_) | Conclusion::Interval(_) => {
                let message =
                    "a conclusion that depends on the inputs has no words in this dialect";
                self.loss.cannot(name, message, "fuzzylite's dialect");
                String::new()
            }
        }
    }

    fn formulas(&mut self, name: &str, membership: &Membership) {
        if let Membership::Formula { formula, .. } = membership {
            let names: Vec<&str> = ["x"].into_iter().chain(formula_names(self.parts)).collect();
            check_formula(name, formula, &names, self.loss);
        }
    }

    fn block(&mut self, block: &RuleBlock) -> String {
        let heading = format!("RULEBLOCK {}", block.name);
        let mut text = format!("\n{}{}\n", self.comment(&block.description), heading.trim_end());
        if self.extended() && !block.enabled {
            text += &statement("ENABLED : ", "FALSE");
        }
        text += &self.connectives(block);
        text += &statement("ACT : ", &self.t_norm(&block.name, &block.implication, &STANDARD_ACT));
        if !self.extended() {
            text += &self.block_accu(block);
        }
        for (index, rule) in block.rules.iter().enumerate() {
            let number = (index + 1).to_string();
            let name = if rule.name.is_empty() { &number } else { &rule.name };
            match rule::written(rule, self.parts, self.style()) {
                Ok(rule) => text += &statement(&format!("RULE {name} : "), &rule),
                Err(message) => self.loss.cannot(
                    &format!("rule {number}"),
                    message,
                    "fuzzylite's dialect or FLL",
                ),
            }
        }
        text + "END_RULEBLOCK\n"
    }

    /// `AND` and `OR`; to jFuzzyLogic, where either sets both, by the pair that the block has been given.
    fn connectives(&mut self, block: &RuleBlock) -> String {
        if self.dialect == Dialect::JFuzzyLogic {
            let pair = connectives::pair_of_and(&block.and).unwrap_or_default();
            return statement("AND : ", pair.and_word) + &statement("OR : ", pair.or_word);
        }
        let and = self.t_norm(&block.name, &block.and, &STANDARD_AND);
        let or = self.s_norm(&block.name, &block.or, &STANDARD_OR);
        statement("AND : ", &and) + &statement("OR : ", &or)
    }

    fn style(&self) -> Style {
        let own = self.dialect == Dialect::Fuzzylite;
        let between = if own { " and " } else { ", " };
        Style { upper: !own, negation: !own, hedges: own, carries: own, between }
    }

    /// The accumulation of the outputs that a block concludes: one for all of them to which it makes a difference.
    fn block_accu(&mut self, block: &RuleBlock) -> String {
        let concluded: BTreeSet<usize> =
            block.rules.iter().flat_map(|rule| &rule.consequents).map(|own| own.output).collect();
        let needed = concluded.iter().flat_map(|&output| self.accumulations(output));
        let needed: Vec<(&Output, SNorm)> = needed.collect();
        let Some((first, norm)) = needed.first().cloned() else {
            let own = concluded.iter().find_map(|&output| self.parts.outputs.get(output));
            let said = own.map(|own| self.accumulation_word(&own.aggregation).unwrap_or("MAX"));
            return said.map(|word| statement("ACCU : ", word)).unwrap_or_default();
        };
        if let Some((other, _)) = needed.iter().find(|(_, other)| *other != norm) {
            let message =
                format!("is joined in another way than `{}` in the same rules", first.name);
            self.loss.cannot(&other.name, message, "fuzzylite's dialect");
        }
        let word = self.accumulation_word(&norm);
        statement("ACCU : ", &self.word(&block.name, word))
    }

    fn accumulation_word(&self, norm: &SNorm) -> Option<&'static str> {
        if self.dialect == Dialect::JFuzzyLogic {
            return connectives::accumulation_word(norm);
        }
        s_norm_word(norm).filter(|_| STANDARD_ACCU.iter().any(|&kind| norm.is(kind)))
    }

    /// The accumulations by which the answer of an output, or of rules that ask it, comes about.
    fn accumulations(&self, output: usize) -> Vec<(&'w Output, SNorm)> {
        let parts = self.parts;
        let Some(own) = parts.outputs.get(output) else { return Vec::new() };
        let joins = own.defuzzifier.sampling().is_some() || is_asked(self.parts, output);
        let adds = self.dialect == Dialect::JFuzzyLogic && repeated::adds_up(self.parts, output);
        let joined = joins.then(|| own.aggregation.clone());
        let added = adds.then(|| SNormKind::UnboundedSum.into());
        joined.into_iter().chain(added).map(|norm| (own, norm)).collect()
    }
}

fn declarations<'n>(keyword: &str, names: impl Iterator<Item = &'n String>) -> String {
    let lines: String = names.map(|name| format!("  {name} : REAL;\n")).collect();
    format!("\n{keyword}\n{lines}END_VAR\n")
}

fn switches(enabled: bool, locked: bool) -> String {
    let enabled = if enabled { String::new() } else { statement("ENABLED : ", "FALSE") };
    enabled + &if locked { statement("LOCK : ", "RANGE") } else { String::new() }
}

/// The default as the dialect has it: a number, `NC`, or both in fuzzylite's.
fn default(output: &Output, dialect: Dialect) -> String {
    let value = match output.fallback.value {
        FallbackValue::Number(value) => Some(number(value)),
        FallbackValue::Middle => output.universe.map(|universe| number(universe.middle())),
        FallbackValue::Nothing => None,
    };
    let text = match (output.fallback.previous, value) {
        (true, Some(value)) if dialect == Dialect::Fuzzylite => format!("{value} | NC"),
        (true, _) => "NC".into(),
        (false, Some(value)) => value,
        (false, None) if dialect == Dialect::Fuzzylite => "nan".into(),
        (false, None) => return String::new(),
    };
    statement("DEFAULT := ", &text)
}
