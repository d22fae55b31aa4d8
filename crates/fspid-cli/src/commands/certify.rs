//! `fspid certify`: stability while the gains move.

use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::external_controller::leave_out;
use super::progress::{Telling, alive, tell};
use super::{Format, json_text};
use crate::argument::{Folder, InFile, OutFile, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_certify::{
    Answer, Cases, CertificateFile, Certification, CertifiedCases, CheckedFile, Effort,
    NotWritable, Question, Subject, Wrong, check_text,
};
use fspid_diagnostics::lines;
use fspid_scenario::file::{self, Problems, Study, Template};
use fspid_study::{output, shell};
use fspid_tune::problems_of_certified;

/// Longest line on a terminal, characters.
const WIDTH: usize = 100;

/// Prove or refute that a self-tuning loop is stable while its gains move.
///
/// Three answers: proved (for every gain that the supervisor can produce, however fast gains move), refuted (gains that it
/// produces let the loop grow if they stand still, or in some order), or open. What is proved is re-checked in interval
/// arithmetic and written as a certificate, which `--check` verifies alone, and `--against` compares with what a scenario
/// flies. Exit code 0 if every loop is proved, or the certificate proves the flown loop stable; 1 if not.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid certify pitch.toml --out certificates\n  fspid certify --check certificates/fspid.certificate.json\n  fspid certify --check certificates/fspid.certificate.json --against pitch.toml\n  fspid certify pitch.toml --out certificates --report proof.html\n  fspid certify design.toml --cases tuning"
)]
pub(crate) struct Arguments {
    /// The scenario file.
    #[arg(required_unless_present_any = ["check", "against"])]
    file: Option<InFile>,
    /// Verify a certificate instead; nothing but this file is read.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["controller", "out"])]
    check: Option<InFile>,
    /// Compare the certificate with what this scenario flies, field by field.
    #[arg(long, value_name = "SCENARIO")]
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
    /// Certify each case of a table in place of the scenario as it is: those it is tuned on, those its contest judges by, or
    /// every combination of what its dispersions choose among (other aircraft, other delays). What `--set` gives holds in
    /// every case.
    #[arg(long, value_parser = cases(), value_name = "TABLE", conflicts_with = "check")]
    cases: Option<Cases>,
    /// Bound as well, from rest, what gusts and disturbances at the elevator do to pitch angle and command; with `--cases` in
    /// each case, and in all of them together.
    #[arg(long, conflicts_with = "check")]
    disturbances: bool,
    /// With `--cases`: fly in sets what each case commands, and the steps of self-tuners that remember, as is done without
    /// `--cases`. It takes a minute or two for each case.
    #[arg(long, requires = "cases")]
    steps: bool,
    /// Certify as well the nonlinear aircraft in a box around its trim, which the search makes as large as it can; with
    /// `--cases` in each case, and in all of them together.
    #[arg(long, conflicts_with = "check")]
    nonlinear: bool,
    /// Write the certificates into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<Folder>,
    /// Write a report that opens offline in a browser: the verdict on each loop, what its claim holds for, what is not in it,
    /// and how its certificate is checked; with `--cases` a section for each case.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html", conflicts_with = "check")]
    report: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Reads which cases of a scenario are asked for.
fn cases() -> impl TypedValueParser<Value = Cases> {
    let named = |cases: Cases| PossibleValue::new(cases.name()).help(cases.words());
    PossibleValuesParser::new(Cases::ALL.map(named)).try_map(|name| Cases::named(&name))
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.check.is_none() && arguments.against.is_some() {
        return Err(Failure::usage("`--against` needs `--check CERTIFICATE`"));
    }
    match (&arguments.check, &arguments.file) {
        (Some(_), Some(scenario)) => Err(Failure::input(format_args!(
            "--check reads the certificate alone; `--against {}` compares it with what that scenario flies",
            shell::word(&scenario.display().to_string())
        ))),
        (Some(path), None) => check(path, arguments),
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
    if arguments.family {
        // A dispersion that draws nothing of the scenario is a mistake, and no answer about a family.
        let wrong = |it: Problems| Failure::of_input(&it, Some(it.to_json()));
        template.check_paths_of_dispersions().map_err(wrong)?;
    }
    let telling = Telling::for_standard_error();
    if let Some(which) = arguments.cases {
        return prove_cases(path, &template, which, arguments);
    }
    let effort = Effort::default();
    let certification = certifying(telling, |tell| {
        Certification::answering(&template, question(arguments, &effort), tell)
    });
    // The answer begins on an empty line.
    if telling == Telling::Line {
        tell(telling, "");
    }
    let certification = certification.map_err(Failure::input)?;
    if let Some(folder) = &arguments.out {
        certification.changed_names().iter().for_each(note);
        write(folder, certification.certificate_files())?;
    }
    if let Some(path) = &arguments.report {
        let page = certification.page(subject(study, arguments, &effort));
        write_report(path, page)?;
    }
    let answer = || (certification.text(), certification.json());
    told(answer, study, arguments)?;
    met(certification.all_proved())
}

/// Prints an answer about a scenario, with who is left out of it.
fn told(
    answer: impl Fn() -> (String, serde_json::Value),
    study: &Study,
    arguments: &Arguments,
) -> Result<(), Failure> {
    let (text, mut answer) = answer();
    match arguments.format {
        Format::Text => print_folded(&text),
        Format::Json => {
            let left_out = study.scenario.externals.iter().map(|named| named.name.as_str());
            let left_out: Vec<&str> = left_out.filter(|_| arguments.controller.is_none()).collect();
            if !left_out.is_empty() {
                answer["left_out"] = left_out.into();
            }
            print(&json_text(&answer))
        }
    }
}

/// Prints sentences: on a terminal in lines that are read at once, into a file or a program as they are.
fn print_folded(text: &str) -> Result<(), Failure> {
    if io::stdout().is_terminal() { print(&lines::folded(text, WIDTH)) } else { print(text) }
}

fn met(all_proved: bool) -> Result<(), Failure> {
    match all_proved {
        true => Ok(()),
        false => Err(Failure::not_met("not everything that was asked is proved of every loop")),
    }
}

/// Certifies a scenario as each of several changes makes it.
fn prove_cases(
    path: &Path,
    template: &Template,
    which: Cases,
    arguments: &Arguments,
) -> Result<(), Failure> {
    let study = template.study();
    let effort = Effort { long_flights: arguments.steps, ..Effort::default() };
    let source = (path, arguments.overrides.as_slice());
    let telling = Telling::for_standard_error();
    let cases = certifying(telling, |tell| {
        CertifiedCases::answering(source, study, which, question(arguments, &effort), tell)
    });
    if telling == Telling::Line {
        tell(telling, "");
    }
    let cases = cases.map_err(|error| Failure::of_input(&error, problems_of_certified(&error)))?;
    if let Some(folder) = &arguments.out {
        cases.changed_names().iter().for_each(note);
        write(folder, cases.certificate_files())?;
    }
    if let Some(path) = &arguments.report {
        write_report(path, cases.page(subject(study, arguments, &effort)))?;
    }
    told(|| (cases.text(), cases.json()), study, arguments)?;
    met(cases.all_proved())
}

/// What is asked of the scenario, or of each of its cases.
fn question<'a>(arguments: &'a Arguments, effort: &'a Effort) -> Question<'a> {
    let only = arguments.controller.as_deref();
    let Arguments { disturbances, family, nonlinear, .. } = *arguments;
    Question { only, disturbances, family, nonlinear, effort }
}

/// What a page is about.
fn subject<'a>(study: &'a Study, arguments: &'a Arguments, effort: &'a Effort) -> Subject<'a> {
    let folder = arguments.out.as_deref().and_then(Path::to_str);
    Subject { study, question: question(arguments, effort), folder }
}

fn write_report(path: &Path, page: Result<String, NotWritable>) -> Result<(), Failure> {
    output::write(path, page.map_err(Failure::input)?)?;
    wrote(path);
    Ok(())
}

/// Does some work, and tells meanwhile whom it is about and for how long.
fn certifying<T>(telling: Telling, work: impl FnOnce(&mut dyn FnMut(&str)) -> T) -> T {
    let whom = Mutex::new(String::new());
    let what = || {
        let whom = whom.lock().map_or(String::new(), |name| name.clone());
        format!(
            "certifying {whom}; a self-tuning controller can take a minute, and one that stays open two"
        )
    };
    alive(telling, &what, || {
        work(&mut |name: &str| {
            if let Ok(mut whom) = whom.lock() {
                name.clone_into(&mut whom);
            }
        })
    })
}

/// Writes certificates into a folder, all of them or none.
fn write(folder: &Path, files: Result<Vec<CertificateFile>, NotWritable>) -> Result<(), Failure> {
    let files = files.map_err(Failure::input)?;
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(&file.name)).collect();
    output::make_folder(folder)?;
    paths.iter().filter_map(|path| path.parent()).try_for_each(output::make_folder)?;
    let texts = files.iter().map(|file| file.text.as_bytes());
    let whole: Vec<(PathBuf, &[u8])> = paths.iter().cloned().zip(texts).collect();
    output::write_all(&whole)?;
    for path in paths {
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
        Format::Text => print_folded(&checked.text())?,
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
    check_text(&text).map_err(|refused| {
        let located = |it: &Wrong| format!("{}: {it}", path.display());
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
