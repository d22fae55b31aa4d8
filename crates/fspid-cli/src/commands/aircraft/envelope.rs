//! `fspid aircraft envelope`: an aircraft over speeds and altitudes.

use clap::Args;

use super::super::{Format, drawings, json_text};
use super::qualities::Category;
use super::{Answer, Plane};
use crate::argument::{Drawings, InFile, OutFile, is_standard, written};
use crate::exit::{Failure, print, wrote};
use fspid_study::aircraft::{EnvelopeQuestion, envelope};
use fspid_study::output;

/// Trim and linearise an aircraft at every speed and altitude of a grid.
///
/// The summary goes to standard output. --csv has every point, and why one cannot be flown; --svg draws a map of each
/// quantity. With --scenario, the sampled loop of its controller, with the gains that its schedule makes there, is judged at
/// every point as `fspid analyse` judges it, at rest and with nothing commanded: stable, unstable, or undecided and why,
/// with the ages of what sensors show as they come. The aircraft, loading and air are those asked for, not the scenario's.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    plane: Plane,
    /// True airspeeds, such as 35:80:10 or 120:260ft/s:8.
    #[arg(long, value_name = "FIRST:LAST:COUNT")]
    speeds: String,
    /// Altitudes, such as 0:4000:5 or 0:15000ft:4.
    #[arg(long, value_name = "FIRST:LAST:COUNT", allow_hyphen_values = true)]
    altitudes: String,
    /// For what flying qualities are judged.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Category::B)]
    category: Category,
    /// A scenario with the autopilot: its servo, sensors, sample period, controller, leveller and damper.
    #[arg(long, value_name = "FILE.toml")]
    scenario: Option<InFile>,
    /// The controller of the scenario, if it has several.
    #[arg(long, value_name = "NAME", requires = "scenario")]
    controller: Option<String>,
    /// Write every point to this file; `-` is standard output, in place of the summary.
    #[arg(value_parser = written(&["csv"]), long, value_name = "OUT.csv")]
    csv: Option<OutFile>,
    /// Draw a map of each quantity into this folder.
    #[arg(long, value_name = "FOLDER")]
    svg: Option<Drawings>,
    #[command(flatten)]
    answer: Answer,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let question = EnvelopeQuestion {
        question: arguments.plane.question(answer.units()),
        speeds: &arguments.speeds,
        altitudes: &arguments.altitudes,
        category: arguments.category.into(),
        scenario: arguments.scenario.as_deref(),
        controller: arguments.controller.as_deref(),
    };
    let envelope = envelope(&question).map_err(Failure::input)?;
    if let Some(path) = &arguments.svg {
        let figures = envelope.figures();
        drawings::write(path, figures.iter().map(|(name, svg)| (*name, svg.as_str())).collect())?;
    }
    match (&arguments.csv, answer.format) {
        // In place of the summary.
        (Some(path), _) if is_standard(path) => return Ok(output::write(path, envelope.csv())?),
        (Some(path), _) => {
            output::write(path, envelope.csv())?;
            wrote(path);
        }
        (None, _) => {}
    }
    match answer.format {
        Format::Text => print(&envelope.text()),
        Format::Json => print(&json_text(&envelope.json())),
    }
}
