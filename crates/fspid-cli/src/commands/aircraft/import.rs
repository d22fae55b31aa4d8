//! `fspid aircraft import`: a flight model in DAVE-ML.

use std::path::PathBuf;

use clap::Args;

use super::super::{Format, json_text};
use crate::exit::{Failure, note, print};
use fspid_study::aircraft::import;
use fspid_study::output;

/// Read a flight model in DAVE-ML, run its check cases, and write it as TOML if asked for.
///
/// Problems are told with line and column, all at once. A model that fails a check case is not written.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The model: a DAVE-ML file, or a .toml file that was written from one.
    #[arg(value_name = "FILE.dml")]
    file: PathBuf,
    /// Write the model to this file.
    #[arg(long, value_name = "OUT.toml")]
    out: Option<PathBuf>,
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
        note(format_args!("wrote {}", path.display()));
    }
    match arguments.format {
        Format::Text => print(&imported.text()),
        Format::Json => print(&json_text(&imported.json())),
    }
}
