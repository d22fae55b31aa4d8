//! Plants and rule tables: by name, by file or by their numbers.

use fspid_fuzzy::RuleTable;
use fspid_lti::{LtiError, Polynomial};
use fspid_sim::{ElevatorSign, LinearPlant, SimError};

use super::elevator_sign;
use crate::carried::{plant_text, rule_table_text};
use crate::file::files::Files;
use crate::file::spec::controller::TABLE;
use crate::file::spec::data::{DELTA_KD, DELTA_KI, DELTA_KP};
use crate::file::spec::scenario as keys;
use crate::file::spec::{PLANT_FILE, RULE_FILE};
use crate::keyed::{Key, Rules, Section, Table, check, document};
use fspid_diagnostics::{Report, Span};

/// The plant of a table with `preset`, `file` or coefficients.
pub(super) fn plant(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
) -> Option<LinearPlant> {
    if let Some(name) = section.get(keys::PRESET) {
        let part = carried(
            report,
            files,
            &PLANT_FILE,
            (name, plant_text(name)?, &section.path(keys::PRESET)),
        )?;
        return of_file(report, files, section.path(keys::PRESET), part);
    }
    if let Some(file) = section.get(keys::FILE) {
        let at = (section.at(keys::FILE), section.path(keys::FILE));
        let part = referred(report, files, &PLANT_FILE, (file, at))?;
        return of_file(report, files, section.path(keys::FILE), part);
    }
    coefficients(report, section, elevator_sign(section)?)
}

/// The plant of a file that the key at `path` refers to.
fn of_file(
    report: &mut Report,
    files: &mut Files<'_>,
    path: String,
    part: Section,
) -> Option<LinearPlant> {
    let plant = coefficients(report, &part, elevator_sign(&part)?);
    files.keep(path, &PLANT_FILE, part);
    plant
}

/// The plant of a table's numerator and denominator.
pub(crate) fn coefficients(
    report: &mut Report,
    section: &Section,
    sign: ElevatorSign,
) -> Option<LinearPlant> {
    let numerator = section.numbers(keys::NUMERATOR)?;
    let denominator = section.numbers(keys::DENOMINATOR)?;
    match LinearPlant::new(&numerator, &denominator, sign) {
        Ok(plant) => Some(plant),
        Err(error) => {
            let (message, allowed) = in_words(&error);
            let (place, path) = match &error {
                SimError::Linear(LtiError::NotFinite { .. }) => farthest_coefficient(section)?,
                _ => {
                    // The denominator where it is none by itself; all else is said of the numerator.
                    let is_polynomial = |numbers: &[f64]| Polynomial::new(numbers).is_ok();
                    let of_denominator = is_polynomial(&numerator) && !is_polynomial(&denominator);
                    let key = if of_denominator { keys::DENOMINATOR } else { keys::NUMERATOR };
                    (section.at(key), section.path(key))
                }
            };
            report.value(place, &path, message, allowed);
            None
        }
    }
}

/// The coefficient whose size is farthest from that of the others: where numbers overflow, it is the one.
fn farthest_coefficient(section: &Section) -> Option<(Span, String)> {
    let named = |key: Key<[f64]>| {
        let numbers = section.get(key).unwrap_or_default().iter().enumerate();
        numbers.map(move |(index, (number, place))| (*number, *place, key, index))
    };
    let mut all: Vec<_> = named(keys::NUMERATOR).chain(named(keys::DENOMINATOR)).collect();
    all.retain(|(number, ..)| *number != 0.0);
    let size = |number: f64| libm::log10(number.abs());
    all.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let usual = size(all.get(all.len() / 2)?.0);
    let distance = |number: f64| (size(number) - usual).abs();
    let farthest = all.iter().max_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))?;
    let (_, place, key, index) = *farthest;
    Some((place, format!("{}[{index}]", section.path(key))))
}

/// What is wrong with coefficients, and what is allowed.
fn in_words(error: &SimError) -> (String, String) {
    const SHORTER: &str = "a list shorter than the denominator";
    let (message, allowed) = match error {
        SimError::Linear(LtiError::ZeroPolynomial { .. }) => {
            ("zero everywhere".to_owned(), "at least one coefficient other than 0")
        }
        SimError::Linear(LtiError::LeadingZero { zeros, .. }) => (
            format!("begins with {zeros} zero{}", if *zeros == 1 { "" } else { "s" }),
            "a first coefficient other than 0, that of the highest power",
        ),
        SimError::Linear(LtiError::Improper { numerator_degree, denominator_degree }) => (
            format!("degree {numerator_degree} over degree {denominator_degree} is improper"),
            SHORTER,
        ),
        SimError::NotStrictlyProper => (
            "as long as the denominator, so that the pitch angle would jump with the elevator"
                .to_owned(),
            SHORTER,
        ),
        SimError::Linear(LtiError::NotFinite { .. }) => (
            "with it, a number of the plant's model is too large for the machine".to_owned(),
            "coefficients closer to each other in size",
        ),
        other => (other.to_string(), "coefficients closer to each other in size"),
    };
    (message, allowed.to_owned())
}

/// The rules of a supervisor's `table`.
pub(super) fn rules(
    report: &mut Report,
    files: &mut Files<'_>,
    supervisor: &Section,
) -> Option<RuleTable> {
    let name = match supervisor.get(TABLE)? {
        Rules::Grids(grids) => return rule_table(grids),
        Rules::Named(name) => name,
    };
    if let Some(text) = rule_table_text(name) {
        let path = supervisor.path(TABLE);
        return rule_table(&carried(report, files, &RULE_FILE, (name, text, &path))?);
    }
    let at = (supervisor.at(TABLE), supervisor.path(TABLE));
    rule_table(&referred(report, files, &RULE_FILE, (name, at))?)
}

/// The rules of a name or file outside of any scenario.
pub(crate) fn rules_named(
    report: &mut Report,
    files: &mut Files<'_>,
    name: &str,
) -> Option<RuleTable> {
    if let Some(text) = rule_table_text(name) {
        return rule_table(&carried(report, files, &RULE_FILE, (name, text, ""))?);
    }
    let source = report.add_source(None, name);
    let end = name.len();
    let place = Span { source, start: 0, end };
    rule_table(&referred(report, files, &RULE_FILE, (name, (place, String::new())))?)
}

fn rule_table(section: &Section) -> Option<RuleTable> {
    Some(RuleTable::new([section.get(DELTA_KP)?, section.get(DELTA_KI)?, section.get(DELTA_KD)?]))
}

/// A file that the program carries, named by the key at a path.
pub(super) fn carried(
    report: &mut Report,
    files: &mut Files<'_>,
    spec: &'static Table,
    (name, text, path): (&str, &str, &str),
) -> Option<Section> {
    files.digest(text);
    let mut item = document::read(report, Some(format!("{name} (built in)")), text)?;
    files.apply_changes(report, path, &mut item);
    check::table(report, spec, &item, "").filter(|section| section.sound)
}

/// A file that the scenario refers to at a place.
pub(super) fn referred(
    report: &mut Report,
    files: &mut Files<'_>,
    spec: &'static Table,
    (name, (place, path)): (&str, (Span, String)),
) -> Option<Section> {
    let text = match files.read(name) {
        Ok(text) => text,
        Err(reason) => {
            let allowed = "a readable .toml file, its path relative to the scenario's folder";
            report.value(place, &path, format!("cannot be read: {reason}"), allowed);
            return None;
        }
    };
    files.digest(&text);
    let mut item = document::read(report, Some(name.to_owned()), &text)?;
    files.apply_changes(report, &path, &mut item);
    check::table(report, spec, &item, "").filter(|section| section.sound)
}
