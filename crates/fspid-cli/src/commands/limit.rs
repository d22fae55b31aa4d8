//! `fspid limit`: how good could any controller be.

use std::sync::Mutex;

use clap::{Args, ValueEnum};

use super::external_controller::Beside;
use super::progress::{Telling, alive, tell};
use super::{Format, interrupt, json_text};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, print, wrote};
use fspid_scenario::file::Study;
use fspid_study::output;
use fspid_tune::limit::{Answer, Ladder, LimitError, Measure, Options, Travel};

/// How good could any controller be: the least error that any commands reach within a given elevator travel.
///
/// For the flight's linear plant, actuator, delay, limits and disturbances, a linear programme over all samples finds the
/// best commands of somebody who knows the flight before it begins. That nobody gets below is proved in interval arithmetic;
/// that somebody gets there is flown. Every controller of the scenario stands beside the limit at its own travel.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid limit pitch.toml\n  fspid limit pitch.toml --travel-deg 8,10,15,20,30 --report limit.html\n  fspid limit approach.toml --set aircraft.model=linear --measure peak --causal"
)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: InFile,
    /// Set a value first, e.g. `--set loop.sample_period_s=0.05`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// What of the error is made small.
    #[arg(long, value_enum, default_value_t = Asked::Iae)]
    measure: Asked,
    /// Travels, deg, with commas between; by default a ladder around those of the scenario's controllers.
    #[arg(long, value_name = "DEG,…", value_delimiter = ',', value_parser = travel)]
    travel_deg: Vec<f64>,
    /// Whose way counts as travel.
    #[arg(long, value_enum, default_value_t = Counted::Elevator)]
    travel_of: Counted,
    /// Let commands move before anything has happened, by who knows what will; by default they are as still as those of the
    /// scenario's controllers until then.
    #[arg(long)]
    anticipate: bool,
    /// Tell as well what was reached within each travel without knowledge of the future. Takes many times as long.
    #[arg(long)]
    causal: bool,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
    /// Say nothing of the progress.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Measures of the error over the whole flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Asked {
    /// Integral of the absolute error.
    Iae,
    /// Integral of the squared error.
    Ise,
    /// Largest error.
    Peak,
}

impl From<Asked> for Measure {
    fn from(asked: Asked) -> Self {
        match asked {
            Asked::Iae => Self::Iae,
            Asked::Ise => Self::Ise,
            Asked::Peak => Self::Peak,
        }
    }
}

/// Whose way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Counted {
    /// The elevator's, as campaigns, tunings and contests count it.
    Elevator,
    /// The command's, as reports count it: without the jump at the first sample.
    Command,
    /// The command's from zero, with that jump.
    CommandFromRest,
}

impl From<Counted> for Travel {
    fn from(counted: Counted) -> Self {
        match counted {
            Counted::Elevator => Self::Elevator,
            Counted::Command => Self::Command,
            Counted::CommandFromRest => Self::CommandFromRest,
        }
    }
}

/// A travel that makes sense, deg.
fn travel(text: &str) -> Result<f64, String> {
    let allowed = "a travel is a number of degrees above 0 and at most 1e6";
    let value: f64 = text.trim().parse().map_err(|_| allowed.to_owned())?;
    if value > 0.0 && value <= 1e6 { Ok(value) } else { Err(allowed.to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.beside.study(&arguments.file, &arguments.overrides)?;
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let answer = watched(&study, arguments, telling).map_err(failure)?;
    if let Some(path) = &arguments.report {
        output::write(path, answer.page(&interrupt::command()))?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&answer.text()),
        Format::Json => print(&json_text(&answer.json())),
    }
}

/// Asks, and tells how far it is.
fn watched(study: &Study, arguments: &Arguments, telling: Telling) -> Result<Answer, LimitError> {
    let options = Options {
        measure: arguments.measure.into(),
        travel: arguments.travel_of.into(),
        ladder: match arguments.travel_deg.is_empty() {
            true => Ladder::Around,
            false => Ladder::Given(arguments.travel_deg.clone()),
        },
        anticipate: arguments.anticipate,
        causal: arguments.causal,
    };
    told(telling, |told| Answer::of(study, options, told, interrupt::asked))
}

/// Works at limits that tell where they are, and tells it on.
pub(super) fn told<T>(telling: Telling, work: impl FnOnce(&dyn Fn(&str)) -> T) -> T {
    interrupt::watch();
    let at = Mutex::new("asking for the limit".to_owned());
    let what = || at.lock().map_or(String::new(), |at| at.clone());
    let told = |now: &str| {
        if let Ok(mut at) = at.lock() {
            now.clone_into(&mut at);
        }
    };
    let answer = match telling {
        Telling::Nothing => work(&told),
        Telling::Line | Telling::Lines => alive(telling, &what, || work(&told)),
    };
    // The answer begins on an empty line.
    if telling == Telling::Line {
        tell(telling, "");
    }
    answer
}

pub(super) fn failure(error: LimitError) -> Failure {
    match error {
        LimitError::Stopped => Failure::interrupted("interrupted"),
        other => Failure::input(other),
    }
}
