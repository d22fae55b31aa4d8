//! The answer for people: a table of lines with what explains each, then the verdict.

use fspid_core::{Law, SelfTuner};
use fspid_sim::{Controller, Scenario};

use super::Verification;
use crate::analysis::not_in_the_linear_loop;
use crate::judgement::Judgement;
use crate::shell;
use fspid_diagnostics::digits::to_digits;
use fspid_diagnostics::lines::wrapped;
use fspid_page::number::capital;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::{Origin, set};

/// Width of a paragraph in characters.
const WIDTH: usize = 100;
/// Between two columns.
const GAP: &str = "  ";

impl Verification {
    /// The answer of `verify --format text`: a line for each requirement and controller, what is asked and where it is
    /// from, notes, and the verdict at the end. `replays` are the paths of the files that replay the lines, if they
    /// were written.
    #[must_use]
    pub fn text(&self, replays: Option<&[String]>) -> String {
        let mut out =
            format!("{} ({})\n\n", visible(&self.study.scenario.name), visible(&self.path));
        out.push_str(&self.table(replays));
        section(&mut out, FAILED_FLIGHTS, &self.failed_in_words());
        section(&mut out, "What is asked", &self.asked());
        section(&mut out, "Notes", &self.notes());
        if replays.is_none() {
            out.push_str(
                "\nWith --replay DIR each line gets a scenario of its own that gives its number again.\n",
            );
        }
        push(&mut out, &format!("\n{}", self.verdict()));
        out
    }

    fn table(&self, replays: Option<&[String]>) -> String {
        let rows: Vec<[String; COLUMNS]> = self.judgements.iter().map(cells).collect();
        let head = HEAD.map(str::to_owned);
        let width = |column: usize| {
            let lengths = rows.iter().map(|row| row[column].chars().count());
            match lengths.max().unwrap_or(0) {
                // A column in which nothing stands is left out.
                0 => 0,
                longest => longest.max(head[column].chars().count()),
            }
        };
        let widths: [usize; COLUMNS] = std::array::from_fn(width);
        let mut out = String::new();
        push(&mut out, &columns(&head, &widths));
        for (index, row) in rows.iter().enumerate() {
            push(&mut out, &columns(row, &widths));
            if let Some(replay) = replays.and_then(|replays| replays.get(index)) {
                push(&mut out, &format!("      replay: fspid verify {}", shell::word(replay)));
            }
        }
        out
    }

    /// Each requirement once: what is measured of what, and where it is from.
    pub(super) fn asked(&self) -> Vec<String> {
        let mut told: Vec<&str> = Vec::new();
        let mut lines = Vec::new();
        for requirement in self.judgements.iter().map(|judgement| &judgement.requirement) {
            if told.contains(&requirement.id.as_str()) {
                continue;
            }
            told.push(&requirement.id);
            let counted = match requirement.conditions.in_words() {
                words if words.is_empty() => String::new(),
                words => format!(" ({words})"),
            };
            let mut parts = vec![format!("{}{counted}", requirement.measure.doc())];
            parts.extend(source(&requirement.origin).map(|source| format!("source: {source}")));
            parts.extend(requirement.origin.note.as_ref().map(|note| format!("note: {note}")));
            lines.push(format!("{}: {}", requirement.id, parts.join("; ")));
        }
        lines
    }

    /// "7 of 9 requirements met; FAIL".
    fn verdict(&self) -> String {
        format!("{}; {}", self.counted(), self.word())
    }

    /// What all lines and flights amount to, in a word.
    pub(super) fn word(&self) -> &'static str {
        if self.all_met() { "PASS" } else { "FAIL" }
    }

    /// Flights that failed by themselves, in a sentence each.
    pub(super) fn failed_in_words(&self) -> Vec<String> {
        let failed = self.failed_flights.iter();
        failed.map(|it| format!("{}: {}.", it.who(), it.failures.join("; "))).collect()
    }

    /// "7 of 9 requirements met".
    pub(super) fn counted(&self) -> String {
        let count = self.judgements.len();
        let unevaluated =
            self.judgements.iter().filter(|judgement| judgement.found.is_err()).count();
        let some = match unevaluated {
            0 => String::new(),
            some => format!(", {some} could not be evaluated"),
        };
        let flights = match self.failed_flights.len() {
            0 => String::new(),
            1 => "; 1 flight failed".to_owned(),
            many => format!("; {many} flights failed"),
        };
        let noun = if count == 1 { "requirement" } else { "requirements" };
        format!("{} of {count} {noun} met{some}{flights}", count - self.unmet())
    }

    /// Which lines were judged on a flight of their own, and what that flight is.
    fn own_flights(&self) -> Vec<String> {
        let mut sizes_deg: Vec<f64> = Vec::new();
        for size_deg in self.judgements.iter().filter_map(|judgement| judgement.own_step_deg) {
            if !sizes_deg.contains(&size_deg) {
                sizes_deg.push(size_deg);
            }
        }
        let around = match self.study.scenario.autopilot {
            Some(_) => {
                " and of the pitch loop alone, without the outer loops, modes, total energy and glide slope around it"
            }
            None => "",
        };
        let own = |size_deg: f64| {
            let mut names: Vec<&str> = Vec::new();
            let of_it = self.judgements.iter().filter(|it| it.own_step_deg == Some(size_deg));
            for judgement in of_it {
                if !names.contains(&judgement.requirement.id.as_str()) {
                    names.push(&judgement.requirement.id);
                }
            }
            format!(
                "Judged on a flight of their own, because the command has no step of {0} deg: {1}. It is the scenario with a step of {0} deg at 0 s in place of its command{around}; everything else is as written.",
                to_digits(size_deg, 6),
                names.join(", ")
            )
        };
        sizes_deg.into_iter().map(own).collect()
    }

    /// Which gains are frozen.
    fn on_frozen_gains(&self) -> String {
        let scenario = &self.study.scenario;
        let numbers = |tuner: &SelfTuner<f64>| tuner.supervisor().numbers().is_some();
        let cells = match any_tuner(scenario, numbers) {
            true => ", the 49 cells where rules conclude numbers,",
            false => ",",
        };
        let reach = match any_tuner(scenario, |tuner| tuner.settings().law != Law::Memoryless) {
            true => {
                "; of an accumulating law those that it may come to, bounded from outside: the corners of that body, a grid in it, and such a search"
            }
            false => "",
        };
        format!(
            "Frozen gains are those of a map of 9 x 9 inputs of the supervisor{cells} and a search about the worst of them{reach}."
        )
    }

    /// What should be known about the numbers above.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = self.own_flights();
        notes.extend(self.at_rest.iter().cloned());
        notes.extend(self.study.range_rule.note().map(|note| format!("{}.", capital(note))));
        let asks = |family: Family| {
            self.judgements.iter().any(|judgement| judgement.requirement.measure.family() == family)
        };
        if asks(Family::Loop) || asks(Family::Frozen) {
            notes.extend(not_in_the_linear_loop(&self.study.scenario));
        }
        if asks(Family::Frozen) {
            notes.push(self.on_frozen_gains());
        }
        if self.judgements.iter().any(|j| j.requirement.measure == Measure::EquivalentDelay) {
            notes.push(
                "The equivalent delay is that of servo and delay at the frequency of the short period, with half a sample of the hold; the standard fits a whole band of frequencies."
                    .to_owned(),
            );
        }
        let mut names: Vec<&str> = Vec::new();
        for name in self.judgements.iter().filter_map(|j| j.requirement.origin.set.as_deref()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        notes.extend(names.into_iter().filter_map(set).map(|set| {
            format!("{}: {}. {} Source: {}.", set.name, set.title, set.notes, set.source)
        }));
        notes
    }
}

/// Whether something is so of a self-tuner of the scenario.
fn any_tuner(scenario: &Scenario, is_so: impl Fn(&SelfTuner<f64>) -> bool) -> bool {
    scenario.controllers.iter().any(|named| match &named.controller {
        Controller::SelfTuning(fspid) => is_so(fspid.tuner()),
        Controller::Fixed(_) => false,
    })
}

/// What stands over flights that failed by themselves.
pub(super) const FAILED_FLIGHTS: &str = "Flights that failed, whatever is required";

pub(super) const COLUMNS: usize = 8;
const HEAD: [&str; COLUMNS] =
    ["", "requirement", "measure", "clause", "controller", "found", "limit", "worst case"];
/// The column of numbers; they stand to the right, so that their units stand below each other.
const FOUND: usize = 5;

pub(super) fn cells(judgement: &Judgement) -> [String; COLUMNS] {
    let requirement = &judgement.requirement;
    let name = requirement.measure.name();
    let verdict = if judgement.met { "PASS" } else { "FAIL" };
    let (found, worst) = match &judgement.found {
        Ok(case) => (judgement.value_in_words(), case.place.to_string()),
        Err(reason) if reason.place().is_empty() => {
            ("not evaluated".to_owned(), reason.to_string())
        }
        Err(reason) => ("not evaluated".to_owned(), format!("{reason}; {}", reason.place())),
    };
    [
        verdict.to_owned(),
        requirement.id.clone(),
        // A requirement without a name of its own is called by its measure.
        if requirement.id == name { String::new() } else { name.to_owned() },
        requirement.origin.clause.clone().unwrap_or_default(),
        judgement.controller.clone(),
        found,
        requirement.limits_in_words(),
        worst,
    ]
    .map(|text| visible(&text))
}

/// "MIL-F-9490D 3.1.3.6, table of margins (recalled)".
fn source(origin: &Origin) -> Option<String> {
    let confidence =
        origin.confidence.map(|confidence| format!(" ({confidence})")).unwrap_or_default();
    match (&origin.source, &origin.clause) {
        (Some(source), Some(clause)) if !source.contains(clause.as_str()) => {
            Some(format!("{source}, {clause}{confidence}"))
        }
        (Some(text), _) | (None, Some(text)) => Some(format!("{text}{confidence}")),
        (None, None) if !confidence.is_empty() => Some(format!("numbers are{confidence}")),
        (None, None) => None,
    }
}

fn columns(row: &[String; COLUMNS], widths: &[usize; COLUMNS]) -> String {
    let cells = row.iter().zip(widths).enumerate().filter(|(_, (_, width))| **width > 0);
    let cells = cells.map(|(index, (cell, &width))| match index {
        FOUND => format!("{cell:>width$}"),
        _ => format!("{cell:width$}"),
    });
    cells.collect::<Vec<_>>().join(GAP)
}

fn section(out: &mut String, heading: &str, lines: &[String]) {
    if !lines.is_empty() {
        push(out, &format!("\n{heading}"));
        lines.iter().for_each(|line| out.push_str(&paragraph(line)));
    }
}

fn push(out: &mut String, text: &str) {
    out.push_str(&format!("{}\n", text.trim_end()));
}

/// Control characters would move the cursor of a terminal.
pub(super) fn visible(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// A text in lines that are not too long, with a mark before it.
fn paragraph(text: &str) -> String {
    visible_lines(&wrapped(text, "- ", WIDTH).join("\n"))
}

/// As [`visible`], for a text of several lines.
fn visible_lines(text: &str) -> String {
    text.lines().map(|line| format!("{}\n", visible(line))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_with_blanks_or_quotes_is_one_word_for_a_shell() {
        assert_eq!(shell::word("a/b-1.toml"), "a/b-1.toml");
        assert_eq!(shell::word("a b/it's.toml"), "'a b/it'\\''s.toml'");
    }

    #[test]
    fn a_long_note_is_broken_at_blanks() {
        let text = paragraph(&"word ".repeat(60));
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert!(
            text.starts_with("- word")
                && text.lines().nth(1).is_some_and(|l| l.starts_with("  word"))
        );
    }
}
