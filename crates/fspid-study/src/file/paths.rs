//! Every path of a scenario that `--set`, dispersions and marks may take, with its unit, value and range.

use std::path::Path;

use serde_json::{Value, json};

use super::check::{self, allowed};
use super::files::Files;
use super::mark::FIXED;
use super::report::Report;
use super::section::{Checked, Entry, Section};
use super::setting::{join, number, step, written};
use super::spec::{Key, Kind, Presence, SCENARIO, Table, Way};
use super::{LoadError, build, changed_document, extra::Extra, read_text};

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
    let (mut report, mut files) = (Report::default(), Files::new(path.parent()));
    let extra = Extra { overrides, ..Extra::default() };
    let mut rows = Vec::new();
    if let Some((document, _)) = changed_document(&mut report, &mut files, &text, &extra)
        && let Some(section) = check::table(&mut report, &SCENARIO, &document, "")
    {
        // What a file says that the scenario names is read while it is built.
        let _ = build::scenario(&mut report, &mut files, &section);
        files.report_unused_changes(&mut report);
        let mut walk =
            Walk { files: &files, root: String::new(), in_file: false, rows: Vec::new() };
        walk.keys(&SCENARIO, &section, "");
        rows = walk.rows;
    }
    report.finish(&name).map_err(LoadError::Problems)?;
    Ok(rows)
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
    let mut out = String::new();
    for row in &table {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out.push_str(
        "\n--set takes every path; `drawn` a [[dispersion]] too, and `free` a mark { tune = [lower, upper] }. - is left out.\n",
    );
    out
}

/// The answer for programs.
#[must_use]
pub fn paths_json(rows: &[PathRow]) -> Value {
    let row = |row: &PathRow| {
        json!({
            "path": row.path, "value": row.value, "unit": row.unit, "allowed": row.allowed,
            "given": row.given, "dispersion": row.drawn, "mark": row.free,
        })
    };
    json!({ "schema": 1, "paths": rows.iter().map(row).collect::<Vec<_>>() })
}

fn cut(text: &str, most: usize) -> String {
    match text.chars().count() > most {
        true => text.chars().take(most - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

/// True for a key of another way of saying what the table says already: an aircraft beside a plant.
fn is_excluded(spec: &Table, section: &Section, name: &str) -> bool {
    spec.choices.iter().any(|choice| {
        let has = |way: &&Way| way.required.contains(&name) || way.optional.contains(&name);
        let is_used = |way: &&Way| way.required.iter().any(|key| section.given(key));
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
        for key in spec.keys_of(section.kind) {
            let inner = join(path, key.name);
            if path.is_empty() {
                key.name.clone_into(&mut self.root);
            }
            match section.entry(key.name) {
                Some(entry) => self.entry(key, entry, inner, &section.path(key.name)),
                None if is_excluded(spec, section, key.name) => {}
                None => self.absent(key, inner),
            }
        }
    }

    fn entry(&mut self, key: &'static Key, entry: &Entry, path: String, place: &str) {
        match (&entry.value, &key.kind) {
            (Checked::Section(section), Kind::Table(spec) | Kind::Rules(spec)) => {
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
                self.push(kind, path.clone(), Some(written(value)), entry.given);
                if let Some((spec, file)) = self.files.referred(place) {
                    let before = std::mem::replace(&mut self.in_file, true);
                    self.keys(spec, file, &path);
                    self.in_file = before;
                }
            }
        }
    }

    /// A key that the file leaves out, with those of its table.
    fn absent(&mut self, key: &'static Key, path: String) {
        match (&key.presence, &key.kind) {
            (Presence::Default(default), kind) => {
                self.push(kind, path, Some(written(&check::default_value(kind, *default))), false);
            }
            // Lists that are left out have no entry to be changed.
            (_, Kind::Tables { .. }) => {}
            (_, Kind::Table(_)) if FIXED.contains(&self.root.as_str()) => {}
            (_, Kind::Table(spec)) => {
                if !spec.variants.is_empty() {
                    let kinds: Vec<&str> = spec.variants.iter().map(|it| it.name).collect();
                    let allowed = check::quoted(&kinds);
                    self.row(join(&path, "kind"), (None, ""), allowed, (false, false));
                }
                spec.keys().for_each(|key| self.absent(key, join(&path, key.name)));
            }
            // A list that is left out is given as a whole.
            (_, kind @ (Kind::Numbers { .. } | Kind::Interval { .. })) => {
                self.row(path, (None, kind.unit()), allowed(kind), (false, false));
            }
            (_, kind) => self.push(kind, path, None, false),
        }
    }

    fn push(&mut self, kind: &'static Kind, path: String, value: Option<String>, given: bool) {
        let (words, is_scalar, is_real) = match kind {
            Kind::Numbers { unit, range, .. } | Kind::Interval { unit, range } => {
                (range.words(unit), true, true)
            }
            kind => (
                allowed(kind),
                !matches!(kind, Kind::Own { .. } | Kind::Rules(_) | Kind::Grid | Kind::NumberGrid),
                matches!(kind, Kind::Number { .. } | Kind::Grid | Kind::NumberGrid),
            ),
        };
        let drawn = is_scalar && !NEVER_DRAWN.contains(&self.root.as_str());
        let free = is_real && !self.in_file && !FIXED.contains(&self.root.as_str());
        self.row(path, (value, kind.unit()), words, (drawn, free));
        if let Some(row) = self.rows.last_mut() {
            row.given = given;
        }
    }

    fn row(
        &mut self,
        path: String,
        (value, unit): (Option<String>, &'static str),
        allowed: String,
        (drawn, free): (bool, bool),
    ) {
        self.rows.push(PathRow { path, value, unit, allowed, given: false, drawn, free });
    }
}
