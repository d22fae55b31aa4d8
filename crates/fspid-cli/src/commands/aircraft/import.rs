//! `fspid aircraft import`: a flight model in DAVE-ML.

use clap::Args;

use super::super::{Format, json_text};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_study::aircraft::import;
use fspid_study::output;

/// Read a flight model in DAVE-ML, run its check cases, and write it as TOML if asked for.
///
/// Problems are told with line and column, all at once. A model that fails a check case is not written.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The model: a DAVE-ML file, or a .toml file that was written from one.
    #[arg(value_name = "FILE.dml")]
    file: InFile,
    /// Write the model to this file.
    #[arg(value_parser = written(&["toml"]), long, value_name = "OUT.toml")]
    out: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let imported = import(&arguments.file).map_err(Failure::input)?;
    for found in imported.notes() {
        note(format_args!("note: {found}"));
    }
    if let Some(path) = &arguments.out {
        output::write(path, imported.toml())?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&imported.text()),
        Format::Json => print(&json_text(&imported.json())),
    }
}
