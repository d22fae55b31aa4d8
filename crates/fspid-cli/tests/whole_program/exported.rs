//! What is exported is what flies: a controller of a scenario, written in C, compiled, and flown in its scenario beside the
//! original, from which it may differ in no bit; and its own check, with numbers of 64 and of 32 bits.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;

use fspid_study::output::{Names, Place};

use super::{Accepted, list, word};
use crate::accepted::{Drawn, answer};
use crate::common::{code, json, text};

/// Samples of the check of an export.
const SAMPLES: &str = "400";
/// What an export may say that writes none; what it is called here.
const REFUSED: [&str; 4] = [
    "has no equations",
    "cannot fly with numbers of 32 bits",
    "--to rust alone",
    "marked for tuning",
];

/// What became of the exports that were asked for.
#[derive(Default)]
pub(super) struct Exports {
    flown: usize,
    checked: usize,
    refused: BTreeMap<&'static str, usize>,
}

impl Exports {
    /// For people, behind the last draw.
    pub(super) fn told(&self) -> String {
        let Self { flown, checked, refused } = self;
        format!(
            "exports: {flown} flown in their scenarios bit for bit, {checked} asked for their vectors, refused {refused:?}"
        )
    }

    /// One controller of the scenario, whichever is drawn.
    pub(super) fn law(&mut self, scenario: &Accepted<'_>, draw: u64) -> Result<(), String> {
        if !has_compiler() {
            return Ok(());
        }
        let flown = scenario.json(&["simulate"])?;
        let names: Vec<&str> =
            list(&flown, "controllers").iter().map(|it| word(it, "name")).collect();
        let name = *Drawn(draw).one_of(&names);
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        for numbers in ["double", "single"] {
            self.of(scenario, name, numbers, folder.path())?;
        }
        Ok(())
    }

    fn of(
        &mut self,
        scenario: &Accepted<'_>,
        name: &str,
        numbers: &str,
        folder: &Path,
    ) -> Result<(), String> {
        let out = folder.join(numbers);
        let (controller, shown) = (format!("--controller={name}"), out.display().to_string());
        let options =
            ["--to", "c", "--numbers", numbers, "--samples", SAMPLES, "--prefix", "drawn"];
        let question =
            [&["export", &controller, "--out", &shown, "--format", "json"], &options[..]].concat();
        let words = scenario.words(&question);
        let output = answer(&words, &[0, 2])?;
        if code(&output) == 2 {
            let told = text(&output.stderr) + &text(&output.stdout);
            let known = REFUSED.into_iter().find(|reason| told.contains(reason));
            let known = known.ok_or_else(|| format!("fspid {}: {told}", words.join(" ")))?;
            *self.refused.entry(known).or_default() += 1;
            return Ok(());
        }
        answers_its_vectors(&out).map_err(|what| format!("{name}, {numbers}: {what}"))?;
        self.checked += 1;
        if numbers == "double" {
            flies_as_the_original(scenario, name, &out)
                .map_err(|what| format!("the export of {name} in C: {what}"))?;
            self.flown += 1;
        }
        Ok(())
    }
}

/// Whether there is a compiler for C; where there is none that is told, past what tests hold back.
fn has_compiler() -> bool {
    static FOUND: std::sync::LazyLock<bool> = std::sync::LazyLock::new(|| {
        let is_there = Command::new("cc").arg("--version").output().is_ok();
        if !is_there {
            let told = "NOT CHECKED: no exports in C, for there is no compiler `cc`";
            let _ = writeln!(std::io::stderr(), "{told}");
        }
        is_there
    });
    *FOUND
}

fn compiled(folder: &Path, words: &[&str]) -> Result<(), String> {
    let options = ["-std=c99", "-O1", "-ffp-contract=off"];
    let built = Command::new("cc").args(options).args(words).current_dir(folder).output();
    let built = built.map_err(|error| format!("cc: {error}"))?;
    match built.status.success() {
        true => Ok(()),
        false => Err(format!("cc {}: {}", words.join(" "), text(&built.stderr))),
    }
}

/// The program that comes with the export counts no answer with other bits, and its self test none either.
fn answers_its_vectors(folder: &Path) -> Result<(), String> {
    compiled(folder, &["drawn.c", "drawn_check.c", "drawn_selftest.c", "-o", "check"])?;
    let asked = Command::new(folder.join("check")).output().map_err(|error| error.to_string())?;
    let told = text(&asked.stdout);
    let is_same = asked.status.success() && told.contains(" samples, 0 different");
    if is_same { Ok(()) } else { Err(format!("{}: {told}{}", asked.status, text(&asked.stderr))) }
}

/// Flown in its scenario beside the original, every number of its trace is the original's.
fn flies_as_the_original(scenario: &Accepted<'_>, name: &str, folder: &Path) -> Result<(), String> {
    compiled(
        folder,
        &["-shared", "-fPIC", "drawn.c", "external/drawn_external.c", "-o", "drawn.so"],
    )?;
    let (library, trace) = (folder.join("drawn.so"), folder.join("trace.csv"));
    let [library, shown] = [&library, &trace].map(|path| path.display().to_string());
    let question = ["simulate", "--library", &library, "--trace", &shown, "--format", "json"];
    let answer = json(&answer(&scenario.words(&question), &[0, 1])?);
    // A name with a comma has another one there.
    let all: Vec<&str> = list(&answer, "controllers").iter().map(|it| word(it, "name")).collect();
    let called = Names::of(Place::Column, all);
    let csv = std::fs::read_to_string(&trace).map_err(|error| error.to_string())?;
    let [original, export] = [name, "drawn.so"].map(|name| columns(&csv, &called.name(name)));
    if original.is_empty() || original.len() != export.len() {
        return Err(format!("{} columns, the original has {}", export.len(), original.len()));
    }
    let differs = |(original, export): &(Column<'_>, Column<'_>)| original != export;
    match original.into_iter().zip(export).find(differs) {
        None => Ok(()),
        Some((original, export)) => Err(first_difference(&original, &export)),
    }
}

/// What a column is called, without its controller, and its cells.
type Column<'a> = (&'a str, Vec<&'a str>);

/// The columns of a controller, as they are written.
fn columns<'a>(csv: &'a str, name: &str) -> Vec<Column<'a>> {
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let Some((names, rows)) = rows.split_first() else { return Vec::new() };
    let of = |(at, column): (usize, &&'a str)| {
        let measure = column.strip_prefix(name)?.strip_prefix('.')?;
        Some((measure, rows.iter().map(|row| row[at]).collect()))
    };
    names.iter().enumerate().filter_map(of).collect()
}

fn first_difference(original: &Column<'_>, export: &Column<'_>) -> String {
    let differ = |(one, other): &(&&str, &&str)| one != other;
    let row = original.1.iter().zip(&export.1).position(|pair| differ(&pair)).unwrap_or_default();
    let cell = |column: &Column<'_>| column.1.get(row).copied().unwrap_or_default().to_owned();
    format!(
        "{} at sample {row} is {:?}, the original's {} is {:?}",
        export.0,
        cell(export),
        original.0,
        cell(original)
    )
}
