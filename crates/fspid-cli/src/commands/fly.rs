//! `fspid fly`: a scenario's controller over standard input and output.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::io::{self, IsTerminal as _};

use super::Format;
use super::external_controller::Beside;
use crate::argument::NamedFile;
use crate::exit::{Failure, note, stream};
use fspid_study::fly::{self, Pilot, StreamError, Summary};

/// Let a controller of a scenario fly whatever is at the other end of standard input and output.
///
/// Each line in is a sample: set-point, measured pitch, seconds since the sample before, and the
/// pitch rate if there is one, between blanks or between commas. Each gets one line out, at once:
/// the elevator command, nose up positive. `reset` starts a new flight and is answered `ok`. Empty
/// lines and lines that begin with # are passed over and get no answer.
///
/// A line that cannot be used is answered too: the last command is held, and standard error says
/// why. The controller computes with its own period; samples that say otherwise are counted. The
/// end of the input is the end.
///
/// A library or an FMU flies in a process of its own. If it crashes, hangs or answers NaN, standard
/// error says so with the time of the sample, its last command is held until a `reset`, and the
/// exit code is 1.
#[derive(Debug, Args)]
#[command(
    after_help = "In degrees:   5 4.2 0.01 0.8   is set-point 5 deg, pitch 4.2 deg, 0.01 s, 0.8 deg/s.\nA simulator in Python to begin with: examples/fly/aircraft.py"
)]
pub(crate) struct Arguments {
    /// The scenario file; its aircraft, servo and disturbances are not used. It has to have a name, since samples come on
    /// standard input.
    file: NamedFile,
    /// Which controller flies, if there are several; without it the only one of `--library` and `--fmu` does.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Set a value before flying, e.g. `--set loop.sample_period_s=0.02`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// The unit of all angles, in and out.
    #[arg(long, value_enum, default_value_t = Angles::Degrees)]
    angles: Angles,
    /// End with code 1 if a sample was held, late, early or at fault.
    #[arg(long)]
    strict: bool,
    /// How the summary at the end is written: words if something was wrong, or JSON in any case, on standard error;
    /// standard output holds the commands.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A unit of angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Angles {
    /// Degrees and degrees per second.
    Degrees,
    /// Radians and radians per second; the same bits as in `simulate`.
    Radians,
}

impl From<Angles> for fly::Angles {
    fn from(angles: Angles) -> Self {
        match angles {
            Angles::Degrees => Self::Degrees,
            Angles::Radians => Self::Radians,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut pilot = pilot(arguments)?;
    // Standard output holds commands from here on, and no answer of another kind.
    stream();
    if io::stdin().is_terminal() {
        let period_s = pilot.period_s();
        note(format_args!("set-point, measured pitch, {period_s:?} and pitch rate, please:"));
    }
    let (mut input, mut output) = (io::stdin().lock(), io::stdout().lock());
    let done = fly::fly(&mut pilot, &mut input, &mut output, |text| note(text));
    finish(&pilot, arguments, done)
}

fn summary_json(summary: &Summary, is_external: bool) -> Value {
    let mut found = json!({
        "schema": 1, "commands": summary.commands, "slips": summary.slips, "held": summary.held,
        "other_faults": summary.faults, "resets": summary.resets,
    });
    if is_external {
        found["controller_lost"] = summary.lost.into();
    }
    found
}

fn pilot(arguments: &Arguments) -> Result<Pilot, Failure> {
    let study = arguments.beside.study(&arguments.file, &arguments.overrides)?;
    let name = arguments.controller.clone().or_else(|| arguments.beside.only());
    Pilot::new(&study.scenario, name.as_deref(), arguments.angles.into())
        .map_err(|problem| Failure::input(format_args!("{}: {problem}", arguments.file.display())))
}

/// A simulator that has gone away is as good an end as one that closes its side.
fn finish(
    pilot: &Pilot,
    arguments: &Arguments,
    done: Result<(), StreamError>,
) -> Result<(), Failure> {
    let summary = pilot.summary();
    match arguments.format {
        Format::Json => note(summary_json(&summary, pilot.is_external())),
        Format::Text if !summary.is_clean() => note(summary),
        Format::Text => {}
    }
    match done {
        Ok(()) => {}
        Err(StreamError::Writing(error)) => Failure::of_writing(&error)?,
        Err(StreamError::Reading(error)) => {
            return Err(Failure::input(format_args!("standard input cannot be read: {error}")));
        }
    }
    if summary.lost > 0 {
        return Err(Failure::not_met("the controller was lost"));
    }
    match arguments.strict && !summary.is_clean() {
        true => Err(Failure::not_met("not every sample came in time and could be used")),
        false => Ok(()),
    }
}
