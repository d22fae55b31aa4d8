//! Reading.

use std::collections::BTreeMap;

use fspid_fuzzy::system::{
    Activation, Conclusion, Consequent, Defuzzifier, Input, Membership, Output, Parts, Rule,
    RuleBlock, Sampling, SetReading, Term, Variable,
};
use fspid_fuzzy::{OutOfRange, SNormKind, TNormKind};

use super::lines::{self};
use super::output;
use super::sections::{FllSection, HEADINGS, Kindred};
use super::term::{distinct, membership, needs, terms};
use crate::cursor::Cursor;
use crate::lexer::{Kind, Lexer};
use crate::names::Names;
use crate::note::Reading;
use crate::report::Report;
use crate::tokens::Tokens;
use crate::vocabulary::{known, norms};
use crate::{check, repeated, rule, term};
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
    parts.blocks.iter().for_each(|block| asked_in_turn(block, parts, report));
    for (index, output) in parts.outputs.iter().enumerate() {
        let adds_up = repeated::adds_up(parts, index);
        if adds_up && !output.aggregation.is(SNormKind::UnboundedSum) {
            let note = "rules that conclude the same are added up, whatever the aggregation, as in fuzzylite before version 8; \
                        version 8 joins them by the aggregation, and adds them up by `none`";
            report.note_whole(format!("`{}`: {note}", output.name));
        }
        bisected(output, report);
        inverted(output, report);
    }
    if report.is_clean() {
        concluded_again(parts, report);
        concluded_from_nothing(parts, report);
    }
}

/// Tells of hedges by which something is concluded of nothing.
///
/// Seen of pyfuzzylite 8.0.6, and not of fuzzylite 6.0.
fn concluded_from_nothing(parts: &Parts, report: &mut Report) {
    let rules = parts.blocks.iter().flat_map(|block| &block.rules);
    let of_nothing = |consequent: &Consequent| {
        consequent.hedges.iter().rev().fold(0.0, |degree: f64, hedge| hedge.apply(degree)) > 0.0
    };
    if rules.flat_map(|rule| &rule.consequents).any(of_nothing) {
        report.note_whole(
            "a rule that does not fire concludes nothing, also by `not` or `any`, as in fuzzylite before version 8",
        );
    }
}

/// Tells of sets that a weighted method reads by the strength of several conclusions.
///
/// Read in pyfuzzylite 8.0.6, and seen of it and of fuzzylite 6.0.
fn concluded_again(parts: &Parts, report: &mut Report) {
    let mut counts = BTreeMap::new();
    let rules = parts.blocks.iter().flat_map(|block| &block.rules);
    for consequent in rules.flat_map(|rule| &rule.consequents) {
        *counts.entry((consequent.output, consequent.term)).or_insert(0) += 1;
    }
    for ((output, term), count) in counts {
        let Some(output) = parts.outputs.get(output) else { continue };
        let Some(term) = output.terms.get(term) else { continue };
        let is_set = matches!(term.conclusion, Conclusion::Set { .. });
        if count > 1 && is_set && output.defuzzifier.sampling().is_none() {
            report.note_whole(format!(
                "`{}`, `{}`: each of its {count} conclusions has a value by its own strength, as in fuzzylite before version 8; \
                 from that version on their strengths are joined first",
                output.name, term.name
            ));
        }
    }
}

/// Tells of outputs that are asked by the block that concludes them and that does not let every rule act.
///
/// Seen of pyfuzzylite 8.0.6: of General and First the answers are the same.
fn asked_in_turn(block: &RuleBlock, parts: &Parts, report: &mut Report) {
    if matches!(block.activation, Activation::General | Activation::First { .. }) {
        return;
    }
    for (index, output) in parts.outputs.iter().enumerate() {
        let is_it = |variable| variable == Variable::Output(index);
        let concludes = |rule: &Rule| rule.consequents.iter().any(|it| it.output == index);
        let is_asked = block.rules.iter().any(|rule| rule.antecedent.asks(&is_it));
        if is_asked && block.rules.iter().any(concludes) {
            report.note_whole(format!(
                "`{}`: rules of the block that concludes it ask it, and not every rule of the block acts: here they ask what all rules \
                 before them conclude, in fuzzylite what those conclude that act, so that ANSWERS DIFFER",
                output.name
            ));
        }
    }
}

/// Tells how far the bisector of fuzzylite may be from the one that is computed here.
///
/// Seen of pyfuzzylite 8.0.6 over 4000 sets at random; it answers with the middle or an end of a cell.
fn bisected(output: &Output, report: &mut Report) {
    if let (Defuzzifier::Bisector(Sampling::Midpoint(count)), Some(universe)) =
        (output.defuzzifier, output.universe)
    {
        let cell = universe.span() / f64::from(count);
        report.note_whole(format!(
            "`{}`: fuzzylite bisects samples by a rule of its own, which changed with its versions: its answer may be a cell \
             ({cell}) away, and more where the set is as narrow as a cell or has a gap in its middle",
            output.name
        ));
    }
}

/// Tells of sets that are asked above their height.
fn inverted(output: &Output, report: &mut Report) {
    let (Defuzzifier::WeightedAverage(SetReading::Tsukamoto)
    | Defuzzifier::WeightedSum(SetReading::Tsukamoto)) = output.defuzzifier
    else {
        return;
    };
    for term in &output.terms {
        if let Conclusion::Set { membership: Membership::Shape { height, .. }, .. } =
            &term.conclusion
            && *height < 1.0
        {
            report.note_whole(format!(
                "`{}`, `{}`: a strength above its height of {height} counts as that height; fuzzylite goes on beyond the \
                 set, or has no answer",
                output.name, term.name
            ));
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
    let read = |section| block(section, &names, &parts.outputs, report);
    parts.blocks = of(Kindred::Block).map(read).collect();
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

fn block(
    section: &FllSection,
    names: &Names,
    outputs: &[Output],
    report: &mut Report,
) -> RuleBlock {
    let rules = rules(section, names, outputs, report);
    let integrates = |rule: &Rule| {
        let own = rule.consequents.iter().map(|consequent| outputs.get(consequent.output));
        own.flatten().any(|output| output.defuzzifier.sampling().is_some())
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

fn rules(
    section: &FllSection,
    names: &Names,
    outputs: &[Output],
    report: &mut Report,
) -> Vec<Rule> {
    let mut rules = Vec::new();
    let enabled = rule::switches(outputs);
    let (mut and, mut or) = (None, None);
    for line in &section.rules {
        let mut reader =
            rule::Reader::new(Tokens::new(Lexer::words(line.value)), names, report, rule::LINE);
        let found = reader.rule();
        (and, or) = (and.or(reader.and), or.or(reader.or));
        let next = reader.tokens.next;
        if found.is_some() && next.kind != Kind::End {
            report.problem(next.place(), next.text, "does not fit here", "the end of the rule");
        }
        rules.extend(found.map(|mut rule| {
            rule::take_along(&mut rule, &enabled, line.start.place(), report);
            rule
        }));
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
