//! The sections of a file, as they are filled line by line.

use fspid_fuzzy::system::{Activation, Comparison, Universe};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::lines::{Line, numbers};
use crate::report::Report;
use crate::term;
use crate::vocabulary::norms::{self, S_NORMS, T_NORMS};
use crate::vocabulary::{known, methods};

/// What is said about a variable or rule block, kept until the whole file has been read.
#[derive(Debug)]
pub(super) struct Section<'a> {
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

type Fill = for<'a> fn(&mut Section<'a>, Line<'a>, &mut Report);

/// A key and the sections it may stand in.
struct Row {
    key: &'static str,
    sections: &'static [Kindred],
    fill: Fill,
}

const VARIABLE: &[Kindred] = &[Kindred::Input, Kindred::Output];
const OUTPUT: &[Kindred] = &[Kindred::Output];
const BLOCK: &[Kindred] = &[Kindred::Block];
const ANY: &[Kindred] = &[Kindred::Engine, Kindred::Input, Kindred::Output, Kindred::Block];

/// Every key; the last four of versions before 6.
const KEYS: &[Row] = &[
    Row {
        key: "description",
        sections: ANY,
        fill: |s, line, _| s.description = line.text().into(),
    },
    Row {
        key: "enabled",
        sections: &[Kindred::Input, Kindred::Output, Kindred::Block],
        fill: |s, line, report| s.enabled = line.boolean(report).unwrap_or(true),
    },
    Row {
        key: "range",
        sections: VARIABLE,
        fill: |s, line, report| s.universe = range(line, report),
    },
    Row {
        key: "lock-range",
        sections: VARIABLE,
        fill: |s, line, report| s.lock_range = line.boolean(report).unwrap_or(false),
    },
    Row { key: "term", sections: VARIABLE, fill: |s, line, _| s.terms.push(line) },
    Row { key: "aggregation", sections: OUTPUT, fill: aggregation },
    Row { key: "defuzzifier", sections: OUTPUT, fill: |s, line, _| s.defuzzifier = Some(line) },
    Row { key: "default", sections: OUTPUT, fill: default },
    Row { key: "lock-previous", sections: OUTPUT, fill: lock_previous },
    Row {
        key: "conjunction",
        sections: BLOCK,
        fill: |s, line, report| s.conjunction = t_norm(line, report),
    },
    Row {
        key: "disjunction",
        sections: BLOCK,
        fill: |s, line, report| s.disjunction = s_norm(line, report),
    },
    Row {
        key: "implication",
        sections: BLOCK,
        fill: |s, line, report| s.implication = t_norm(line, report),
    },
    Row { key: "activation", sections: BLOCK, fill: activation },
    Row { key: "rule", sections: BLOCK, fill: |s, line, _| s.rules.push(line) },
    Row { key: "accumulation", sections: OUTPUT, fill: aggregation },
    Row { key: "lock-valid", sections: OUTPUT, fill: lock_previous },
    Row { key: "lock-output-value", sections: OUTPUT, fill: lock_previous },
    Row {
        key: "lock-output-range",
        sections: OUTPUT,
        fill: |s, line, report| s.lock_range = line.boolean(report).unwrap_or(false),
    },
];

impl<'a> Section<'a> {
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
        let here = |row: &&Row| row.sections.contains(&self.kind);
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

fn aggregation<'a>(section: &mut Section<'a>, line: Line<'a>, report: &mut Report) {
    section.aggregation = s_norm(line, report);
}

fn lock_previous<'a>(section: &mut Section<'a>, line: Line<'a>, report: &mut Report) {
    section.lock_previous = line.boolean(report).unwrap_or(false);
}

fn default<'a>(section: &mut Section<'a>, line: Line<'a>, report: &mut Report) {
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

/// Activation methods.
const ACTIVATIONS: [&str; 7] =
    ["General", "First", "Last", "Highest", "Lowest", "Proportional", "Threshold"];

/// Signs of comparisons.
pub(super) const COMPARISONS: [(&str, Comparison); 6] = [
    ("<", Comparison::Less),
    ("<=", Comparison::AtMost),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    (">=", Comparison::AtLeast),
    (">", Comparison::Greater),
];

/// Before version 6 the key named what is now the implication.
fn activation<'a>(section: &mut Section<'a>, line: Line<'a>, report: &mut Report) {
    if let Some(norm) = norms::of_class(T_NORMS, line.text()) {
        report.note(line.value.place(), "an activation that is a norm is read as the implication");
        section.implication = Some(norm);
    } else if !line.is_none() {
        section.activation = method(line, report).unwrap_or_default();
    }
}

fn method(line: Line, report: &mut Report) -> Option<Activation> {
    let mut tokens = line.tokens();
    let word = tokens.advance();
    let sign = COMPARISONS.iter().find(|row| tokens.next.is(row.0));
    if word.is("Threshold") && sign.is_some() {
        tokens.advance();
    }
    let first_place = tokens.next.place();
    let found = numbers(tokens, report)?;
    let values: Vec<f64> = found.iter().map(|number| number.value).collect();
    let comparison = sign.map_or(Comparison::AtLeast, |row| row.1);
    let activation = build(word.text, &values, comparison);
    if activation.is_none() {
        let unknown = !ACTIVATIONS.iter().any(|known| word.is(known));
        let (place, text, message) = match unknown {
            true => (word.place(), word.text, "not an activation method"),
            false => (first_place, "", "does not fit this activation method"),
        };
        let expected =
            if unknown { known(ACTIVATIONS.into_iter(), word.text) } else { FITS.into() };
        report.problem(place, text, message, expected);
    }
    activation
}

const FITS: &str = "`First` and `Last` with a count and a threshold, `Highest` and `Lowest` with a \
                    count, `Threshold` with a comparison and a number, the others with nothing";

fn build(word: &str, values: &[f64], comparison: Comparison) -> Option<Activation> {
    let is = |name: &str| word.eq_ignore_ascii_case(name);
    match values {
        [] if is("General") => Some(Activation::General),
        [] if is("Proportional") => Some(Activation::Proportional),
        [] if is("Threshold") => Some(Activation::Threshold { comparison, threshold: 0.0 }),
        &[threshold] if is("Threshold") => Some(Activation::Threshold { comparison, threshold }),
        [] => counted(word, 1, None),
        &[count] => counted(word, whole(count)?, None),
        &[count, threshold] => counted(word, whole(count)?, Some(threshold)),
        _ => None,
    }
}

/// Methods that choose a number of rules; two of them know a threshold, too.
fn counted(word: &str, count: u32, given: Option<f64>) -> Option<Activation> {
    let is = |name: &str| word.eq_ignore_ascii_case(name);
    let threshold = given.unwrap_or(0.0);
    match given {
        _ if is("First") => Some(Activation::First { count, threshold }),
        _ if is("Last") => Some(Activation::Last { count, threshold }),
        None if is("Highest") => Some(Activation::Highest { count }),
        None if is("Lowest") => Some(Activation::Lowest { count }),
        _ => None,
    }
}

/// A count.
pub(super) fn whole(number: f64) -> Option<u32> {
    let fits = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
    fits.then_some(number as u32)
}

/// The defuzzifiers, for a message.
pub(super) fn defuzzifiers(found: &str) -> String {
    known(methods::classes().chain(["none"]), found)
}
