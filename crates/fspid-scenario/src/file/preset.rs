//! Plants and rule tables that the program carries, and files of the same form.

use std::path::Path;

use fspid_fuzzy::RuleTable;
use fspid_sim::{ElevatorSign, LinearPlant};

use crate::carried::{plant_text, rule_table_text};
use crate::file::build::{data, elevator_sign};
use crate::file::files::Files;
use crate::file::spec::PLANT_FILE;
use crate::file::spec::data as keys;
use crate::file::{check, document};
use crate::keyed::Section;
use fspid_diagnostics::{Problems, Report};

/// A linear aircraft with what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantFile {
    /// Name in scenarios.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Coefficients of pitch angle over elevator, highest power of s first.
    pub numerator: Vec<f64>,
    /// As numerator.
    pub denominator: Vec<f64>,
    /// What a positive elevator does in these coefficients.
    pub elevator_sign: ElevatorSign,
    /// Flight condition.
    pub condition: Condition,
    /// Where the numbers come from.
    pub source: String,
    /// What else should be known.
    pub notes: String,
    /// The same as a plant of the loop.
    pub plant: LinearPlant,
}

/// Flight condition, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Condition {
    /// The aircraft.
    pub aircraft: Option<String>,
    /// True airspeed, m/s.
    pub speed_m_s: Option<f64>,
    /// Altitude, m.
    pub altitude_m: Option<f64>,
    /// Mach number.
    pub mach: Option<f64>,
    /// Mass, kg.
    pub mass_kg: Option<f64>,
}

/// The plant of that name, `None` if the program carries none.
#[must_use]
pub fn preset(name: &str) -> Option<PlantFile> {
    let text = plant_text(name)?;
    // The tests read every plant that is carried.
    parse_plant(text, name).ok()
}

/// Reads a plant file.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse_plant(text: &str, name: &str) -> Result<PlantFile, Problems> {
    let mut report = Report::default();
    let file = document::read(&mut report, None, text)
        .and_then(|item| check::table(&mut report, &PLANT_FILE, &item, ""))
        .and_then(|section| plant_file(&mut report, &section));
    report.finish(name)?;
    file.ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

fn plant_file(report: &mut Report, section: &Section) -> Option<PlantFile> {
    if !section.sound {
        return None;
    }
    let text = |key| section.get::<str>(key).unwrap_or_default().to_owned();
    let condition = section.get(keys::CONDITION).map(|section| Condition {
        aircraft: section.get(keys::AIRCRAFT).map(str::to_owned),
        speed_m_s: section.get(keys::SPEED_M_S),
        altitude_m: section.get(keys::ALTITUDE_M),
        mach: section.get(keys::MACH),
        mass_kg: section.get(keys::MASS_KG),
    });
    Some(PlantFile {
        name: text(keys::NAME),
        title: text(keys::TITLE),
        numerator: section.numbers(keys::NUMERATOR)?,
        denominator: section.numbers(keys::DENOMINATOR)?,
        elevator_sign: elevator_sign(section)?,
        condition: condition.unwrap_or_default(),
        source: text(keys::PLANT_SOURCE),
        notes: text(keys::NOTES),
        plant: data::coefficients(report, section, elevator_sign(section)?)?,
    })
}

/// The rule table of that name, `None` if the program carries none.
#[must_use]
pub fn rule_table(name: &str) -> Option<RuleTable> {
    rule_table_text(name)?;
    load_rule_table(name, None).ok()
}

/// The rule table of a name or of a `.toml` file, relative to `folder`.
///
/// # Errors
/// Everything that is wrong with it.
pub fn load_rule_table(name: &str, folder: Option<&Path>) -> Result<RuleTable, Problems> {
    let mut report = Report::default();
    let mut files = Files::new(folder.or_else(|| Some(Path::new(""))));
    let table = data::rules_named(&mut report, &mut files, name);
    report.finish(name)?;
    table.ok_or_else(|| Problems::new(name, Vec::new(), 0))
}
