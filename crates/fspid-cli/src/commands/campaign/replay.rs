//! `fspid campaign replay`: one run again, with its trace.

use clap::Args;

use super::super::{Format, json_text};
use super::{failure, planned};
use crate::argument::{self, OutFile, written};
use crate::exit::{Failure, note, print};
use fspid_campaign::{Folder, replay};
use fspid_study::{output, report};

/// Fly one run of a campaign again, bit for bit, and write its trace.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The campaign's folder.
    folder: argument::Folder,
    /// Number of the run, from 0.
    #[arg(long)]
    run: u64,
    /// Write the traces of all controllers to this CSV file.
    #[arg(value_parser = written(&["csv"]), long, value_name = "OUT.csv")]
    trace: Option<OutFile>,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = Folder::new(&arguments.folder);
    folder.keep_apart().map_err(failure)?;
    let campaign = planned(&folder)?;
    let replay = replay::replay(&campaign, arguments.run).map_err(failure)?;
    if let Some(path) = &arguments.trace {
        replay.simulation.column_names().changed().for_each(note);
        output::write(path, replay.simulation.csv())?;
    }
    if let Some(path) = &arguments.report {
        output::write(path, report::of_simulation(&replay.study, &replay.simulation))?;
    }
    match arguments.format {
        Format::Text => print(&replay.text(&campaign)),
        Format::Json => print(&json_text(&replay.json(&campaign))),
    }
}
