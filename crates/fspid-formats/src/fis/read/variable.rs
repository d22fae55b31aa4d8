//! `[Input1]` and `[Output1]`: what they have in common.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Input, Membership, Term, Universe};

use super::keys::{Keys, Side, VARIABLE};
use super::membership::{self, Written};
use super::source::{Entry, FisSection};
use super::value;
use crate::number;
use crate::report::{Report, wrong};
use fspid_diagnostics::{Place, Problem};

/// A variable before its sets are looked at.
#[derive(Debug)]
pub(super) struct Variable<'a> {
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) enabled: bool,
    pub(super) universe: Option<Universe>,
    pub(super) sets: Vec<Set<'a>>,
}

/// A set as it is written: one membership function, or a pair of them. What could not be read has
/// been noted down as a problem.
#[derive(Debug)]
pub(super) struct Set<'a> {
    pub(super) label: String,
    pub(super) paired: bool,
    pub(super) upper: Option<Written<'a>>,
    pub(super) lower: Option<Written<'a>>,
}

impl<'a> Variable<'a> {
    /// Reads a section; `word` is what an unnamed one is called.
    pub(super) fn of(
        section: &FisSection<'a>,
        word: &str,
        number: usize,
        report: &mut Report,
    ) -> Self {
        let keys = Keys::of(section, VARIABLE, report);
        let name = keys.get("Name").and_then(|entry| report.keep(value::word(entry.value)));
        let name = name.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| {
            report.note(section.place, format!("has no name and is called `{word}{number}`"));
            format!("{word}{number}")
        });
        let universe = range(&keys, section, report);
        let enabled = keys.get("Enabled").is_none_or(|entry| switch(&entry, report));
        let sets = sets(&keys, report);
        told(&keys, "NumMFs", sets.len(), "membership functions", report);
        if sets.iter().any(|set| set.lower.as_ref().is_some_and(|low| low.label != set.label)) {
            report.note(section.place, "labels of lower membership functions are not kept");
        }
        Self { name, place: section.place, enabled, universe, sets }
    }

    /// The same as an input.
    pub(super) fn input(self, report: &mut Report) -> Input {
        let terms = self.sets.iter().map(|set| set.term(report)).collect();
        Input {
            name: self.name,
            description: String::new(),
            enabled: self.enabled,
            universe: self.universe,
            out_of_range: OutOfRange::Evaluate,
            terms,
        }
    }
}

impl Set<'_> {
    /// The set as a term.
    pub(super) fn term(&self, report: &mut Report) -> Term {
        let (membership, lower) = self.memberships(report);
        Term { name: self.label.clone(), membership, lower }
    }

    /// Both membership functions, the lower one if it differs; a placeholder takes the place of one
    /// that cannot be read.
    pub(super) fn memberships(&self, report: &mut Report) -> (Membership, Option<Membership>) {
        let mut read = |written: &Written| {
            let set = membership::set(written, self.paired, report);
            report.keep(set).unwrap_or_else(placeholder)
        };
        let upper = self.upper.as_ref().map_or_else(placeholder, &mut read);
        let lower = self.lower.as_ref().map(read).filter(|lower| *lower != upper);
        (upper, lower)
    }
}

/// Never handed out: a problem has been noted down.
fn placeholder() -> Membership {
    let kind = ShapeKind::Triangle;
    Membership::Shape { kind, params: kind.example().to_vec(), height: 1.0 }
}

fn switch(entry: &Entry, report: &mut Report) -> bool {
    let word = report.keep(value::word(entry.value)).unwrap_or_default();
    match word.as_str() {
        "1" | "true" => return true,
        "0" | "false" => return false,
        _ => report.problem(entry.value.place(), &word, "is no switch", "`1` or `0`"),
    }
    true
}

/// `Range=[lower upper]`; infinite ends stand for no range.
fn range(keys: &Keys, section: &FisSection, report: &mut Report) -> Option<Universe> {
    let Some(entry) = keys.get("Range") else {
        report.problem(section.place, "", "has no range", "`Range=[lower upper]`");
        return None;
    };
    let universe = report.keep(ends(&entry))?;
    if universe.span().is_finite() {
        return Some(universe);
    }
    report.note(entry.place, "an infinite range is read as no range");
    None
}

fn ends(entry: &Entry) -> Result<Universe, Problem> {
    let mut cursor = entry.value;
    let numbers = value::list(&mut cursor)?;
    value::over(cursor)?;
    let message = match numbers[..] {
        [lower, upper] if lower.value < upper.value => {
            return Ok(Universe { lower: lower.value, upper: upper.value });
        }
        [_, _] => "the lower end is not below the upper one",
        _ => "is no range",
    };
    Err(wrong(
        entry.value.place(),
        entry.value.rest(),
        message,
        "`[lower upper]`, in ascending order",
    ))
}

/// Notes a number in the file that is not what was found.
pub(super) fn told(keys: &Keys, key: &str, found: usize, what: &str, report: &mut Report) {
    let Some(entry) = keys.get(key) else { return };
    let Some(told) = report.keep(value::count(entry.value)) else { return };
    #[allow(clippy::cast_precision_loss, reason = "a text of 10 MiB holds fewer than 2^53 things")]
    let agrees = (told - found as f64).abs() < 0.5;
    if !agrees {
        let told = number::written(told);
        report.note(entry.place, format!("`{key}` says {told}, but there are {found} {what}"));
    }
}

/// Every set, in the order of their numbers, which must not have gaps.
fn sets<'a>(keys: &Keys<'a>, report: &mut Report) -> Vec<Set<'a>> {
    let mut numbers: Vec<usize> = keys.sets.keys().map(|(number, _)| *number).collect();
    numbers.dedup();
    let mut before = 0;
    let mut sets = Vec::new();
    for number in numbers {
        if report.is_full() {
            break;
        }
        sets.push(set(keys, number, before + 1, report));
        before = number;
    }
    sets
}

fn set<'a>(keys: &Keys<'a>, number: usize, expected: usize, report: &mut Report) -> Set<'a> {
    let sides = [Side::Plain, Side::Upper, Side::Lower];
    let entries = sides.map(|side| keys.sets.get(&(number, side)).copied());
    let refused = misfit(entries, number, expected);
    let mut read = |entry: Entry<'a>| report.keep(membership::written(&entry));
    let [plain, upper, lower] = entries;
    let paired = plain.is_none();
    let upper = plain.or(upper).and_then(&mut read);
    let lower = lower.and_then(read);
    if let Some(problem) = refused {
        report.push(problem);
    }
    let label = upper.as_ref().map(|written| written.label.clone()).unwrap_or_default();
    Set { label, paired, upper, lower }
}

/// Why these entries of one number are neither a membership function nor a pair of them.
fn misfit(entries: [Option<Entry>; 3], number: usize, expected: usize) -> Option<Problem> {
    let [plain, upper, lower] = entries;
    let refused = |entry: Entry, message: &str, expected: String| {
        Some(wrong(entry.place, entry.key, message, expected))
    };
    if let Some(entry) = plain.or(upper).or(lower).filter(|_| number != expected) {
        return refused(entry, "a number is left out", format!("`MF{expected}`"));
    }
    match (plain, upper, lower) {
        (Some(_), Some(entry), _) | (Some(_), None, Some(entry)) => {
            refused(entry, "stands beside one without a letter", format!("`MF{number}` alone"))
        }
        (None, Some(entry), None) => {
            refused(entry, "has no lower one", format!("`MF{number}L` too"))
        }
        (None, None, Some(entry)) => {
            refused(entry, "has no upper one", format!("`MF{number}U` too"))
        }
        _ => None,
    }
}
