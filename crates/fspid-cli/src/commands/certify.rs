//! `fspid certify`: stability while the gains move.

use std::path::Path;
use std::sync::Mutex;

use clap::Args;

use super::external_controller::leave_out;
use super::progress::{Telling, alive, tell};
use super::{Format, json_text};
use crate::argument::{Folder, InFile};
use crate::exit::{Failure, note, print};
use fspid_scenario::file::{self, Template};
use fspid_sim::SimError;
use fspid_study::certify::{self, Answer, Certification, CheckedFile, Effort};
use fspid_study::output;

/// Prove or refute that a self-tuning loop is stable while its gains move.
///
/// Three answers: proved (for every gain that the supervisor can produce, however fast gains move), refuted (gains that it
/// produces let the loop grow if they stand still, or in some order), or open. What is proved is re-checked in interval
/// arithmetic and written as a certificate, which `--check` verifies alone, and `--against` compares with what a scenario
/// flies. Exit code 0 if every loop is proved, or the certificate proves the flown loop stable; 1 if not.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid certify pitch.toml --out certificates\n  fspid certify --check certificates/fspid.certificate.json\n  fspid certify --check certificates/fspid.certificate.json --against pitch.toml"
)]
pub(crate) struct Arguments {
    /// The scenario file.
    #[arg(required_unless_present = "check")]
    file: Option<InFile>,
    /// Verify a certificate instead; nothing but this file is read.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["file", "controller", "out"])]
    check: Option<InFile>,
    /// Compare the certificate with what this scenario flies, field by field.
    #[arg(long, value_name = "SCENARIO", requires = "check")]
    against: Option<InFile>,
    /// Set a value first, e.g. `--set controller.FSPID.nominal.kp=2`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Certify only the controller with this name.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Certify as well, at once, all plants and actuators that the scenario's dispersions can draw.
    #[arg(long, conflicts_with = "check")]
    family: bool,
    /// Certify as well the nonlinear aircraft in a box around its trim, which the search makes as large as it can.
    #[arg(long, conflicts_with = "check")]
    nonlinear: bool,
    /// Write the certificates into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<Folder>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match (&arguments.check, &arguments.file) {
        (Some(path), _) => check(path, arguments),
        (None, Some(path)) => prove(path, arguments),
        (None, None) => Err(Failure::input("no scenario and no certificate")),
    }
}

fn prove(path: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let template = Template::load(path, &arguments.overrides).map_err(Failure::input)?;
    let study = template.study();
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    let only = arguments.controller.as_deref();
    leave_out(&study.scenario, only)?;
    let names: Vec<&str> =
        study.scenario.controllers.iter().map(|named| named.name.as_str()).collect();
    if let Some(name) = only.filter(|name| !names.contains(name)) {
        let known = file::known_words(name, &names);
        return Err(Failure::input(format_args!("there is no controller `{name}`{known}")));
    }
    let telling = Telling::for_standard_error();
    let certification = watched(&template, (only, arguments), telling);
    // The answer begins on an empty line.
    if telling == Telling::Line {
        tell(telling, "");
    }
    let certification = certification.map_err(Failure::input)?;
    if let Some(folder) = &arguments.out {
        write(&certification, folder)?;
    }
    match arguments.format {
        Format::Text => print(&certification.text())?,
        Format::Json => {
            let mut answer = certification.json();
            let left_out = study.scenario.externals.iter().map(|named| named.name.as_str());
            let left_out: Vec<&str> = left_out.filter(|_| only.is_none()).collect();
            if !left_out.is_empty() {
                answer["left_out"] = left_out.into();
            }
            print(&json_text(&answer))?;
        }
    }
    if certification.all_proved() {
        return Ok(());
    }
    Err(Failure::not_met("a loop is not proved stable"))
}

/// Certifies, and tells whom and for how long.
fn watched(
    template: &Template,
    (only, arguments): (Option<&str>, &Arguments),
    telling: Telling,
) -> Result<Certification, SimError> {
    let whom = Mutex::new(String::new());
    let what = || {
        let whom = whom.lock().map_or(String::new(), |name| name.clone());
        format!("certifying {whom}; a self-tuning controller can take half a minute")
    };
    alive(telling, &what, || {
        let effort = Effort::default();
        let mut tell = |name: &str| {
            if let Ok(mut whom) = whom.lock() {
                name.clone_into(&mut whom);
            }
        };
        let certification = Certification::watched(template.study(), only, &effort, &mut tell)?;
        let certification = match arguments.family {
            true => certification.with_families(template, &effort, &mut |name| {
                tell(&format!("all that can be drawn of {name}"));
            })?,
            false => certification,
        };
        Ok(match arguments.nonlinear {
            true => certification.with_nonlinear(template.study(), &effort, &mut |name| {
                tell(&format!("the nonlinear aircraft with {name}"));
            }),
            false => certification,
        })
    })
}

fn write(certification: &Certification, folder: &Path) -> Result<(), Failure> {
    output::make_folder(folder)?;
    let mut files = Vec::new();
    for certified in &certification.results {
        let Some(certificate) = certified.certificate() else { continue };
        certification.changed_name(certified).iter().for_each(note);
        let text = certify::to_text(certificate, &certified.origin);
        // What cannot be read again is not written: a number of the scenario is beyond all ranges.
        certify::from_text(&text).map_err(|refused| {
            let name = &certified.controller;
            Failure::input(format_args!("no certificate can be written of {name}:\n{refused}"))
        })?;
        files.push((folder.join(certification.file_name(certified)), text));
    }
    let whole: Vec<_> = files.iter().map(|(path, text)| (path.clone(), text.as_bytes())).collect();
    output::write_all(&whole)?;
    for (path, _) in files {
        note(format_args!("wrote {0}; verify it with `fspid certify --check {0}`", path.display()));
    }
    Ok(())
}

fn check(path: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let scenario = arguments.against.as_deref();
    if scenario.is_none() && !arguments.overrides.is_empty() {
        return Err(Failure::input(
            "--set changes a scenario: with --check it needs --against SCENARIO",
        ));
    }
    let mut checked = read(path)?;
    if let Some(scenario) = scenario {
        let template = Template::load(scenario, &arguments.overrides).map_err(Failure::input)?;
        checked.compare_family(&template).map_err(Failure::input)?;
    }
    match arguments.format {
        Format::Text => print(&checked.text())?,
        Format::Json => print(&json_text(&checked.json()))?,
    }
    if checked.holds() {
        return Ok(());
    }
    Err(Failure::not_met(format_args!("{}: {}", path.display(), unmet(checked.answer()))))
}

/// A certificate, checked; each problem of a text that is none stands behind the name of its file.
pub(super) fn read(path: &Path) -> Result<CheckedFile, Failure> {
    let text = file::read_text(path).map_err(Failure::input)?;
    certify::check_text(&text).map_err(|refused| {
        let located = |it: &certify::Wrong| format!("{}: {it}", path.display());
        let lines: Vec<String> = refused.problems.iter().map(located).collect();
        Failure::input(lines.join("\n"))
    })
}

/// Why a certificate does not do.
pub(super) fn unmet(answer: Answer) -> &'static str {
    match answer {
        Answer::Holds => "the certificate holds",
        Answer::Refutes(_) => "the certificate refutes, it proves no stability",
        Answer::SaysNothing(_) => "the certificate says nothing of the flown loop",
        Answer::NotProved => "the certificate does not hold",
        Answer::Edited => "the certificate was changed after it was written",
        Answer::AnotherLoop => "the certificate is about another loop than the scenario flies",
    }
}
