//! `fspid analyse`: margins of the sampled loop.

use clap::{Args, ValueEnum};

use super::external_controller::{Beside, leave_out};
use super::progress::at_work;
use super::{Format, json_text};
use crate::argument::{InFile, OutFile, count, written};
use crate::exit::{Failure, print, wrote};
use fspid_scenario::count as counts;
use fspid_study::analysis::{Analysis, BreakPoint, Question, Stability};
use fspid_study::{output, report};

/// Analyse the sampled loop of each controller: margins, poles, sensitivity, and every gain that a self-tuning
/// controller can have.
///
/// The loop is that of the flight around rest: exact zero-order hold, actuator, delays, sensors' delays, the controller as it is
/// implemented. An unstable loop has no margins. Exit code 1 if any loop is unstable.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: InFile,
    /// Set a value first, e.g. `--set controller.PID.kp=2`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// Where the loop is broken; the others stay closed.
    #[arg(long, value_enum, default_value_t = Point::Command)]
    broken_at: Point,
    /// Points along each input of the frozen-gain map; 0 for no map.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = count::<u16>(&counts::MAP_POINTS))]
    map: u16,
    /// Fly as well: how much gain, delay and lag the flight bears with all its limits, limit cycles, and what small
    /// disturbances do along the way. Takes seconds, and proves nothing.
    #[arg(long)]
    fly: bool,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Where a loop is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Point {
    /// At the controller's command: every loop passes through here.
    Command,
    /// At the pitch angle that the controller sees; a rate loop stays closed.
    Pitch,
    /// At the pitch rate that the controller sees; the pitch loop stays closed.
    Rate,
}

impl From<Point> for BreakPoint {
    fn from(point: Point) -> Self {
        match point {
            Point::Command => Self::Command,
            Point::Pitch => Self::Pitch,
            Point::Rate => Self::Rate,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.beside.study(&arguments.file, &arguments.overrides)?;
    if study.scenario.controllers.is_empty() && !arguments.fly {
        leave_out(&study.scenario, None)?;
    }
    let question = Question {
        point: arguments.broken_at.into(),
        map_points: usize::from(arguments.map),
        fly: arguments.fly,
        ..Question::default()
    };
    let analysis = at_work("analysing", || Analysis::of(&study, question));
    let analysis = analysis.map_err(Failure::input)?;
    if let Some(path) = &arguments.report {
        output::write(path, report::of_analysis(&study, &analysis).map_err(Failure::input)?)?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&analysis.text())?,
        Format::Json => print(&json_text(&analysis.json()))?,
    }
    if analysis.all_held() {
        return Ok(());
    }
    let reason = match analysis.stability() {
        Stability::Stable => "a loop has no margins",
        Stability::Unstable => "a loop is not stable",
        Stability::Undecided => "a loop is undecided",
    };
    Err(Failure::not_met(reason))
}
