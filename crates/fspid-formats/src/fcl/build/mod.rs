//! From what a text says to the system that it means.

mod joined;
mod output;
mod partial;
mod rules;

use std::collections::BTreeSet;

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Input, Membership, Parts, RuleBlock, Term};

use super::Dialect;
use super::draft::{Block, Draft, Role, Set, Variable};
use super::parser::is_section_word;
use crate::lexer::Token;
use crate::names::{Index, Names};
use crate::note::Reading;
use crate::report::Report;
use crate::{check, rule, term};
use fspid_diagnostics::{Place, Problems};

/// The system that a draft means in a dialect.
pub(super) fn reading(draft: Draft, dialect: Option<Dialect>) -> Result<Reading, Problems> {
    let Draft { name, mut variables, blocks, mut evidence, mut report, .. } = draft;
    let without = partial::without_a_section(&mut variables, &blocks, &mut report);
    let names = rule_names(&variables, &mut report);
    if let Some(place) = rules::missing_sign(&blocks) {
        evidence.fuzzylite(place, "a rule without `;`");
    }
    let (found, how) = evidence.judge();
    let dialect = dialect.unwrap_or(found);
    let read = |block| rules::block(block, dialect, &names, &mut report);
    let (mut rules, places): (Vec<RuleBlock>, Vec<_>) = blocks.iter().map(read).unzip();
    if dialect == Dialect::Fuzzylite {
        let enabled: Vec<bool> =
            variables.iter().filter(|v| v.is_output()).map(|v| v.enabled).collect();
        let placed = rules.iter_mut().flat_map(|block| &mut block.rules).zip(places.concat());
        placed.for_each(|(rule, place)| rule::take_along(rule, &enabled, place, &mut report));
    }
    variables.truncate(variables.len() - without);
    partial::leave_out(&mut rules, &variables, &mut report);
    let accus = accumulations(&rules, &blocks, variables.len());
    let (names, inputs) = formula_names(&variables);
    let mut builder = Builder { dialect, formula_names: names, inputs, report, accus };
    builder.tell(dialect == found, &how);
    let mut parts = builder.parts(name, &variables, rules);
    builder.join(&mut parts, &variables);
    if parts.outputs.is_empty() && !parts.inputs.is_empty() {
        builder.report.note_whole("without an output nothing can be concluded; the sets are read");
    }
    if parts.formulas_name_outputs() {
        builder.report.note_whole(term::OUTPUTS_IN_FORMULAS);
    }
    check::complete(parts, builder.report)
}

/// For each output, the accumulations of the blocks that conclude it.
fn accumulations(
    rules: &[RuleBlock],
    blocks: &[Block],
    variables: usize,
) -> Vec<Vec<(SNormKind, Place)>> {
    let mut found = vec![Vec::new(); variables];
    for (rules, block) in rules.iter().zip(blocks) {
        let concluded = rules.rules.iter().flat_map(|rule| &rule.consequents);
        let outputs: BTreeSet<usize> = concluded.map(|consequent| consequent.output).collect();
        for output in outputs {
            found.get_mut(output).into_iter().for_each(|own| own.extend(block.accu));
        }
    }
    found
}

/// Names in the order of the system: inputs first.
fn rule_names(variables: &[Variable], report: &mut Report) -> Names {
    let term_names = |variable: &Variable, report: &mut Report| {
        let mut index = Index::default();
        for term in &variable.terms {
            let reserved = term.name.is_any(&rule::RESERVED) || is_section_word(term.name.text);
            if reserved {
                wrong(
                    report,
                    term.name,
                    "cannot be the name of a term",
                    "a word that means nothing in rules",
                );
            } else if !index.add(term.name.text) {
                wrong(report, term.name, "is there twice", "names that differ");
            }
        }
        index
    };
    let of = |output: bool| variables.iter().filter(move |v| v.is_output() == output);
    let mut names = Names::empty(false);
    for variable in of(false).chain(of(true)) {
        let terms = term_names(variable, report);
        names.push(variable.name.text, variable.is_output(), terms);
    }
    names
}

/// The names of the inputs, then of the outputs, and how many inputs there are.
fn formula_names<'a>(variables: &[Variable<'a>]) -> (Vec<&'a str>, usize) {
    let of = |output: bool| {
        variables.iter().filter(move |v| v.is_output() == output).map(|v| v.name.text)
    };
    (of(false).chain(of(true)).collect(), of(false).count())
}

fn wrong(report: &mut Report, token: Token, message: &str, expected: impl Into<String>) {
    report.problem(token.place(), token.text, message, expected);
}

/// How equal conclusions can be read as they stand.
const ADDED: &str = "`ACCU : SUM`, which adds them up, or a term of its own for each of them";

/// Makes the system's parts.
struct Builder<'a> {
    dialect: Dialect,
    /// What formulas may name: the inputs, then the outputs.
    formula_names: Vec<&'a str>,
    /// How many of these are inputs.
    inputs: usize,
    report: Report,
    /// For each output, the accumulations of the blocks that conclude it.
    accus: Vec<Vec<(SNormKind, Place)>>,
}

impl<'a> Builder<'a> {
    fn tell(&mut self, found: bool, how: &str) {
        let Self { dialect, .. } = self;
        let integrals = format!("integrals are computed by `{}`", dialect.sampling());
        self.report.note_whole(match found {
            true => format!("{how}; {integrals} unless the text says otherwise"),
            false => format!("read as {}'s dialect as asked; {integrals}", dialect.name()),
        });
    }

    fn parts(&mut self, name: String, variables: &[Variable<'a>], blocks: Vec<RuleBlock>) -> Parts {
        let of = |output: bool| variables.iter().filter(move |v| v.is_output() == output);
        let inputs = of(false).map(|variable| self.input(variable)).collect();
        let outputs = of(true).enumerate().map(|(i, variable)| self.output(i, variable)).collect();
        Parts { name, description: String::new(), inputs, outputs, blocks }
    }

    /// Joins equal conclusions about outputs that weigh their terms, where an `ACCU` says how and its tool does so.
    fn join(&mut self, parts: &mut Parts, variables: &[Variable<'a>]) {
        let outputs = variables.iter().filter(|variable| variable.is_output());
        for (output, variable) in outputs.enumerate() {
            let given = self.accus.get(output).is_some_and(|own| !own.is_empty());
            let weighs =
                parts.outputs.get(output).is_some_and(|own| own.defuzzifier.sampling().is_none());
            if self.dialect == Dialect::Fuzzylite || variable.adds || !given || !weighs {
                continue;
            }
            let (name, place) = (variable.name.text, variable.name.place());
            match joined::join(parts, output) {
                Ok(None) => {}
                Ok(Some([before, after])) => {
                    let message = format!(
                        "rules that conclude the same about `{name}` are read as one, for ACCU joins their strengths before \
                         they are weighed: {before} rules became {after}"
                    );
                    self.report.note(place, message);
                }
                Err(why) => {
                    let message = format!(
                        "is weighed, and ACCU joins the rules that conclude the same about it; that is not one rule here, for {why}"
                    );
                    self.report.problem(place, name, message, ADDED);
                }
            }
        }
    }

    fn input(&mut self, variable: &Variable<'a>) -> Input {
        let name = variable.name;
        match (variable.role, variable.section) {
            (Role::Local, _) => {
                self.report.note(
                    name.place(),
                    format!("the local variable `{}` is an input here", name.text),
                );
            }
            (_, None) => {
                self.report.note(name.place(), format!("`{}` has no FUZZIFY section", name.text))
            }
            _ => {}
        }
        let mut terms = Vec::new();
        for term in &variable.terms {
            let membership = self.input_set(&term.set);
            let name = term.name.text.into();
            terms.extend(membership.map(|membership| Term { name, membership, lower: None }));
        }
        Input {
            name: name.text.into(),
            description: String::new(),
            enabled: variable.enabled,
            universe: variable.universe,
            out_of_range: variable.out_of_range,
            terms,
        }
    }

    fn input_set(&mut self, set: &Set<'a>) -> Option<Membership> {
        match set {
            Set::Unknown => None,
            Set::Fuzzy(membership) => Some(membership.clone()),
            Set::Number(value) => self.singleton(*value),
            Set::Linear(word, _) => {
                wrong(&mut self.report, *word, "is no fuzzy set", "a fuzzy set");
                None
            }
            Set::Formula(text) => self.membership_formula(*text),
        }
    }

    fn singleton(&mut self, value: f64) -> Option<Membership> {
        Some(Membership::Shape { kind: ShapeKind::Singleton, params: vec![value], height: 1.0 })
    }

    fn membership_formula(&mut self, text: Token<'a>) -> Option<Membership> {
        let names: Vec<&str> =
            ["x"].into_iter().chain(self.formula_names.iter().copied()).collect();
        let formula = term::formula(text, &names, &mut self.report)?;
        Some(Membership::Formula { formula, height: 1.0 })
    }
}
