//! The merged file that a summary is made of: what it says of itself, and its columns.

use std::path::{Path, PathBuf};

use fspid_scenario::measure::Measure;
use serde_json::Value;

use super::data::{Head, Limits, Parameter};
use super::{NotMerged, SummaryError, SummarySettings};
use crate::merge::PLAN_KEY;
use crate::rows::{CONTROLLER, DIVERGED_AT, FAILED, PARAMETER, REASONS, REQUIREMENT, RUN, VERDICT};
use crate::sample::Sampling;
use crate::shard::{CAMPAIGN_KEY, PROGRAM_KEY};
use crate::table::{Column, ColumnTable, Kind, Reader, Values};

/// Ends of the names of a requirement's columns.
const VALUE: &str = ".value";
const MET: &str = ".met";

/// A merged file that has been looked at.
pub(super) struct Source {
    pub(super) reader: Reader,
    pub(super) head: Head,
    /// Runs, as many as fit into memory addresses.
    pub(super) runs: usize,
}

/// A requirement as its columns describe it.
pub(super) struct Asked {
    pub(super) id: String,
    pub(super) measure: String,
    pub(super) unit: String,
    pub(super) required: String,
    pub(super) limits: Limits,
}

impl Asked {
    /// Name of the column of what was found.
    pub(super) fn value(&self) -> String {
        format!("{REQUIREMENT}{}{VALUE}", self.id)
    }

    /// How far a value is outside of the limits, as requirements are judged.
    pub(super) fn outside(&self, value: f64) -> Option<f64> {
        let measure = Measure::from_name(&self.measure);
        self.limits.outside(measure.map_or(value, |measure| measure.compared(value)))
    }

    /// Name of the column of whether that is enough.
    pub(super) fn met(&self) -> String {
        format!("{REQUIREMENT}{}{MET}", self.id)
    }
}

impl Source {
    /// Opens a file and checks that it is a merged one, down to its last byte.
    pub(super) fn open(path: &Path, settings: SummarySettings) -> Result<Self, SummaryError> {
        let reader = Reader::open(path)?;
        check_columns(&reader).map_err(|reason| refusal(&reader, reason))?;
        let mut head =
            head(&reader, settings.confidence).map_err(|reason| refusal(&reader, reason))?;
        reader.verify()?;
        head.controllers = controllers(&reader)?;
        let (found, controllers) = (reader.rows() as u64, head.controllers.len() as u64);
        let runs = head.runs;
        if runs == 0 || runs.checked_mul(controllers) != Some(found) {
            return Err(refusal(&reader, NotMerged::Rows { found, runs, controllers }));
        }
        let runs = reader.rows() / head.controllers.len().max(1);
        Ok(Self { reader, head, runs })
    }

    /// How many controllers.
    pub(super) fn controllers(&self) -> usize {
        self.head.controllers.len()
    }

    /// Says that the file is not as a merged one is.
    pub(super) fn refusal(&self, reason: NotMerged) -> SummaryError {
        refusal(&self.reader, reason)
    }

    /// Columns of numbers that are no parameters.
    pub(super) fn measures(&self) -> impl Iterator<Item = &Column> {
        let columns = self.reader.schema().columns().iter();
        columns.filter(|it| it.kind == Kind::Float && !it.name.starts_with(PARAMETER))
    }

    /// Requirements, in the order of the columns.
    pub(super) fn requirements(&self) -> Vec<Asked> {
        self.reader.schema().columns().iter().filter_map(asked).collect()
    }
}

fn refusal(reader: &Reader, reason: NotMerged) -> SummaryError {
    SummaryError::NotMerged { path: PathBuf::from(reader.path()), reason }
}

/// Checks that every column that is needed is there and of its kind.
fn check_columns(reader: &Reader) -> Result<(), NotMerged> {
    let schema = reader.schema();
    let need = |name: &str, kind: Kind| {
        let found = schema.columns().iter().any(|it| it.name == name && it.kind == kind);
        if found { Ok(()) } else { Err(NotMerged::NoColumn { name: name.to_owned(), kind }) }
    };
    need(RUN, Kind::Integer)?;
    need(CONTROLLER, Kind::Text)?;
    need(FAILED, Kind::Boolean)?;
    need(VERDICT, Kind::Text)?;
    need(REASONS, Kind::Text)?;
    need(DIVERGED_AT, Kind::Float)?;
    for asked in schema.columns().iter().filter_map(asked) {
        need(&asked.met(), Kind::Boolean)?;
    }
    Ok(())
}

/// What the metadata say; the controllers are not among that.
fn head(reader: &Reader, confidence: f64) -> Result<Head, NotMerged> {
    let value = |key| reader.metadata_value(key).ok_or(NotMerged::NoKey { key });
    let (campaign, program) = (value(CAMPAIGN_KEY)?.to_owned(), value(PROGRAM_KEY)?.to_owned());
    let plan = reader.metadata_value(PLAN_KEY).ok_or(NotMerged::Part)?;
    let plan: Value = serde_json::from_str(plan).map_err(|_| NotMerged::Plan { place: "/" })?;
    let text = |place: &'static str| {
        let found = plan.pointer(place).and_then(Value::as_str);
        found.ok_or(NotMerged::Plan { place })
    };
    let changes = || -> Option<Vec<String>> {
        plan.pointer("/changes")?.as_array()?.iter().map(word).collect()
    };
    let changes = changes().ok_or(NotMerged::Plan { place: "/changes" })?;
    let runs = plan.pointer("/runs").and_then(Value::as_u64);
    let scenario_text = text("/scenario")?.to_owned();
    Ok(Head {
        campaign,
        program,
        scenario: scenario_name(&scenario_text, &changes),
        scenario_digest: text("/scenario_digest")?.to_owned(),
        runs: runs.ok_or(NotMerged::Plan { place: "/runs" })?,
        rows: reader.rows() as u64,
        seed: text("/seed")?.parse().map_err(|_| NotMerged::Plan { place: "/seed" })?,
        sampling: Sampling::from_name(text("/sampling")?)
            .ok_or(NotMerged::Plan { place: "/sampling" })?,
        digest: reader.digest(),
        controllers: Vec::new(),
        parameters: reader.schema().columns().iter().filter_map(parameter).collect(),
        confidence,
        scenario_text,
        changes,
    })
}

fn word(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

/// The name in a scenario, unless a change gives it another.
fn scenario_name(text: &str, changes: &[String]) -> Option<String> {
    let changed = changes.iter().rev().find_map(|change| change.strip_prefix("name="));
    if let Some(name) = changed {
        return Some(name.trim_matches('"').to_owned());
    }
    let table: toml::Table = toml::from_str(text).ok()?;
    table.get("name")?.as_str().map(str::to_owned)
}

fn parameter(column: &Column) -> Option<Parameter> {
    let Column { name, kind, unit, meaning } = column;
    let name = name.strip_prefix(PARAMETER)?.to_owned();
    Some(Parameter { name, kind: *kind, unit: unit.clone(), meaning: meaning.clone() })
}

/// The controllers of the first run, in their order.
fn controllers(reader: &Reader) -> Result<Vec<String>, SummaryError> {
    let mut controllers = Vec::new();
    for table in reader.columns(&[RUN, CONTROLLER])? {
        let table: ColumnTable = table?;
        let (Values::Integer(runs), Values::Text(names)) =
            (table.column(RUN)?, table.column(CONTROLLER)?)
        else {
            break;
        };
        for (run, name) in runs.iter().zip(names) {
            match name {
                Some(name) if *run == Some(0) => controllers.push(name.clone()),
                _ => return Ok(controllers),
            }
        }
    }
    Ok(controllers)
}

/// A requirement, from the column of its value.
fn asked(column: &Column) -> Option<Asked> {
    let id = column.name.strip_prefix(REQUIREMENT)?.strip_suffix(VALUE)?;
    let meaning = column.meaning.split_once(", the worst case; required: ");
    let (measure, required) = meaning.unwrap_or((&column.meaning, ""));
    Some(Asked {
        id: id.to_owned(),
        measure: measure.to_owned(),
        unit: column.unit.clone(),
        required: required.to_owned(),
        limits: limits(required),
    })
}

/// Limits in words as numbers: "at most 35 %", "at least 30 deg", "0 to 3 s".
fn limits(words: &str) -> Limits {
    let number = |text: &str| text.split_whitespace().next()?.parse().ok();
    if let Some(rest) = words.strip_prefix("at least ") {
        return Limits { least: number(rest), most: None };
    }
    if let Some(rest) = words.strip_prefix("at most ") {
        return Limits { least: None, most: number(rest) };
    }
    match words.split_once(" to ") {
        Some((least, most)) => Limits { least: number(least), most: number(most) },
        None => Limits::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_in_words_are_read_as_numbers() {
        let read = |words| (limits(words).least, limits(words).most);
        assert_eq!(read("at most 35 %"), (None, Some(35.0)));
        assert_eq!(read("at least -0.5 deg"), (Some(-0.5), None));
        assert_eq!(read("0 to 3 s"), (Some(0.0), Some(3.0)));
        assert_eq!(read("0.1 to 2"), (Some(0.1), Some(2.0)));
        assert_eq!(read("stable"), (None, None));
        assert_eq!(read(""), (None, None));
    }

    /// An error that is left below the set-point is negative, and was the best of all.
    #[test]
    fn an_error_that_is_left_is_as_bad_below_as_above() {
        let asked = |measure: &str| Asked {
            id: String::new(),
            measure: measure.to_owned(),
            unit: "%".to_owned(),
            required: String::new(),
            limits: Limits { least: None, most: Some(2.0) },
        };
        assert_eq!(asked("final_error_pct").outside(-50.0), Some(48.0));
        assert_eq!(asked("overshoot_pct").outside(-50.0), Some(-52.0));
    }

    #[test]
    fn a_change_of_the_name_is_the_name() {
        let name = |text, changes: &[&str]| {
            scenario_name(text, &changes.iter().map(|&it| it.to_owned()).collect::<Vec<_>>())
        };
        let text = "schema = 1\nname = \"one\"\n[plant]\nname = \"no\"\n";
        assert_eq!(name(text, &[]).as_deref(), Some("one"));
        assert_eq!(name(text, &["name=\"two\"", "loop.duration_s=1"]).as_deref(), Some("two"));
        assert_eq!(name("schema = 1\n", &[]), None);
        assert_eq!(name("no toml", &[]), None);
    }
}
