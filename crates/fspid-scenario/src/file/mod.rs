//! Scenario files: reading, checking, schema and starter.
//!
//! One specification (`spec`) lists every key with its kind, unit, range, default and meaning. From
//! it come the check, which collects all problems of a file with their places, the JSON
//! [`schema`], the defaults, and the list of all [`Setting`]s. Degrees become radians here and nowhere else.
//!
//! ```
//! let study = fspid_scenario::file::parse(fspid_scenario::file::starter(), "starter.toml", None, &[])?;
//! assert_eq!(study.scenario.controllers.len(), 2);
//!
//! let problems = fspid_scenario::file::parse("schema = 1\nnmae = \"x\"", "mine.toml", None, &[]).unwrap_err();
//! assert!(problems.to_string().contains("mine.toml:2:1: nmae: unknown key; did you mean `name`?"));
//! # Ok::<(), fspid_scenario::file::Problems>(())
//! ```
//!
//! Not here: writing files, and what a scenario's flight amounts to.

mod aircraft;
mod build;
mod changed_text;
mod dispersion;
mod extra;
pub(crate) mod files;
mod free_places;
mod kind;
mod overrides;
mod paths;
mod preset;
mod requirement;
mod rewrite;
mod schema;
mod setting;
pub(crate) mod spec;
pub(crate) mod tables;
mod template;
mod templates;
mod tunable;
mod tuning;

use std::fmt;
use std::path::Path;

use fspid_sim::Scenario;

use crate::dispersion::Dispersion;
use crate::file::build::Built;
use crate::file::files::Files;
use crate::keyed::{check, document};
use crate::setting_path::renamed;
use crate::system_text::other_kind;
use crate::tuning::{Contest, TunableParameter, Tuning};
use fspid_diagnostics::{Place, Report, Span};

pub use crate::carried::{aircraft_names, plant_names, rule_table_names};
pub use crate::regular_file::{
    STANDARD_INPUT, open_regular, read_own, read_regular, unread_in_words,
};
pub use crate::requirement::Requirement;
pub use crate::setting_path::{NewValue, SettingPath};
pub use aircraft::parse_aircraft_at;
pub use aircraft::{aircraft, parse_aircraft};
pub use build::{Airframe, DerivedGains, FlownDerivatives, GainSource, RangeRule, Schedule};
pub use changed_text::{changed_text, with_listed};
pub use extra::Extra;
pub use free_places::TunedIn;
pub use fspid_diagnostics::{Problem, Problems, known_words};
pub use kind::is_aircraft_file;
pub use paths::{PathRow, paths, paths_json, paths_of, paths_text, row_at};
pub use preset::{Condition, PlantFile, load_rule_table, parse_plant, preset, rule_table};
pub use rewrite::{Replay, replay};
pub use schema::{aircraft_schema, schema};
pub use setting::Setting;
pub use spec::scenario_keys;
pub use tables::read_model;
pub use template::Template;
pub use templates::{STARTERS, Starter, starter_named};

/// A scenario with what its file asks of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// What flies.
    pub scenario: Scenario,
    /// What the responses of the scenario as it is written must meet.
    pub requirements: Vec<Requirement>,
    /// Every requirement, also those that are asked in some cases of a tuning or a contest only.
    pub case_requirements: Vec<Requirement>,
    /// What is known of the flight of each plant: the one at the start and one for each change.
    pub airframes: Vec<Airframe>,
    /// What differs from run to run of a campaign.
    pub dispersions: Vec<Dispersion>,
    /// Gains that no setting states, because a schedule or a design makes them.
    pub derived_gains: Vec<DerivedGains>,
    /// Places that tuning may change, in the order of the file.
    pub tunable_parameters: Vec<TunableParameter>,
    /// How their values are chosen.
    pub tuning: Option<Tuning>,
    /// Where tuned controllers are compared.
    pub contest: Option<Contest>,
    /// What is made of flights that leave the range in which the aircraft's data are trusted.
    pub range_rule: RangeRule,
    /// What the aircraft at the start is made of, where it is one of derivatives to which nothing is added.
    pub derivatives: Option<FlownDerivatives>,
    /// Everything that is set, in the order of the specification.
    pub settings: Vec<Setting>,
    /// What was set from outside of its text, such as `controller.FSPID.nominal.kp=2.5`, in this order.
    pub overrides: Vec<String>,
    /// Files that it refers to, as it names them.
    pub files: Vec<String>,
    /// SHA-256 of the text, the overrides and everything they refer to, in hexadecimal digits.
    pub digest: String,
    /// What is allowed and probably not meant.
    pub warnings: Vec<String>,
}

impl Study {
    /// The study as a case of this name and group is judged.
    #[must_use]
    pub fn in_case(self, name: &str, group: &str) -> Self {
        let asked = self.case_requirements.iter().filter(|it| it.cases.case(name, group));
        Self { requirements: asked.cloned().collect(), ..self }
    }

    /// A scenario that was built in Rust: nothing is required, dispersed, marked or tuned, and an aircraft that leaves the
    /// range of its data fails.
    #[must_use]
    pub fn of(scenario: Scenario) -> Self {
        let range_rule = match scenario.plant.aircraft() {
            Some(_) => RangeRule::Fails,
            None => RangeRule::NoRange,
        };
        Self::without_text(Built {
            airframes: Airframe::unknown(&scenario),
            scenario,
            requirements: Vec::new(),
            dispersions: Vec::new(),
            derived_gains: Vec::new(),
            tuning: None,
            contest: None,
            range_rule,
            derivatives: None,
        })
    }

    /// What was built from other values than those of a text, without settings and digest.
    fn without_text(built: Built) -> Self {
        let Built {
            scenario,
            requirements: case_requirements,
            airframes,
            dispersions,
            derived_gains,
            tuning,
            contest,
            range_rule,
            derivatives,
        } = built;
        let as_written = |it: &&Requirement| it.cases.as_written();
        Self {
            scenario,
            requirements: case_requirements.iter().filter(as_written).cloned().collect(),
            case_requirements,
            airframes,
            dispersions,
            derived_gains,
            tunable_parameters: Vec::new(),
            tuning,
            contest,
            range_rule,
            derivatives,
            settings: Vec::new(),
            overrides: Vec::new(),
            files: Vec::new(),
            digest: String::new(),
            warnings: Vec::new(),
        }
    }
}

/// Why a file gave no study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadError {
    /// It could not be read.
    Unreadable {
        /// Its path.
        path: String,
        /// The reason.
        reason: String,
    },
    /// It is wrong.
    Problems(Problems),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { path, reason } => write!(f, "{path}: cannot be read: {reason}"),
            Self::Problems(problems) => problems.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

/// Reads a scenario file. `overrides` are changes such as `controller.FSPID.nominal.kp=2.5`, applied
/// before the check; files it refers to are relative to its folder.
///
/// # Errors
/// A file that cannot be read, or everything that is wrong with it.
pub fn load(path: &Path, overrides: &[String]) -> Result<Study, LoadError> {
    let text = read_text(path)?;
    let name = path.display().to_string();
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&text, &name, Some(folder), overrides).map_err(LoadError::Problems)
}

/// The text of a file, if it is one.
///
/// # Errors
/// A file that cannot be read, is too large, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, LoadError> {
    let name = path.display().to_string();
    let bytes = read_regular(path)
        .map_err(|reason| LoadError::Unreadable { path: name.clone(), reason })?;
    String::from_utf8(bytes).map_err(|error| {
        let problems = not_utf8(&name, error.as_bytes(), error.utf8_error().valid_up_to());
        LoadError::Problems(problems)
    })
}

fn not_utf8(name: &str, bytes: &[u8], position: usize) -> Problems {
    let before = bytes.get(..position).unwrap_or_default();
    let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
    let in_line = String::from_utf8_lossy(before.get(line_start..).unwrap_or_default());
    let found = bytes.get(position).map(|byte| format!("byte 0x{byte:02X}"));
    let place = Place {
        line: before.iter().filter(|&&byte| byte == b'\n').count() + 1,
        column: in_line.chars().count() + 1,
    };
    let problem = Problem::at(place, &found.unwrap_or_default(), "not UTF-8", "text in UTF-8");
    Problems::new(name, vec![problem], 0)
}

/// Reads a scenario from a text called `name` in messages. Without a `folder` it cannot refer to
/// files.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse(
    text: &str,
    name: &str,
    folder: Option<&Path>,
    overrides: &[String],
) -> Result<Study, Problems> {
    parse_with(text, name, folder, &Extra { overrides, ..Extra::default() })
}

/// As [`parse`], with requirements from outside of the file as well.
///
/// # Errors
/// Everything that is wrong with the file and with what comes from outside.
pub fn parse_with(
    text: &str,
    name: &str,
    folder: Option<&Path>,
    extra: &Extra<'_>,
) -> Result<Study, Problems> {
    parse_keeping(text, name, Files::new(folder), extra)
}

fn parse_keeping(
    text: &str,
    name: &str,
    mut files: Files<'_>,
    extra: &Extra<'_>,
) -> Result<Study, Problems> {
    let mut report = Report::default();
    files.digest(text);
    let study = read(&mut report, &mut files, text, extra);
    let warnings = report.finish(name)?;
    // Without a problem there is a study; the other case would be a mistake in this module.
    let (built, settings, tunable_parameters) =
        study.ok_or_else(|| Problems::new(name, Vec::new(), 0))?;
    let named = files.names().to_vec();
    let digest = files.finish();
    Ok(Study {
        settings,
        overrides: extra.overrides.to_vec(),
        files: named,
        digest,
        warnings,
        tunable_parameters,
        ..Study::without_text(built)
    })
}

fn read(
    report: &mut Report,
    files: &mut Files<'_>,
    text: &str,
    extra: &Extra<'_>,
) -> Option<(Built, Vec<Setting>, Vec<TunableParameter>)> {
    let (document, marks) = changed_document(report, files, text, extra)?;
    let section = check::table(report, &spec::SCENARIO, &document, "")?;
    requirement::check_cases(report, &section);
    let built = build::scenario(report, files, &section);
    files.report_unused_changes(report);
    let built = built?;
    if report.count() == 0 {
        build::loops::check(report, &section, &built.scenario);
        template::read_chosen(report, files, &document, &built.dispersions);
    }
    Some((built, setting::settings(files, &section), marks))
}

/// Tells of a file of another kind what it is, and nothing of keys that it cannot have.
fn not_a_scenario<T>(report: &mut Report, what: &str, allowed: &str) -> Option<T> {
    let source = report.add_source(None, "");
    let place = Span { source, start: 0, end: 0 };
    report.missing(place, "", format!("this is {what}, and not a scenario"), allowed);
    None
}

/// The document with what comes from outside, and the marks that were in it.
fn changed_document(
    report: &mut Report,
    files: &mut Files<'_>,
    text: &str,
    extra: &Extra<'_>,
) -> Option<(document::Item, Vec<TunableParameter>)> {
    if text.len() as u64 > document::FILE_LIMIT {
        let source = report.add_source(None, "");
        let place = Span { source, start: 0, end: 0 };
        report.missing(place, "", "the file is too large", "up to 10 MiB");
        return None;
    }
    if let Some(what) = other_kind(text) {
        let allowed = match what {
            "HTML" | "XML" => "a scenario, which is TOML",
            _ => "a scenario; `check` and `infer` read fuzzy systems and rule tables",
        };
        return not_a_scenario(report, what, allowed);
    }
    let mut document = document::read(report, None, text)?;
    if let Some((what, allowed)) = kind::other(&document) {
        return not_a_scenario(report, what, allowed);
    }
    renamed::in_item(report, &mut document, &mut Vec::new());
    overrides::apply_listed(report, files, &mut document);
    for text in extra.overrides {
        files.digest(text);
        overrides::apply(report, files, &mut document, text);
    }
    extra::apply(report, files, &mut document, extra);
    let marks = tunable::take(report, &mut document);
    Some((document, marks))
}

/// A commented scenario to begin with.
#[must_use]
pub fn starter() -> &'static str {
    include_str!("starter.toml")
}
