//! `fspid check`: is a file right?

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::Format;
use crate::argument::InFile;
use crate::exit::{Failure, note};
use fspid_certify::CheckedFile;
use fspid_diagnostics::digits::counted;
use fspid_scenario::file::{self, LoadError, Template};
use fspid_scenario::fuzzy_system;
use fspid_study::aircraft;
use fspid_study::json::with_null_reasons;
use fspid_study::shell;
use fspid_tune::Written;

/// Check a scenario, an aircraft or a fuzzy system and tell every problem in it.
///
/// Of a scenario the cases that it is tuned on and judged by are checked as well, each with its own changes.
///
/// Where a certificate lies beside a scenario (`pitch.certificate.json` beside `pitch.toml`), it is verified, and compared
/// with what the scenario flies; others in the folder that name the scenario are told.
///
/// Of an aircraft its motions are told, and what in its numbers is hardly meant: a unit, a sign, a digit.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The file: a scenario, an aircraft, a fuzzy system (.toml, .fis, .t2fis, .fcl, .fll, .xml), or a rule table.
    file: InFile,
    /// Set a value of a scenario before checking, e.g. `--set controller.FSPID.nominal.kp=2.5`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// List every path of a scenario that --set, dispersions and marks may take, with its value, unit and range.
    #[arg(long)]
    paths: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.paths {
        let rows = file::paths(&arguments.file, &arguments.overrides).map_err(Failure::load)?;
        return arguments.format.print(|| file::paths_text(&rows), || file::paths_json(&rows));
    }
    // What is to be changed by --set is a scenario, or told to be none.
    if arguments.overrides.is_empty() {
        let (path, format): (&Path, _) = (&arguments.file, arguments.format);
        match path {
            table if fuzzy_system::is_rule_table_file(table) => return rule_table(table, format),
            fuzzy if fuzzy_system::is_system(fuzzy) => return system(fuzzy, format),
            own if file::is_aircraft_file(own) => return aircraft(own, format),
            _ => {}
        }
    }
    scenario(arguments)
}

fn scenario(arguments: &Arguments) -> Result<(), Failure> {
    let text = file::read_text(&arguments.file).map_err(Failure::load)?;
    let written = Written {
        text: &text,
        name: &arguments.file.display().to_string(),
        folder: Some(arguments.file.parent().unwrap_or(Path::new(""))),
        overrides: &arguments.overrides,
    };
    let template = written.template().map_err(|it| Failure::load(LoadError::Problems(it)))?;
    let study = template.study();
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    let beyond = written.check_beyond(&template);
    beyond.map_err(|wrong| Failure::of_input(&wrong, Some(wrong.to_json())))?;
    for gains in &study.derived_gains {
        note(format_args!("gains of {gains}"));
    }
    let scenario = &study.scenario;
    let (file, timing) = (arguments.file.display(), scenario.timing);
    let certificate = beside(&arguments.file, &template)?;
    tell_unchecked(&arguments.file, &scenario.name);
    let text = || {
        let mut text = format!(
            "{file}: good; {} with {}, {} samples of {} s, digest {}\n",
            scenario.name,
            counted(scenario.flyers().count(), "controller"),
            timing.rows(),
            timing.dt_s(),
            study.digest,
        );
        if let Some((path, checked)) = &certificate {
            text.push_str(&format!("{}\n{}", path.display(), checked.text()));
        }
        text
    };
    let names = scenario.flyers().map(|flyer| flyer.name());
    let json = || {
        let answer = json!({
            "schema": 1, "file": file.to_string(), "kind": "scenario", "good": true,
            "name": scenario.name, "controllers": names.collect::<Vec<_>>(), "samples": timing.rows(),
            "sample_period_s": timing.dt_s(), "digest": study.digest, "warnings": study.warnings,
            "certificate": certificate.as_ref().map(|(_, checked)| checked.json()),
        });
        with_null_reasons(answer, &[("certificate", "no certificate lies beside the scenario")])
    };
    arguments.format.print(text, json)?;
    certificate.map_or(Ok(()), |(path, checked)| judge(&path, &checked, arguments))
}

/// The certificate beside a scenario, verified and compared with what flies, if there is one.
fn beside(scenario: &Path, template: &Template) -> Result<Option<(PathBuf, CheckedFile)>, Failure> {
    let path = scenario.with_extension("certificate.json");
    if !path.is_file() {
        return Ok(None);
    }
    let mut checked = super::certify::read(&path)?;
    checked.compare_family(template).map_err(Failure::input)?;
    Ok(Some((path, checked)))
}

/// Tells of certificates that name the scenario and are not checked, with the command that does it.
fn tell_unchecked(scenario: &Path, name: &str) {
    let others = naming(scenario, name);
    let Some(first) = others.first() else { return };
    let word = |path: &Path| shell::word(&path.display().to_string());
    let (count, verb) = match others.len() {
        1 => ("1 certificate here names this scenario".to_owned(), "is"),
        many => (format!("{many} certificates here name this scenario"), "are"),
    };
    note(format_args!(
        "{count} and {verb} not checked: fspid certify --check {} --against {}",
        word(first),
        word(scenario)
    ));
}

/// Certificates of the scenario's folder that were made of one of this name, but for the one beside it.
fn naming(scenario: &Path, name: &str) -> Vec<PathBuf> {
    let folder = scenario.parent().filter(|it| !it.as_os_str().is_empty());
    let entries = folder.unwrap_or(Path::new(".")).read_dir().into_iter().flatten().flatten();
    let own = scenario.with_extension("certificate.json");
    let is_other = |path: &PathBuf| {
        let is_certificate = path.to_string_lossy().ends_with(".certificate.json");
        is_certificate && path.file_name() != own.file_name()
    };
    let names_it = |path: &PathBuf| {
        let text = file::read_text(path).ok();
        let made: Option<Value> = text.and_then(|text| serde_json::from_str(&text).ok());
        made.is_some_and(|made| made["origin"]["scenario"] == name)
    };
    let paths = entries.map(|entry| scenario.with_file_name(entry.file_name()));
    let mut found: Vec<PathBuf> = paths.filter(is_other).filter(names_it).collect();
    found.sort();
    found
}

fn judge(path: &Path, checked: &CheckedFile, arguments: &Arguments) -> Result<(), Failure> {
    if checked.holds() {
        return Ok(());
    }
    let unmet = super::certify::unmet(checked.answer());
    // With --set something else flies than what stands in the file, as was asked for.
    if !arguments.overrides.is_empty() {
        note(format_args!("warning: {}: {unmet}", path.display()));
        return Ok(());
    }
    Err(Failure::not_met(format_args!("{}: {unmet}", path.display())))
}

fn rule_table(path: &Path, format: Format) -> Result<(), Failure> {
    let name = path.display().to_string();
    file::load_rule_table(&name, None).map_err(Failure::input)?;
    format.print(
        || format!("{name}: good; a rule table of three grids of 49 rules\n"),
        || json!({ "schema": 1, "file": name, "kind": "rule-table", "good": true, "rules": 3 * 49 }),
    )
}

fn aircraft(path: &Path, format: Format) -> Result<(), Failure> {
    let checked = aircraft::check(&path.display().to_string()).map_err(Failure::input)?;
    for warning in &checked.warnings {
        note(format_args!("warning: {warning}"));
    }
    format.print(|| checked.text(), || checked.json())
}

fn system(path: &Path, format: Format) -> Result<(), Failure> {
    let name = path.display().to_string();
    let loaded = fuzzy_system::load(&name, fuzzy_system::Options::default());
    let loaded = loaded.map_err(Failure::input)?;
    for found in &loaded.notes {
        note(format_args!("warning: {found}"));
    }
    let parts = loaded.system.parts();
    let rules = parts.blocks.iter().map(|block| block.rules.len()).sum::<usize>();
    let inputs = counted(parts.inputs.len(), "input");
    let outputs = counted(parts.outputs.len(), "output");
    let text = || {
        let called = if parts.name.is_empty() { "a fuzzy system" } else { &parts.name };
        format!("{name}: good; {called} with {inputs}, {outputs}, {}\n", counted(rules, "rule"))
    };
    let json = || {
        json!({
            "schema": 1, "file": name, "kind": "fuzzy-system", "good": true, "name": parts.name,
            "inputs": parts.inputs.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(),
            "outputs": parts.outputs.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(),
            "rules": rules, "warnings": loaded.notes,
        })
    };
    format.print(text, json)
}
