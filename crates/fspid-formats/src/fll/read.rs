//! Reading.

use std::collections::BTreeSet;

use fspid_fuzzy::system::{Input, Membership, Parts, Rule, RuleBlock, Term};
use fspid_fuzzy::{OutOfRange, SNormKind, TNormKind};

use super::lines::{self, Line, numbers};
use super::sections::{FllSection, HEADINGS, Kindred};
use super::{output, readable};
use crate::cursor::Cursor;
use crate::lexer::{Kind, Lexer, Token};
use crate::names::Names;
use crate::note::Reading;
use crate::report::Report;
use crate::term::{formula, shape};
use crate::tokens::Tokens;
use crate::vocabulary::shapes::{self, FUZZYLITE};
use crate::vocabulary::{known, norms};
use crate::{check, rule, term};
use fspid_diagnostics::Problems;

/// Reads a system in the FuzzyLite Language.
///
/// # Errors
/// Every problem of the text, each with its place.
pub fn read(text: &str) -> Result<Reading, Problems> {
    let cursor = Cursor::new(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let mut report = Report::default();
    let sections = sections(cursor, &mut report);
    let parts = assembled(&sections, &mut report);
    tell(&parts, &mut report);
    check::complete(parts, report)
}

/// What fuzzylite computes that a reader might not expect.
fn tell(parts: &Parts, report: &mut Report) {
    let mut samplings = parts.outputs.iter().filter_map(|output| output.defuzzifier.sampling());
    if let Some(sampling) = samplings.next() {
        let others = if samplings.all(|other| other == sampling) { "" } else { " and others" };
        report.note_whole(format!(
            "integrals are computed by `{sampling}`{others}, as fuzzylite does"
        ));
    }
    if parts.formulas_name_outputs() {
        report.note_whole(term::OUTPUTS_IN_FORMULAS);
    }
    for output in &parts.outputs {
        let weighted = output.defuzzifier.sampling().is_none();
        if weighted && !output.aggregation.is(SNormKind::UnboundedSum) {
            let note = "a weighted method adds equal conclusions up, whatever the aggregation";
            report.note_whole(format!("`{}`: {note}", output.name));
        }
    }
}

fn sections<'a>(mut text: Cursor<'a>, report: &mut Report) -> Vec<FllSection<'a>> {
    let mut sections: Vec<FllSection> = Vec::new();
    while let Some(line) = lines::next(&mut text, report) {
        let heading = HEADINGS.iter().find(|row| line.is(row.0));
        match (heading, sections.last_mut()) {
            (Some(row), _) => sections.push(FllSection::new(row.1, line)),
            (None, Some(section)) => section.fill(line, report),
            (None, None) => {
                let expected = known(HEADINGS.iter().map(|row| row.0), line.key);
                report.problem(
                    line.start.place(),
                    line.key,
                    "not the beginning of a system",
                    expected,
                );
            }
        }
    }
    sections
}

fn assembled(sections: &[FllSection], report: &mut Report) -> Parts {
    let mut parts = Parts::default();
    let of = |kind| sections.iter().filter(move |section| section.kind == kind);
    engine(&mut parts, of(Kindred::Engine), report);
    distinct(of(Kindred::Input).chain(of(Kindred::Output)).map(|s| s.heading.value), report);
    let variables = of(Kindred::Input).chain(of(Kindred::Output)).map(|s| s.heading.text());
    let with_x: Vec<&str> = ["x"].into_iter().chain(variables).collect();
    parts.inputs = of(Kindred::Input).map(|section| input(section, &with_x, report)).collect();
    let known = output::Known { with_x: &with_x, inputs: parts.inputs.len() };
    for section in of(Kindred::Output) {
        parts.outputs.extend(output::read(section, known, report));
    }
    let mut names = Names::empty(true);
    for section in of(Kindred::Input).chain(of(Kindred::Output)) {
        // Terms that cannot be read have names all the same.
        let terms = section.terms.iter().map(|line| line.tokens().next.text).collect();
        names.push(section.heading.text(), section.kind == Kindred::Output, terms);
    }
    let weighted: Vec<bool> =
        parts.outputs.iter().map(|output| output.defuzzifier.sampling().is_none()).collect();
    for section in of(Kindred::Block) {
        parts.blocks.push(block(section, &names, &weighted, report));
    }
    parts
}

fn engine<'s, 'a: 's>(
    parts: &mut Parts,
    mut engines: impl Iterator<Item = &'s FllSection<'a>>,
    report: &mut Report,
) {
    if let Some(engine) = engines.next() {
        parts.name = engine.heading.text().into();
        parts.description.clone_from(&engine.description);
    }
    for more in engines {
        let (place, message) = (more.heading.start.place(), "a second system");
        report.problem(place, more.heading.key, message, "one system in a text");
    }
}

/// Names that are there twice, and names that no rule could use.
pub(super) fn distinct<'a>(names: impl Iterator<Item = Cursor<'a>>, report: &mut Report) {
    let mut seen = BTreeSet::new();
    for name in names {
        let text = name.rest();
        if !readable(text) {
            let expected = "one word without brackets and commas that means nothing in rules";
            report.problem(name.place(), text, "cannot be a name", expected);
        } else if !seen.insert(text) {
            report.problem(name.place(), text, "is there twice", "names that differ");
        }
    }
}

/// A term's line: its name, its class, and what follows.
#[derive(Clone, Copy)]
pub(super) struct TermLine<'a> {
    pub(super) name: Token<'a>,
    pub(super) class: Token<'a>,
    pub(super) rest: Tokens<'a>,
}

/// The terms of a section; lines without name and class are reported.
pub(super) fn terms<'a>(section: &FllSection<'a>, report: &mut Report) -> Vec<TermLine<'a>> {
    let mut found = Vec::new();
    for line in &section.terms {
        let mut rest = line.tokens();
        let (name, class) = (rest.advance(), rest.advance());
        if class.kind == Kind::End {
            line.wrong("not a term", "a name, a class and its parameters", report);
        } else {
            found.push(TermLine { name, class, rest });
        }
    }
    distinct(found.iter().map(|term| only(term.name)), report);
    found
}

/// The token alone, without what follows it.
fn only(token: Token) -> Cursor {
    let mut after = token.start;
    after.take_while(|next| !next.is_whitespace() && next != '(' && next != ',');
    token.start.up_to(after)
}

/// A fuzzy set: a shape, or a function of `x`, the inputs and the outputs.
pub(super) fn membership(
    term: &TermLine,
    with_x: &[&str],
    report: &mut Report,
) -> Option<Membership> {
    let TermLine { class, mut rest, .. } = *term;
    if class.is("Function") {
        let formula = formula(rest.take_raw('\n'), with_x, report)?;
        return Some(Membership::Formula { formula, height: 1.0 });
    }
    let Some(row) = shapes::of_word(FUZZYLITE, class.text) else {
        let expected = known(FUZZYLITE.iter().map(|row| row.word).chain(["Function"]), class.text);
        report.problem(class.place(), class.text, "not known as a fuzzy set", expected);
        return None;
    };
    shape(row, class, &numbers(rest, report)?, report)
}

fn input(section: &FllSection, with_x: &[&str], report: &mut Report) -> Input {
    let mut found = Vec::new();
    for term in terms(section, report) {
        let membership = membership(&term, with_x, report);
        let name = term.name.text.into();
        found.extend(membership.map(|membership| Term { name, membership, lower: None }));
    }
    Input {
        name: section.heading.text().into(),
        description: section.description.clone(),
        enabled: section.enabled,
        universe: section.universe,
        out_of_range: if section.lock_range { OutOfRange::Clamp } else { OutOfRange::Evaluate },
        terms: found,
    }
}

fn block(section: &FllSection, names: &Names, weighted: &[bool], report: &mut Report) -> RuleBlock {
    let rules = rules(section, names, report);
    let integrates = |rule: &Rule| {
        let own = rule.consequents.iter().map(|consequent| weighted.get(consequent.output));
        own.flatten().any(|weighted| !weighted)
    };
    if section.implication.is_none() && rules.iter().any(integrates) {
        let message = "has no implication, but concludes fuzzy sets";
        needs(section.heading, message, norms::classes(norms::T_NORMS), report);
    }
    let and = section.conjunction.unwrap_or(TNormKind::Minimum);
    RuleBlock {
        name: section.heading.text().into(),
        description: section.description.clone(),
        enabled: section.enabled,
        and: and.into(),
        or: section.disjunction.unwrap_or(and.dual()).into(),
        implication: section.implication.unwrap_or(TNormKind::Minimum).into(),
        activation: section.activation,
        rules,
    }
}

fn rules(section: &FllSection, names: &Names, report: &mut Report) -> Vec<Rule> {
    let mut rules = Vec::new();
    let (mut and, mut or) = (None, None);
    for line in &section.rules {
        let mut reader =
            rule::Reader::new(Tokens::new(Lexer::words(line.value)), names, report, |_| false);
        let found = reader.rule();
        (and, or) = (and.or(reader.and), or.or(reader.or));
        let next = reader.tokens.next;
        if found.is_some() && next.kind != Kind::End {
            report.problem(next.place(), next.text, "does not fit here", "the end of the rule");
        }
        rules.extend(found);
    }
    let (t_norms, s_norms) = (norms::classes(norms::T_NORMS), norms::classes(norms::S_NORMS));
    if section.conjunction.is_none() && and.is_some() {
        needs(section.heading, "has no conjunction, but its rules say `and`", t_norms, report);
    }
    if section.disjunction.is_none() && or.is_some() {
        needs(section.heading, "has no disjunction, but its rules say `or`", s_norms, report);
    }
    rules
}

/// A norm is missing.
pub(super) fn needs(
    heading: Line,
    message: &str,
    words: impl Iterator<Item = &'static str> + Clone,
    report: &mut Report,
) {
    report.problem(heading.start.place(), heading.text(), message, known(words, ""));
}
