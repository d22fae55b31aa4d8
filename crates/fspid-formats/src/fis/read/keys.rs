//! The keys of a section: each once, known ones by name, membership functions by number.

use std::collections::BTreeMap;

use super::source::{Entry, FisSection};
use crate::report::{Report, one_of, wrong};
use fspid_diagnostics::Problem;

/// Keys of `[System]`.
pub(super) const SYSTEM: &[&str] = &[
    "Name",
    "Type",
    "Version",
    "NumInputs",
    "NumOutputs",
    "NumRules",
    "AndMethod",
    "OrMethod",
    "ImpMethod",
    "AggMethod",
    "DefuzzMethod",
    "TypeRedMethod",
];

/// Keys of `[Input1]` and `[Output1]`, beside the membership functions.
pub(super) const VARIABLE: &[&str] = &["Name", "Range", "NumMFs", "Enabled"];

/// Keys that change no answer.
const HARMLESS: &[&str] =
    &["Description", "Comment", "Author", "Date", "Created", "outputType", "CrispInterval"];

/// Keys of files whose meaning is not described anywhere.
const TYPE_2: &[&str] = &["TypeReductionMethod", "LowerScale", "LowerLag", "UpperMF", "LowerMF"];

/// What is said about files of MATLAB's own type-2 systems.
pub(super) const NO_TYPE_2: &str = "interval type-2 systems of MATLAB R2019b and later are not read: their files are not described";

/// Which of a pair of membership functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    /// The only one.
    Plain,
    /// The upper one of a type-2 set.
    Upper,
    /// The lower one of a type-2 set.
    Lower,
}

/// The keys of a section.
#[derive(Debug, Default)]
pub(super) struct Keys<'a> {
    known: BTreeMap<&'static str, Entry<'a>>,
    /// `MF1`, `MF1U`, …
    pub(super) sets: BTreeMap<(usize, Side), Entry<'a>>,
}

impl<'a> Keys<'a> {
    /// Sorts a section by keys and says what does not belong into it.
    pub(super) fn of(
        section: &FisSection<'a>,
        known: &'static [&'static str],
        report: &mut Report,
    ) -> Self {
        let mut keys = Self::default();
        for &entry in &section.entries {
            if report.is_full() {
                break;
            }
            let taken = keys.take(entry, known, report);
            report.keep(taken);
        }
        keys
    }

    fn take(
        &mut self,
        entry: Entry<'a>,
        known: &'static [&'static str],
        report: &mut Report,
    ) -> Result<(), Problem> {
        let is = |name: &&&'static str| name.eq_ignore_ascii_case(entry.key);
        if let Some(name) = known.iter().find(is) {
            return once(entry, self.known.insert(name, entry));
        }
        if let Some(set) = set_key(entry.key).filter(|_| known == VARIABLE) {
            return once(entry, self.sets.insert(set, entry));
        }
        if let Some(name) = HARMLESS.iter().find(is) {
            report.note(entry.place, format!("`{name}` changes no answer and is not kept"));
            return Ok(());
        }
        let expected = || one_of(known.iter().copied(), entry.key);
        Err(match TYPE_2.iter().find(is) {
            Some(_) => wrong(entry.place, entry.key, NO_TYPE_2, ""),
            None => wrong(entry.place, entry.key, "unknown key", expected()),
        })
    }

    /// The entry of a known key.
    pub(super) fn get(&self, name: &str) -> Option<Entry<'a>> {
        self.known.get(name).copied()
    }
}

fn once(entry: Entry, before: Option<Entry>) -> Result<(), Problem> {
    before.map_or(Ok(()), |before| {
        let message = format!("stands here again; the first is in line {}", before.place.line);
        Err(wrong(entry.place, entry.key, message, "each key once"))
    })
}

/// The number and side of `MF12U`.
fn set_key(key: &str) -> Option<(usize, Side)> {
    let (letters, rest) = key.split_at_checked(2)?;
    let digits = rest.trim_start().trim_end_matches(['U', 'u', 'L', 'l']);
    let side = match rest.trim_start().strip_prefix(digits)? {
        "" => Side::Plain,
        "U" | "u" => Side::Upper,
        "L" | "l" => Side::Lower,
        _ => return None,
    };
    let number = digits.parse().ok().filter(|number| *number > 0)?;
    letters.eq_ignore_ascii_case("MF").then_some((number, side))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn membership_functions_are_known_by_number_and_side() {
        assert_eq!(set_key("MF1"), Some((1, Side::Plain)));
        assert_eq!(set_key("mf 12u"), Some((12, Side::Upper)));
        assert_eq!(set_key("MF3L"), Some((3, Side::Lower)));
        for key in ["MF", "MF0", "MF1X", "MF1UL", "M", "ÄÖ1", "MF99999999999999999999"] {
            assert_eq!(set_key(key), None, "{key}");
        }
    }
}
