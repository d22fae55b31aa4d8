//! Flight models in DAVE-ML: read, checked against their own check cases, written as TOML.

use std::fmt;
use std::path::Path;

use fspid_daveml::{CheckReport, Deviation, Problem, Problems, Reading, ShotReport};
use serde_json::{Value, json};

use super::load::text;
use super::table::table;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::file::read_model;

/// A model that was read, and what came out of its check cases.
#[derive(Clone, Debug)]
pub struct Imported {
    file: String,
    reading: Reading,
    report: CheckReport,
}

/// Why there is no model.
#[derive(Clone, Debug, PartialEq)]
pub enum ImportFailure {
    /// The file could not be read.
    Unreadable(AircraftFailure),
    /// It is wrong; every problem with its line and column.
    Problems {
        /// Name of the file.
        file: String,
        /// What is wrong.
        problems: Problems,
    },
    /// It is not what its own check cases say.
    Checks {
        /// Name of the file.
        file: String,
        /// What came out.
        report: CheckReport,
    },
}

impl fmt::Display for ImportFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(failure) => failure.fmt(f),
            Self::Problems { file, problems } => {
                problems.list.iter().try_for_each(|problem| located(f, file, problem))?;
                write!(f, "{} problem(s) in {file}", problems.list.len())
            }
            Self::Checks { file, report } => {
                let failed = report.shots.iter().filter(|shot| !shot.passed());
                for shot in failed.clone() {
                    failed_shot(f, shot)?;
                }
                write!(
                    f,
                    "{file}: {} of its check cases failed; nothing was written",
                    failed.count()
                )
            }
        }
    }
}

impl std::error::Error for ImportFailure {}

fn located(f: &mut fmt::Formatter<'_>, file: &str, problem: &Problem) -> fmt::Result {
    match problem.place {
        Some(_) => writeln!(f, "{file}:{problem}"),
        None => writeln!(f, "{file}: {problem}"),
    }
}

fn failed_shot(f: &mut fmt::Formatter<'_>, shot: &ShotReport) -> fmt::Result {
    let failed = shot.deviations.iter().filter(|deviation| !deviation.passed());
    let name = &shot.name;
    failed.into_iter().try_for_each(|deviation| writeln!(f, "check case `{name}`: {deviation}"))
}

/// Reads a flight model, a DAVE-ML file or one that was written from it, and runs its check cases.
///
/// # Errors
/// [`ImportFailure`]: every problem with its line and column, or the check cases that fail.
pub fn import(path: &Path) -> Result<Imported, ImportFailure> {
    let file = path.display().to_string();
    let text = text(path).map_err(ImportFailure::Unreadable)?;
    let reading = read_model(path, &text)
        .map_err(|problems| ImportFailure::Problems { file: file.clone(), problems })?;
    let report = reading.model.check();
    match report.passed() {
        true => Ok(Imported { file, reading, report }),
        false => Err(ImportFailure::Checks { file, report }),
    }
}

impl Imported {
    /// What was assumed and left out, each with its line and column.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.reading.notes.iter().map(|note| match note.place {
            Some(_) => format!("{}:{note}", self.file),
            None => format!("{}: {note}", self.file),
        })
    }

    /// The model as TOML, which reads back as the same model.
    #[must_use]
    pub fn toml(&self) -> String {
        fspid_daveml::data::write(&self.reading.document)
    }

    /// The model and its check cases for people.
    #[must_use]
    pub fn text(&self) -> String {
        let model = &self.reading.model;
        let ports = |ports: Vec<&fspid_daveml::Port>| {
            let row = |port: &&fspid_daveml::Port| {
                vec![port.id.clone(), port.units.clone(), port.name.clone()]
            };
            table(&["variable", "unit", "name"], &ports.iter().map(row).collect::<Vec<_>>())
        };
        format!(
            "{}\n\ninputs\n{}\noutputs\n{}\ncheck cases: {}\n{}",
            self.reading.document.header.name,
            ports(model.inputs().collect()),
            ports(model.outputs().collect()),
            self.verdict(),
            self.checks(),
        )
    }

    fn verdict(&self) -> String {
        match self.report.shots.len() {
            0 => "the file has none, so nothing is proved".to_owned(),
            count => format!("all {count} passed"),
        }
    }

    fn checks(&self) -> String {
        let row = |shot: &ShotReport| {
            let worst = shot.worst();
            let ratio = worst.map_or(0.0, Deviation::ratio);
            let variable = worst.map_or(String::new(), |worst| worst.variable.clone());
            let count = shot.deviations.len().to_string();
            vec![shot.name.clone(), count, significant(ratio, 3), variable]
        };
        match self.report.shots.is_empty() {
            true => String::new(),
            false => table(
                &["check case", "values", "worst, of its tolerance", "variable"],
                &self.report.shots.iter().map(row).collect::<Vec<_>>(),
            ),
        }
    }

    /// The model and its check cases for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let model = &self.reading.model;
        let port = |port: &fspid_daveml::Port| json!({ "id": port.id, "name": port.name, "units": port.units });
        let shot = |shot: &ShotReport| {
            json!({
                "name": shot.name, "passed": shot.passed(), "values": shot.deviations.len(),
                "worst_of_tolerance": shot.worst().map(Deviation::ratio),
            })
        };
        json!({
            "name": self.reading.document.header.name,
            "inputs": model.inputs().map(port).collect::<Vec<_>>(),
            "outputs": model.outputs().map(port).collect::<Vec<_>>(),
            "check_cases": self.report.shots.iter().map(shot).collect::<Vec<_>>(),
            "notes": self.notes().collect::<Vec<_>>(),
        })
    }
}
