//! The sections of a file, as they are filled line by line.

use fspid_fuzzy::system::{Activation, Universe};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::lines::{Line, numbers};
use crate::report::Report;
use crate::term;
use crate::vocabulary::norms::{self, S_NORMS, T_NORMS};
use crate::vocabulary::{known, methods};

/// What is said about a variable or rule block, kept until the whole file has been read.
#[derive(Debug)]
pub(super) struct FllSection<'a> {
    pub(super) heading: Line<'a>,
    pub(super) kind: Kindred,
    pub(super) description: String,
    pub(super) enabled: bool,
    pub(super) universe: Option<Universe>,
    pub(super) lock_range: bool,
    pub(super) lock_previous: bool,
    /// NaN for none.
    pub(super) default: f64,
    pub(super) terms: Vec<Line<'a>>,
    pub(super) rules: Vec<Line<'a>>,
    pub(super) aggregation: Option<SNormKind>,
    pub(super) defuzzifier: Option<Line<'a>>,
    pub(super) conjunction: Option<TNormKind>,
    pub(super) disjunction: Option<SNormKind>,
    pub(super) implication: Option<TNormKind>,
    pub(super) activation: Activation,
}

/// Which section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kindred {
    Engine,
    Input,
    Output,
    Block,
}

/// Headings of sections.
pub(super) const HEADINGS: [(&str, Kindred); 4] = [
    ("Engine", Kindred::Engine),
    ("InputVariable", Kindred::Input),
    ("OutputVariable", Kindred::Output),
    ("RuleBlock", Kindred::Block),
];

type Fill = for<'a> fn(&mut FllSection<'a>, Line<'a>, &mut Report);

/// A key and the sections it may stand in.
struct SectionKey {
    key: &'static str,
    sections: &'static [Kindred],
    fill: Fill,
}

const fn key(key: &'static str, sections: &'static [Kindred], fill: Fill) -> SectionKey {
    SectionKey { key, sections, fill }
}

const VARIABLE: &[Kindred] = &[Kindred::Input, Kindred::Output];
const OUTPUT: &[Kindred] = &[Kindred::Output];
const BLOCK: &[Kindred] = &[Kindred::Block];
const ANY: &[Kindred] = &[Kindred::Engine, Kindred::Input, Kindred::Output, Kindred::Block];

/// Every key; the last four of versions before 6.
const KEYS: &[SectionKey] = &[
    key("description", ANY, |s, line, _| s.description = line.text().into()),
    key("enabled", &[Kindred::Input, Kindred::Output, Kindred::Block], |s, line, report| {
        s.enabled = line.boolean(report).unwrap_or(true)
    }),
    key("range", VARIABLE, |s, line, report| s.universe = range(line, report)),
    key("lock-range", VARIABLE, |s, line, report| {
        s.lock_range = line.boolean(report).unwrap_or(false)
    }),
    key("term", VARIABLE, |s, line, _| s.terms.push(line)),
    key("aggregation", OUTPUT, aggregation),
    key("defuzzifier", OUTPUT, |s, line, _| s.defuzzifier = Some(line)),
    key("default", OUTPUT, default),
    key("lock-previous", OUTPUT, lock_previous),
    key("conjunction", BLOCK, |s, line, report| s.conjunction = t_norm(line, report)),
    key("disjunction", BLOCK, |s, line, report| s.disjunction = s_norm(line, report)),
    key("implication", BLOCK, |s, line, report| s.implication = t_norm(line, report)),
    key("activation", BLOCK, activation),
    key("rule", BLOCK, |s, line, _| s.rules.push(line)),
    key("accumulation", OUTPUT, aggregation),
    key("lock-valid", OUTPUT, lock_previous),
    key("lock-output-value", OUTPUT, lock_previous),
    key("lock-output-range", OUTPUT, |s, line, report| {
        s.lock_range = line.boolean(report).unwrap_or(false)
    }),
];

impl<'a> FllSection<'a> {
    pub(super) fn new(kind: Kindred, heading: Line<'a>) -> Self {
        Self {
            heading,
            kind,
            description: String::new(),
            enabled: true,
            universe: None,
            lock_range: false,
            lock_previous: false,
            default: f64::NAN,
            terms: Vec::new(),
            rules: Vec::new(),
            aggregation: None,
            defuzzifier: None,
            conjunction: None,
            disjunction: None,
            implication: None,
            activation: Activation::General,
        }
    }

    /// Takes in a line; one with an unknown key is reported.
    pub(super) fn fill(&mut self, line: Line<'a>, report: &mut Report) {
        let here = |row: &&SectionKey| row.sections.contains(&self.kind);
        match KEYS.iter().filter(here).find(|row| line.is(row.key)) {
            Some(row) => (row.fill)(self, line, report),
            None => {
                let message = format!("not a key of {}", self.heading.key);
                let expected = known(KEYS.iter().filter(here).map(|row| row.key), line.key);
                report.problem(line.start.place(), line.key, message, expected);
            }
        }
    }
}

fn t_norm(line: Line, report: &mut Report) -> Option<TNormKind> {
    line.choice(|class| norms::of_class(T_NORMS, class), norms::classes(T_NORMS), report)
}

fn s_norm(line: Line, report: &mut Report) -> Option<SNormKind> {
    line.choice(|class| norms::of_class(S_NORMS, class), norms::classes(S_NORMS), report)
}

fn aggregation<'a>(section: &mut FllSection<'a>, line: Line<'a>, report: &mut Report) {
    section.aggregation = s_norm(line, report);
}

fn lock_previous<'a>(section: &mut FllSection<'a>, line: Line<'a>, report: &mut Report) {
    section.lock_previous = line.boolean(report).unwrap_or(false);
}

fn default<'a>(section: &mut FllSection<'a>, line: Line<'a>, report: &mut Report) {
    match line.word(report) {
        Some(word) if !word.is("nan") => {
            section.default = term::finite(word, report).map_or(f64::NAN, |number| number.value);
        }
        _ => section.default = f64::NAN,
    }
}

/// Two numbers in ascending order; two infinities are no universe.
fn range(line: Line, report: &mut Report) -> Option<Universe> {
    let found = numbers(line.tokens(), report)?;
    let ends: Vec<f64> = found.iter().map(|number| number.value).collect();
    match ends[..] {
        [lower, upper] if lower == f64::NEG_INFINITY && upper == f64::INFINITY => None,
        [lower, upper] if lower < upper && (upper - lower).is_finite() => {
            Some(Universe { lower, upper })
        }
        _ => {
            line.wrong(
                "not a range",
                "two finite numbers in ascending order, or `-inf inf`",
                report,
            );
            None
        }
    }
}

/// Before version 6 the key named what is now the implication.
fn activation<'a>(section: &mut FllSection<'a>, line: Line<'a>, report: &mut Report) {
    if let Some(norm) = norms::of_class(T_NORMS, line.text()) {
        report.note(line.value.place(), "an activation that is a norm is read as the implication");
        section.implication = Some(norm);
    } else if !line.is_none() {
        section.activation = super::activation::read(line, report).unwrap_or_default();
    }
}

/// The defuzzifiers, for a message.
pub(super) fn defuzzifiers(found: &str) -> String {
    known(methods::classes().chain(["none"]), found)
}
