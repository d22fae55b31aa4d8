//! `fspid export`: a controller, or a fuzzy system, in another language.

mod folders;
mod system;

use std::path::Path;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::external_controller::leave_out;
use super::{Format, json_text};
use crate::argument::{Folder, InFile, count};
use crate::exit::{Failure, note, print};
use fspid_export::program::Precision;
use fspid_export::table::is_sampled;
use fspid_export::{Angles, Export, File, Target, prefix};
use fspid_scenario::count as counts;
use fspid_scenario::file;
use fspid_scenario::fuzzy_system;
use fspid_study::export::{Question, chosen, export};

/// Write a controller or a fuzzy system in another language: the same bits as the simulator, with vectors that show it.
///
/// The folder holds the code, `vectors.csv` with drawn samples, good and bad ones, and their answers, and a program that asks
/// the code for the answers and counts those with other bits. A loop that is not known to be stable is told; whether it is good
/// `verify` and `certify` say.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid export pitch.toml --controller FSPID --to c --out flight\n  fspid export tip.toml --to c --out tip\n  cc -std=c99 -O2 -ffp-contract=off flight/*.c -o check && ./check"
)]
pub(crate) struct Arguments {
    /// The scenario or design, or a fuzzy system (.toml, .fis, .fcl, .fll, .xml), which c, lua, st, fmu2 and fmu3 can say.
    file: InFile,
    /// The controller; may be left out where there is only one.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// The language: c (C99, freestanding), lua (5.3), st (Structured Text), rust (a constant of fspid-core), matlab (a
    /// function and a .fis), simulink (an S-function), table (the supervisor alone, in C and CSV), fmu2 or fmu3 (functional
    /// mock-up units for co-simulation).
    #[arg(long, value_name = "TARGET", value_parser = target)]
    to: Target,
    /// The folder to write into; a new or an empty one.
    #[arg(long, value_name = "DIR")]
    out: Folder,
    /// Write into a folder that holds something, over files of the same names.
    #[arg(long)]
    force: bool,
    /// What names in the code and of files begin with; made of the name of what is exported if left out.
    #[arg(long, value_name = "NAME", value_parser = own_prefix)]
    prefix: Option<String>,
    /// The digits of the numbers; double for fmu2, fmu3 and fuzzy systems if left out, else single.
    #[arg(long, value_enum)]
    numbers: Option<Numbers>,
    /// The unit of the angles that go in and come out.
    #[arg(long, value_enum, default_value_t = Unit::Radians)]
    angles: Unit,
    /// How many samples the vectors have.
    #[arg(long, value_name = "N", default_value_t = Question::SAMPLES, value_parser = count::<u32>(&counts::SAMPLES))]
    samples: u32,
    /// How many points a table has along each input: 6m + 1, so that the centres of the sets are among them; 49 if left
    /// out.
    #[arg(long, value_name = "N", value_parser = count::<usize>(&counts::TABLE_POINTS))]
    points: Option<usize>,
    /// Write data for a review into this folder: traces, changes that the vectors find, what a proof is asked, and a
    /// script that makes the rest; for c, takes a minute, or several where rules conclude labels.
    #[arg(long, value_name = "DIR")]
    evidence: Option<Folder>,
    /// How integrals of a fuzzy system are computed: `exact`, `endpoints:N`, `midpoint:N`, `trapezoid:N` or `left-end:N`; as
    /// its file says if left out.
    #[arg(long, value_name = "RULE")]
    defuzzifier: Option<String>,
    /// Set a value first, e.g. `--set controller.FSPID.nominal.kp=2`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// How it is told what was written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Numbers {
    /// 32 bits.
    Single,
    /// 64 bits, as the simulator has them.
    Double,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Unit {
    Radians,
    Degrees,
}

/// What takes a target under another name.
const TAKEN: [(&str, &str); 5] = [
    ("px4", "PX4 takes the C of `--to c` (docs/guide/export-px4.md)"),
    (
        "ardupilot",
        "ArduPilot takes a script, `--to lua`, or the C of `--to c` (docs/guide/export-ardupilot.md)",
    ),
    ("c++", "C++ takes the C of `--to c`"),
    ("cpp", "C++ takes the C of `--to c`"),
    ("fmu", "functional mock-up units are `--to fmu2` and `--to fmu3`"),
];

/// The target of that name.
fn target(name: &str) -> Result<Target, String> {
    Target::ALL.into_iter().find(|target| target.name() == name).ok_or_else(|| {
        let lower = name.to_lowercase();
        if let Some((_, told)) = TAKEN.iter().find(|(other, _)| *other == lower) {
            return format!("unknown target; {told}");
        }
        let known = Target::ALL.map(Target::name);
        format!("unknown target{}", file::known_words(name, &known))
    })
}

/// A prefix that may be given.
fn own_prefix(text: &str) -> Result<String, String> {
    let possible = prefix(text);
    match possible == text {
        true => Ok(possible),
        false => Err(format!(
            "allowed are lower-case letters, digits and `_`, and no word that files have; `{possible}` is"
        )),
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if fuzzy_system::is_system(&arguments.file) {
        return system::run(arguments);
    }
    if arguments.defuzzifier.is_some() {
        return Err(Failure::input(
            "--defuzzifier goes with a fuzzy system; a controller says its own",
        ));
    }
    let study = file::load(&arguments.file, &arguments.overrides).map_err(Failure::load)?;
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    leave_out(&study.scenario, arguments.controller.as_deref())?;
    let named = chosen(&study, arguments.controller.as_deref()).map_err(Failure::input)?;
    let asked = Question {
        controller: Some(&named.name),
        target: arguments.to,
        precision: match arguments.numbers {
            Some(Numbers::Single) => Some(Precision::Single),
            Some(Numbers::Double) => Some(Precision::Double),
            None => None,
        },
        angles: match arguments.angles {
            Unit::Radians => Angles::Radians,
            Unit::Degrees => Angles::Degrees,
        },
        samples: arguments.samples as usize,
        points: points(arguments)?,
        prefix: arguments.prefix.as_deref(),
        evidence: evidence(arguments)?,
    };
    folders::check(arguments)?;
    if asked.target == Target::Table && is_sampled(&named.controller) {
        note(
            "the bound of a table with a sampled centre of gravity is proved in minutes, not seconds",
        );
    }
    let exported = export(&study, &asked).map_err(Failure::input)?;
    answer(arguments, ["controller", &named.name], &exported)
}

/// Writes the files and tells them; `what` is what was exported, and its name.
fn answer(arguments: &Arguments, what: [&str; 2], exported: &Export) -> Result<(), Failure> {
    folders::write(arguments, exported)?;
    match arguments.format {
        Format::Text => {
            exported.notes.iter().for_each(|it| note(format_args!("{it}")));
            let evidence = arguments.evidence.as_ref().map(|it| told(&exported.evidence, it));
            print(&(told(&exported.files, &arguments.out) + &evidence.unwrap_or_default()))
        }
        Format::Json => print(&json_text(&json!({
            "schema": 1,
            what[0]: what[1],
            "target": arguments.to.name(),
            "prefix": exported.prefix,
            "folder": arguments.out.display().to_string(),
            "files": exported.files.iter().map(|it| &it.name).collect::<Vec<_>>(),
            "evidence": exported.evidence.iter().map(|it| &it.name).collect::<Vec<_>>(),
            "notes": exported.notes,
        }))),
    }
}

/// The file's name without its ending.
fn file_stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "system".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The points of a table along an input; a table has no other digits and no other unit.
fn points(arguments: &Arguments) -> Result<usize, Failure> {
    let is_table = arguments.to == Target::Table;
    if is_table && matches!(arguments.numbers, Some(Numbers::Double)) {
        return Err(Failure::input("--numbers double: a table has numbers of 32 and 16 bits"));
    }
    if is_table && matches!(arguments.angles, Unit::Degrees) {
        return Err(Failure::input(
            "--angles degrees: a table has the supervisor's own units, which are no angles",
        ));
    }
    match arguments.points {
        Some(_) if arguments.to != Target::Table => {
            let to = arguments.to.name();
            Err(Failure::input(format_args!("--points goes with --to table; {to} has no table")))
        }
        given => Ok(given.unwrap_or(fspid_export::table::POINTS)),
    }
}

/// If evidence is asked for, of a target that has some.
fn evidence(arguments: &Arguments) -> Result<bool, Failure> {
    if arguments.evidence.is_some() && arguments.to != Target::C {
        let to = arguments.to.name();
        return Err(Failure::input(format_args!("{to} has no evidence; --to c has")));
    }
    Ok(arguments.evidence.is_some())
}

fn told(files: &[File], folder: &Path) -> String {
    let line = |name: &String| format!("{}\n", folder.join(name).display());
    files.iter().map(|file| line(&file.name)).collect()
}
