//! From what a text says to the system that it means.

use std::collections::BTreeSet;

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Fallback, FallbackValue, Input, Membership, Output, OutputTerm, Parts,
    RuleBlock, Sampling, Term, Universe,
};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::Dialect;
use super::draft::{Block, Draft, Role, Set, Variable};
use super::parser::is_section_word;
use crate::lexer::{Kind, Token};
use crate::names::{Index, Names};
use crate::note::{Place, Problems, Reading};
use crate::report::Report;
use crate::vocabulary::norms::{S_NORMS, row_of};
use crate::{check, rule, term};

/// The system that a draft means in a dialect.
pub(super) fn reading(draft: Draft, dialect: Option<Dialect>) -> Result<Reading, Problems> {
    let Draft { name, variables, blocks, mut evidence, mut report, .. } = draft;
    let names = rule_names(&variables, &mut report);
    let mut missing_sign = None;
    let read = |block| rule_block(block, &names, &mut missing_sign, &mut report);
    let rules: Vec<RuleBlock> = blocks.iter().map(read).collect();
    if let Some(place) = missing_sign {
        evidence.fuzzylite(place, "a rule without `;`");
    }
    let (found, how) = evidence.judge();
    let dialect = dialect.unwrap_or(found);
    let accus = accumulations(&rules, &blocks, variables.len());
    let mut builder = Builder { dialect, input_names: input_names(&variables), report, accus };
    builder.tell(dialect == found, &how);
    let parts = builder.parts(name, &variables, rules);
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

fn input_names<'a>(variables: &[Variable<'a>]) -> Vec<&'a str> {
    variables.iter().filter(|v| !v.is_output()).map(|v| v.name.text).collect()
}

fn wrong(report: &mut Report, token: Token, message: &str, expected: impl Into<String>) {
    report.problem(token.place(), token.text, message, expected);
}

fn rule_block(
    block: &Block,
    names: &Names,
    missing_sign: &mut Option<Place>,
    report: &mut Report,
) -> RuleBlock {
    let mut rules = Vec::new();
    let (mut and_used, mut or_used) = (None, None);
    for (index, text) in block.rules.iter().enumerate() {
        let mut reader = rule::Reader::new(text.tokens, names, report, is_section_word);
        let found = reader.rule();
        (and_used, or_used) = (and_used.or(reader.and), or_used.or(reader.or));
        let next = reader.tokens.next;
        if let Some(mut rule) = found {
            rule.name = own_name(text.name, index);
            rules.push(rule);
            rule_end(next, missing_sign, report);
        }
    }
    let (and, or) = connectives(block, and_used, or_used, report);
    RuleBlock {
        name: block.name.clone(),
        description: String::new(),
        enabled: block.enabled,
        and: and.into(),
        or: or.into(),
        implication: block.act.unwrap_or(TNormKind::Minimum).into(),
        activation: fspid_fuzzy::system::Activation::General,
        rules,
    }
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

struct Builder<'a> {
    dialect: Dialect,
    input_names: Vec<&'a str>,
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
        let kind = fspid_fuzzy::membership::ShapeKind::Singleton;
        Some(Membership::Shape { kind, params: vec![value], height: 1.0 })
    }

    fn membership_formula(&mut self, text: Token<'a>) -> Option<Membership> {
        let names: Vec<&str> = ["x"].into_iter().chain(self.input_names.iter().copied()).collect();
        let formula = term::formula(text, &names, &mut self.report)?;
        Some(Membership::Formula { formula, height: 1.0 })
    }

    fn output(&mut self, index: usize, variable: &Variable<'a>) -> Output {
        let name = variable.name;
        if variable.role == Role::Local {
            self.report.note(
                name.place(),
                format!("the local variable `{}` is an output here", name.text),
            );
        }
        if variable.section.is_none() {
            wrong(&mut self.report, name, "has no DEFUZZIFY section", "`DEFUZZIFY` with its terms");
        }
        let defuzzifier = self.defuzzifier(variable);
        let integrates = defuzzifier.sampling().is_some();
        let mut terms = Vec::new();
        for term in &variable.terms {
            let conclusion = self.conclusion(&term.set, integrates);
            let name = term.name.text.into();
            terms.extend(conclusion.map(|conclusion| OutputTerm { name, conclusion }));
        }
        let universe = self.universe(variable, integrates);
        Output {
            name: name.text.into(),
            description: String::new(),
            enabled: variable.enabled,
            universe,
            clamp: variable.clamp,
            terms,
            aggregation: self.aggregation(index, variable).into(),
            defuzzifier,
            fallback: fallback(variable),
        }
    }

    fn conclusion(&mut self, set: &Set<'a>, integrates: bool) -> Option<Conclusion> {
        match set {
            Set::Unknown => None,
            Set::Fuzzy(membership) => {
                Some(Conclusion::Set { membership: membership.clone(), lower: None })
            }
            Set::Number(value) => Some(Conclusion::Constant(*value)),
            Set::Linear(word, numbers) => {
                term::linear(*word, numbers, self.input_names.len(), &mut self.report)
            }
            Set::Formula(text) if integrates => self
                .membership_formula(*text)
                .map(|membership| Conclusion::Set { membership, lower: None }),
            Set::Formula(text) => {
                term::formula(*text, &self.input_names, &mut self.report).map(Conclusion::Formula)
            }
        }
    }

    /// The method with the dialect's way to integrate. Numbers have no area: the centre of gravity
    /// of numbers is their weighted mean.
    fn defuzzifier(&mut self, variable: &Variable<'a>) -> Defuzzifier {
        let numbers = variable.terms.iter().filter(|t| matches!(t.set, Set::Number(_))).count();
        let only_numbers = numbers > 0 && numbers == variable.terms.len();
        let weighted = Defuzzifier::WeightedAverage(Default::default());
        let Some(method) = variable.method else {
            let assumed = if only_numbers { weighted } else { Defuzzifier::default() };
            if variable.section.is_some() {
                let note = format!("no METHOD is given; {} is assumed", assumed.name());
                self.report.note(variable.name.place(), note);
            }
            return self.sampled(assumed, variable);
        };
        let found = method.row.method;
        if found.sampling().is_some() && numbers > 0 {
            if only_numbers && matches!(found, Defuzzifier::Centroid(_)) {
                let note = "the centre of gravity of numbers is read as COGS, their weighted mean";
                self.report.note(method.word.place(), note);
                return weighted;
            }
            wrong(
                &mut self.report,
                method.word,
                "integrates, but some terms are numbers",
                "`COGS`",
            );
        }
        if found.sampling().is_none() {
            self.check_weighted(variable, method.word);
        }
        self.sampled(found, variable)
    }

    fn check_weighted(&mut self, variable: &Variable<'a>, word: Token<'a>) {
        let blurred = |set: &Set| matches!(set, Set::Fuzzy(set) if !crate::fll::is_monotone(set));
        if let Some(term) = variable.terms.iter().find(|term| blurred(&term.set)) {
            let message = format!("weighs numbers, but `{}` is a fuzzy set", term.name.text);
            wrong(&mut self.report, word, &message, "`COG`, or terms that are numbers");
        }
    }

    fn sampled(&self, method: Defuzzifier, variable: &Variable) -> Defuzzifier {
        let resolution = variable.method.and_then(|method| method.resolution);
        let by_resolution = resolution.map(Sampling::Midpoint);
        let sampling = variable.sampling.or(by_resolution).unwrap_or(self.dialect.sampling());
        method.with_sampling(sampling)
    }

    /// The range, or what bounded terms span.
    fn universe(&mut self, variable: &Variable<'a>, needed: bool) -> Option<Universe> {
        if variable.universe.is_some() || !needed || variable.terms.is_empty() {
            return variable.universe;
        }
        let spanned = variable.terms.iter().map(|term| span(&term.set));
        let spanned = spanned.reduce(|all, one| {
            all.zip(one).map(|((lower, upper), (a, b))| (lower.min(a), upper.max(b)))
        });
        let place = variable.name.place();
        match spanned.flatten().filter(|(lower, upper)| lower < upper) {
            Some((lower, upper)) => {
                let note = format!("no RANGE is given; the terms span {lower:?} to {upper:?}");
                self.report.note(place, note);
                Some(Universe { lower, upper })
            }
            None => {
                let message = "has no RANGE, and its terms have no ends";
                wrong(&mut self.report, variable.name, message, "`RANGE := (lower .. upper);`");
                None
            }
        }
    }

    /// `ACCU` of the output, or of the blocks that conclude it.
    fn aggregation(&mut self, index: usize, variable: &Variable<'a>) -> SNormKind {
        let of_blocks = self.accus.get(index).into_iter().flatten().copied();
        let named: Vec<_> = variable.accu.into_iter().chain(of_blocks).collect();
        let Some(&(first, _)) = named.first() else {
            let place = variable.name.place();
            let note = format!("no ACCU is given for `{}`; maximum is assumed", variable.name.text);
            self.report.note(place, note);
            return SNormKind::Maximum;
        };
        if let Some(&(other, place)) = named.iter().find(|(norm, _)| *norm != first) {
            let word = |norm| row_of(S_NORMS, &norm).map_or("", |row| row.word());
            let name = variable.name.text;
            let message = format!("`{name}` is accumulated by {} elsewhere", word(first));
            self.report.problem(place, word(other), message, "the same everywhere");
        }
        first
    }
}

fn fallback(variable: &Variable) -> Fallback {
    let number = variable.default.map_or(FallbackValue::Nothing, FallbackValue::Number);
    let value = if variable.middle { FallbackValue::Middle } else { number };
    Fallback { previous: variable.previous, value }
}

/// The ends of a set, if it has any.
fn span(set: &Set) -> Option<(f64, f64)> {
    let Set::Fuzzy(Membership::Shape { kind, params, .. }) = set else { return None };
    let mut ends: Option<(f64, f64)> = None;
    kind.vertices(params, &mut |vertex| {
        let (lower, upper) = ends.unwrap_or((vertex.x, vertex.x));
        ends = Some((lower.min(vertex.x), upper.max(vertex.x)));
    });
    ends
}
