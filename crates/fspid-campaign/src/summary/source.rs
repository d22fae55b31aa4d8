//! What a summary is made of: the merged file or the parts, what they say of themselves, and their columns.

use std::path::Path;

use fspid_scenario::measure::Measure;
use serde_json::Value;

use super::data::{Head, Limits, Parameter, Shards, Summary};
use super::files::Files;
use super::{NotMerged, SENSITIVITY_RUNS, SummaryError, SummarySettings};
use crate::folder::Folder;
use crate::merge::{PLAN_KEY, plan_text};
use crate::parts::{Parts, Seen};
use crate::range::Range;
use crate::rows::{CONTROLLER, DIVERGED_AT, FAILED, PARAMETER, REASONS, REQUIREMENT, RUN, VERDICT};
use crate::sample::Sampling;
use crate::shard::{CAMPAIGN_KEY, PROGRAM_KEY};
use crate::table::{Column, ColumnTable, Kind, Reader, Schema, Values};

/// Ends of the names of a requirement's columns.
const VALUE: &str = ".value";
const MET: &str = ".met";

/// Rows that have been looked at: those of a merged file, or of parts.
pub(super) struct Source {
    pub(super) files: Files,
    pub(super) head: Head,
    /// Runs, as many as fit into memory addresses.
    pub(super) runs: usize,
    /// How many of them are among the first of the campaign, which sensitivities are of.
    pub(super) first_runs: usize,
    /// Parts, where they are read one by one.
    parts: Vec<Seen>,
    exact: bool,
    small: bool,
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
    /// Opens a merged file, or the parts in a folder, and checks them; down to the last byte, unless the parts are
    /// read one by one, when each is checked as it is read.
    pub(super) fn open(path: &Path, settings: SummarySettings) -> Result<Self, SummaryError> {
        let Found { files, mut head, mut parts } = Found::at(path, settings)?;
        let exact = head.rows <= settings.exact_rows;
        if exact || head.shards.is_none() {
            head.digest = Some(files.verify()?);
        }
        // A part is opened once for all its columns rather than once for each, where all of them fit.
        let cells = head.rows.saturating_mul(files.schema().columns().len() as u64);
        let small = !parts.is_empty() && cells <= settings.exact_rows;
        if exact && !small {
            parts.clear();
        }
        head.controllers = controllers(files.first())?;
        let (found, controllers, runs) = (head.rows, head.controllers.len() as u64, head.runs);
        if runs == 0 || runs.checked_mul(controllers) != Some(found) {
            return Err(refusal(files.path(), NotMerged::Rows { found, runs, controllers }));
        }
        let runs = files.rows() / head.controllers.len().max(1);
        Ok(Self { files, head, runs, first_runs: runs.min(SENSITIVITY_RUNS), parts, exact, small })
    }

    /// Parts to be read one by one; none where all rows are read together.
    pub(super) fn pieces(&self) -> Vec<Piece<'_>> {
        let piece = |(number, part)| {
            let earlier = self.files.begin(number) / self.controllers().max(1);
            Piece { part, head: &self.head, first_runs: SENSITIVITY_RUNS.saturating_sub(earlier) }
        };
        self.parts.iter().enumerate().map(piece).collect()
    }

    /// True where the values themselves are kept, false where they are too many.
    pub(super) fn is_exact(&self) -> bool {
        self.exact
    }

    /// True where the values of all columns of all parts fit.
    pub(super) fn is_small(&self) -> bool {
        self.small
    }

    /// The run of a row.
    pub(super) fn run(&self, row: usize) -> u64 {
        self.files.run(row, self.controllers())
    }

    /// How many controllers.
    pub(super) fn controllers(&self) -> usize {
        self.head.controllers.len()
    }

    /// Says that the file is not as a merged one is.
    pub(super) fn refusal(&self, reason: NotMerged) -> SummaryError {
        refusal(self.files.path(), reason)
    }

    /// Columns of numbers that are no parameters.
    pub(super) fn measures(&self) -> impl Iterator<Item = &Column> {
        let columns = self.files.schema().columns().iter();
        columns.filter(|it| it.kind == Kind::Float && !it.name.starts_with(PARAMETER))
    }

    /// Requirements, in the order of the columns.
    pub(super) fn requirements(&self) -> Vec<Asked> {
        self.files.schema().columns().iter().filter_map(asked).collect()
    }
}

/// A part, as another thread opens it.
pub(super) struct Piece<'a> {
    part: &'a Seen,
    head: &'a Head,
    first_runs: usize,
}

impl Piece<'_> {
    /// Opens it; every byte is read and checked.
    pub(super) fn open(&self) -> Result<Source, SummaryError> {
        let files = Files::one(self.part)?;
        files.verify()?;
        let runs = files.rows() / self.head.controllers.len().max(1);
        let (head, first_runs) = (self.head.clone(), self.first_runs);
        Ok(Source { files, head, runs, first_runs, parts: Vec::new(), exact: false, small: false })
    }
}

/// Rows that nothing but footers was read of, and what these say.
pub(crate) struct Found {
    pub(crate) files: Files,
    head: Head,
    parts: Vec<Seen>,
}

impl Found {
    /// The merged file at a path or in a folder; the parts, where there is none.
    pub(crate) fn at(path: &Path, settings: SummarySettings) -> Result<Self, SummaryError> {
        let folder = Folder::new(path);
        if path.is_dir() {
            folder.keep_apart().map_err(|error| SummaryError::Folder(Box::new(error)))?;
        }
        let mut found = match path.is_dir() {
            false => Self::merged(path)?,
            true if folder.merged_path().exists() => Self::merged(&folder.merged_path())?,
            true => Self::parts(&folder, settings.incomplete)?,
        };
        let Self { files, head, .. } = &mut found;
        check_columns(files.schema()).map_err(|reason| refusal(files.path(), reason))?;
        head.confidence = settings.confidence;
        head.rows = files.rows() as u64;
        head.parameters = files.schema().columns().iter().filter_map(parameter).collect();
        Ok(found)
    }

    fn merged(path: &Path) -> Result<Self, SummaryError> {
        let reader = Reader::open(path)?;
        let named = |key| reader.metadata_value(key).ok_or(NotMerged::NoKey { key });
        let head = || {
            let (campaign, program) =
                (named(CAMPAIGN_KEY)?.to_owned(), named(PROGRAM_KEY)?.to_owned());
            let plan = reader.metadata_value(PLAN_KEY).ok_or(NotMerged::Part)?;
            head(plan, campaign, program)
        };
        let head = check_columns(reader.schema()).and_then(|()| head());
        let head = head.map_err(|reason| refusal(path, reason))?;
        Ok(Self { files: Files::merged(reader), head, parts: Vec::new() })
    }

    fn parts(folder: &Folder, incomplete: bool) -> Result<Self, SummaryError> {
        let failed = |error| SummaryError::Folder(Box::new(error));
        let plan = folder.plan().map_err(failed)?;
        let parts = Parts::of(folder, &plan, None).map_err(failed)?;
        let shards = Shards { found: parts.shards(&plan), of: plan.shards() };
        let runs = parts.missing_runs();
        let files = Files::of(&parts.seen)?;
        let (Some(files), true) = (files, incomplete || runs == 0) else {
            let missing = parts.gaps.first().copied();
            let missing = missing.unwrap_or(Range { first: 0, end: plan.runs });
            return Err(SummaryError::Incomplete { shards, missing, runs });
        };
        let head = head(&plan_text(&plan), plan.id(), plan.program.clone());
        let mut head = head.map_err(|reason| refusal(files.path(), reason))?;
        head.shards = Some(shards);
        head.runs -= runs;
        Ok(Self { files, head, parts: parts.seen })
    }

    /// True for the rows that a summary was made of.
    pub(crate) fn is_of(&self, summary: &Summary) -> bool {
        let (ours, theirs) = (&self.head, &summary.head);
        let of = |head: &Head| (head.campaign.clone(), head.rows, head.shards);
        of(ours) == of(theirs)
            && (ours.shards.is_some() || theirs.digest == Some(self.files.first().digest()))
    }
}

fn refusal(path: &Path, reason: NotMerged) -> SummaryError {
    SummaryError::NotMerged { path: path.to_owned(), reason }
}

/// Checks that every column that is needed is there and of its kind.
fn check_columns(schema: &Schema) -> Result<(), NotMerged> {
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

/// What a plan says, as merged files carry it; what the rows say is not among that.
fn head(plan: &str, campaign: String, program: String) -> Result<Head, NotMerged> {
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
    let runs = runs.ok_or(NotMerged::Plan { place: "/runs" })?;
    let scenario_text = text("/scenario")?.to_owned();
    Ok(Head {
        campaign,
        program,
        scenario: scenario_name(&scenario_text, &changes),
        scenario_digest: text("/scenario_digest")?.to_owned(),
        runs,
        planned_runs: runs,
        shards: None,
        rows: 0,
        seed: text("/seed")?.parse().map_err(|_| NotMerged::Plan { place: "/seed" })?,
        sampling: Sampling::from_name(text("/sampling")?)
            .ok_or(NotMerged::Plan { place: "/sampling" })?,
        digest: None,
        controllers: Vec::new(),
        parameters: Vec::new(),
        confidence: SummarySettings::default().confidence,
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
    let mut first = None;
    for table in reader.columns(&[RUN, CONTROLLER])? {
        let table: ColumnTable = table?;
        let (Values::Integer(runs), Values::Text(names)) =
            (table.column(RUN)?, table.column(CONTROLLER)?)
        else {
            break;
        };
        for (run, name) in runs.iter().zip(names) {
            match name {
                Some(name) if *run == *first.get_or_insert(*run) => controllers.push(name.clone()),
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
