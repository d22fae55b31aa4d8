//! Every path of a scenario that `--set`, dispersions and marks may take, with its unit, value and range.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::files::Files;
use super::setting::{number, quoted, step, written};
use super::spec::SCENARIO;
use super::{LoadError, Problems, build, changed_document, extra::Extra, read_text};
use crate::keyed::check::{self, FIXED, allowed};
use crate::keyed::document::Item;
use crate::keyed::schema::{self, kind as schema_of};
use crate::keyed::{Checked, Entry, KeyName, KeyRow, Kind, Section, Table, Way, join};
use crate::setting_path::{SettingPath, Step, bare, steps};
use fspid_diagnostics::{Report, nearest};

/// Top-level keys whose numbers cannot differ from run to run.
pub(super) const NEVER_DRAWN: [&str; 4] = ["dispersion", "requirement", "schema", "set"];

/// A place of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathRow {
    /// Where it is, such as `controller.FSPID.supervisor.range`: what `--set` changes.
    pub path: String,
    /// The value as TOML has it; `None` for a key that is left out and has no default.
    pub value: Option<String>,
    /// The unit, empty where there is none.
    pub unit: &'static str,
    /// What it may be, in words.
    pub allowed: String,
    /// The same for programs: a JSON Schema of the value.
    pub schema: Map<String, Value>,
    /// Written in the file, in an override, or in a file that one of them names.
    pub given: bool,
    /// A dispersion may draw it.
    pub drawn: bool,
    /// A mark may make it free.
    pub free: bool,
}

/// Every path of a scenario, in the order of the specification.
///
/// # Errors
/// A file that cannot be read, or everything that is wrong with it.
pub fn paths(path: &Path, overrides: &[String]) -> Result<Vec<PathRow>, LoadError> {
    let text = read_text(path)?;
    let name = path.display().to_string();
    paths_of(&text, &name, path.parent(), overrides).map_err(LoadError::Problems)
}

/// As [`paths`], of a text called `name` in messages; without a `folder` it cannot refer to files.
///
/// # Errors
/// Everything that is wrong with it.
pub fn paths_of(
    text: &str,
    name: &str,
    folder: Option<&Path>,
    overrides: &[String],
) -> Result<Vec<PathRow>, Problems> {
    let (mut report, mut files) = (Report::default(), Files::new(folder));
    let extra = Extra { overrides, ..Extra::default() };
    let document = changed_document(&mut report, &mut files, text, &extra);
    let rows = document.map(|(document, _)| rows(&mut report, &mut files, &document));
    report.finish(name)?;
    Ok(rows.unwrap_or_default())
}

/// Every path of a document; none of one that is wrong.
pub(super) fn rows(report: &mut Report, files: &mut Files<'_>, document: &Item) -> Vec<PathRow> {
    let Some(section) = check::table(report, &SCENARIO, document, "") else {
        return Vec::new();
    };
    // What a file says that the scenario names is read while it is built.
    let _ = build::scenario(report, files, &section);
    files.report_unused_changes(report);
    let mut walk = Walk { files, root: String::new(), in_file: false, rows: Vec::new() };
    walk.keys(&SCENARIO, &section, "");
    walk.rows
}

/// The row of a place, however `--set` may call it: an entry of a list by its number too, where rows call it by its name.
#[must_use]
pub fn row_at<'a>(rows: &'a [PathRow], path: &str) -> Option<&'a PathRow> {
    let all = with_steps(rows);
    let found = named(&all, path)?;
    all.into_iter().find_map(|(steps, row)| (steps == found).then_some(row))
}

/// The path of a row that was probably meant by one that is not there.
pub(super) fn meant<'a>(rows: &'a [PathRow], path: &str) -> Option<&'a str> {
    let mut found = String::new();
    for step in named(&with_steps(rows), path)? {
        match step {
            Step::Index(index) => found.push_str(&format!("[{index}]")),
            Step::Name(name) if found.is_empty() => found = bare(&name),
            Step::Name(name) => found.push_str(&format!(".{}", bare(&name))),
        }
    }
    let known: Vec<&str> = rows.iter().filter(|it| it.drawn).map(|it| it.path.as_str()).collect();
    nearest(&found, &known)
}

fn with_steps(rows: &[PathRow]) -> Vec<(Vec<Step>, &PathRow)> {
    rows.iter().filter_map(|row| Some((steps(&row.path)?, row))).collect()
}

/// The steps of a path, with the names of entries in place of their numbers.
fn named(all: &[(Vec<Step>, &PathRow)], path: &str) -> Option<Vec<Step>> {
    let mut found: Vec<Step> = Vec::new();
    for step in SettingPath::parse(path)?.steps() {
        let name = match step {
            Step::Index(index) => name_of_entry(all, &found, *index),
            Step::Name(_) => None,
        };
        found.push(name.map_or_else(|| step.clone(), Step::Name));
    }
    Some(found)
}

/// The name of an entry of the list at some steps; none where entries have no names, or too few are there.
fn name_of_entry(all: &[(Vec<Step>, &PathRow)], list: &[Step], index: usize) -> Option<String> {
    let mut names = all.iter().filter_map(|(steps, row)| match steps.strip_prefix(list)? {
        [Step::Name(name), Step::Name(key)] if key == "name" => {
            (row.value.as_ref() == Some(&quoted(name))).then_some(name)
        }
        _ => None,
    });
    names.nth(index).cloned()
}

/// The answer for people.
#[must_use]
pub fn paths_text(rows: &[PathRow]) -> String {
    let head = ["path", "value", "unit", "may be", "drawn", "free"].map(str::to_owned);
    let yes = |yes: bool| if yes { "yes" } else { "" }.to_owned();
    let cells = |row: &PathRow| {
        let value = row.value.clone().unwrap_or_else(|| "-".to_owned());
        let value = cut(&value, 32);
        [
            row.path.clone(),
            value,
            row.unit.to_owned(),
            cut(&row.allowed, 60),
            yes(row.drawn),
            yes(row.free),
        ]
    };
    let table: Vec<[String; 6]> = std::iter::once(head).chain(rows.iter().map(cells)).collect();
    let width =
        |column: usize| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] = std::array::from_fn(width);
    let mut out = "--set takes every path; what is `drawn` a [[dispersion]] too, and what is `free` a mark { tune = [lower, upper] }.\n\
        - stands for what is left out; what belongs to a table that is left out goes with the whole table.\n\n"
        .to_owned();
    for row in &table {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out
}

/// The answer for programs.
#[must_use]
pub fn paths_json(rows: &[PathRow]) -> Value {
    // What TOML writes of numbers, texts and lists is JSON; the few numbers that JSON lacks are told as texts.
    let value = |text: &String| serde_json::from_str(text).unwrap_or_else(|_| json!(text));
    let row = |row: &PathRow| {
        json!({
            "path": row.path, "value": row.value.as_ref().map(value), "unit": row.unit,
            "allowed": row.allowed, "schema": row.schema,
            "given": row.given, "dispersion": row.drawn, "mark": row.free,
        })
    };
    let left_out = json!({ "value": "the key is left out and has no default" });
    json!({ "schema": 1, "null": left_out, "paths": rows.iter().map(row).collect::<Vec<_>>() })
}

/// A value as TOML has it, nothing of it cut.
fn whole(value: &Checked) -> String {
    match value {
        Checked::Text(text) => quoted(text),
        value => written(value),
    }
}

fn cut(text: &str, most: usize) -> String {
    match text.chars().count() > most {
        true => text.chars().take(most - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

/// True for a key of another way of saying what the table says already: an aircraft beside a plant.
fn is_excluded(spec: &Table, section: &Section, name: KeyName) -> bool {
    spec.choices.iter().any(|choice| {
        let has = |way: &&Way| way.required.contains(&name) || way.optional.contains(&name);
        let is_used = |way: &&Way| way.required.iter().any(|key| section.given(*key));
        let mut ways = choice.ways.iter();
        choice.ways.iter().any(|way| has(&way)) && ways.any(|way| is_used(&way) && !has(&way))
    })
}

struct Walk<'a> {
    files: &'a Files<'a>,
    /// The top-level key that the walk is in.
    root: String,
    /// Inside of a file that the scenario names, where no mark can stand.
    in_file: bool,
    rows: Vec<PathRow>,
}

impl Walk<'_> {
    fn keys(&mut self, spec: &'static Table, section: &Section, path: &str) {
        if !section.kind.is_empty() {
            self.kind(spec, path, Some(section.kind));
        }
        for key in spec.keys_of(section.kind) {
            let (name, inner) = (key.name(), join(path, key.name().as_str()));
            if path.is_empty() {
                name.as_str().clone_into(&mut self.root);
            }
            match section.entry(name) {
                Some(entry) => self.entry(key, entry, inner, &section.path(name)),
                None if is_excluded(spec, section, name) => {}
                None => self.absent(key, inner, true),
            }
        }
    }

    fn entry(&mut self, key: KeyRow, entry: &Entry, path: String, place: &str) {
        match (&entry.value, key.kind()) {
            (Checked::Section(section), Kind::Table(spec) | Kind::Rules { grids: spec, .. }) => {
                self.keys(spec, section, &path);
            }
            (Checked::Sections(sections), Kind::Tables { table, .. }) => {
                for (index, section) in sections.iter().enumerate() {
                    self.keys(table, section, &format!("{path}{}", step(section, index)));
                }
            }
            (Checked::Numbers(numbers), kind) => {
                for (index, (value, _)) in numbers.iter().enumerate() {
                    let value = Some(number(*value));
                    self.push(kind, format!("{path}[{index}]"), value, entry.given);
                }
            }
            (value, kind) => {
                self.push(kind, path.clone(), Some(whole(value)), entry.given);
                if let Some((spec, file)) = self.files.referred(place) {
                    let before = std::mem::replace(&mut self.in_file, true);
                    self.keys(spec, file, &path);
                    self.in_file = before;
                }
            }
        }
    }

    /// The kind of a table that has kinds.
    fn kind(&mut self, spec: &'static Table, path: &str, found: Option<&str>) {
        let kinds: Vec<&str> = spec.variants.iter().map(|it| it.name).collect();
        let schema = json!({ "type": "string", "enum": kinds });
        self.row(PathRow {
            path: join(path, "kind"),
            value: found.map(quoted),
            unit: "",
            allowed: check::quoted(&kinds),
            schema: schema.as_object().cloned().unwrap_or_default(),
            given: found.is_some(),
            drawn: false,
            free: false,
        });
    }

    /// A key that the file leaves out, with those of its table; its default flies where its table `is_there`.
    fn absent(&mut self, key: KeyRow, path: String, is_there: bool) {
        match (key.default(), key.kind()) {
            (Some(default), kind) if is_there => {
                self.push(kind, path, Some(whole(&default)), false);
            }
            // Lists that are left out have no entry to be changed.
            (_, Kind::Tables { .. }) => {}
            (_, Kind::Table(_)) if FIXED.contains(&self.root.as_str()) => {}
            (_, Kind::Table(spec)) => {
                if !spec.variants.is_empty() {
                    self.kind(spec, &path, None);
                }
                // Kinds may share a key.
                let mut told: Vec<KeyName> = Vec::new();
                for key in spec.all_keys() {
                    let name = key.name();
                    if !told.contains(&name) {
                        told.push(name);
                        let path = join(&path, name.as_str());
                        self.absent(key, path, is_there && spec.may_be_empty());
                    }
                }
            }
            (_, kind) => {
                self.push(kind, path, None, false);
                // A list that is left out is given as a whole, and so is a table.
                let is_list = matches!(kind, Kind::Numbers { .. } | Kind::Interval { .. });
                if let Some(row) = self.rows.last_mut().filter(|_| is_list || !is_there) {
                    (row.drawn, row.free) = (false, false);
                    if is_list {
                        (row.allowed, row.schema) = (allowed(kind), schema_of(kind));
                    }
                }
            }
        }
    }

    fn push(&mut self, kind: &'static Kind, path: String, value: Option<String>, given: bool) {
        let (words, schema) = match kind {
            // One of its numbers.
            Kind::Numbers { unit, range, .. } | Kind::Interval { unit, range } => {
                (range.words(unit), schema::number(*range).as_object().cloned())
            }
            kind => (allowed(kind), Some(schema_of(kind))),
        };
        // Texts say something to people, and nothing to a flight.
        let is_drawn = match kind {
            Kind::Number { .. }
            | Kind::Numbers { .. }
            | Kind::Interval { .. }
            | Kind::Integer { .. }
            | Kind::Boolean
            | Kind::Word(_)
            | Kind::Preset(_)
            | Kind::Path
            | Kind::Defuzzifier => true,
            Kind::Text
            | Kind::FreeText
            | Kind::Own { .. }
            | Kind::Rules { .. }
            | Kind::Grid
            | Kind::NumberGrid
            | Kind::Table(_)
            | Kind::Tables { .. } => false,
        };
        let is_free = matches!(
            kind,
            Kind::Number { .. }
                | Kind::Numbers { .. }
                | Kind::Interval { .. }
                | Kind::Grid
                | Kind::NumberGrid
        );
        self.row(PathRow {
            path,
            value,
            unit: kind.unit(),
            allowed: words,
            schema: schema.unwrap_or_default(),
            given,
            drawn: is_drawn && !NEVER_DRAWN.contains(&self.root.as_str()),
            free: is_free && !self.in_file && !FIXED.contains(&self.root.as_str()),
        });
    }

    fn row(&mut self, row: PathRow) {
        self.rows.push(row);
    }
}
