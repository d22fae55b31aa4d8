//! `fspid aircraft import`: a flight model in DAVE-ML, or the linear model of an aircraft in another simulator.

use clap::Args;

use super::super::progress::at_work;
use super::super::{Format, json_text};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::file;
use fspid_study::aircraft::{import, import_simulator};
use fspid_study::output;

/// Read a flight model in DAVE-ML, or ask another simulator for the linear model of its aircraft, and write it as TOML if
/// asked for.
///
/// A model in DAVE-ML is held against its own check cases; problems are told with line and column, all at once, and a model
/// that fails a check case is not written. Of a scenario with `[simulator]` the linear model at its condition is found by
/// differences, and held against the simulator's own.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The model: a DAVE-ML file, or a .toml file that was written from one; or a scenario with `[simulator]`.
    #[arg(value_name = "FILE.dml")]
    file: InFile,
    /// Set a value of the scenario first, e.g. `--set simulator.mach=0.7`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Write the model to this file.
    #[arg(value_parser = written(&["toml"]), long, value_name = "OUT.toml")]
    out: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let text = file::read_text(&arguments.file);
    if text.is_ok_and(|text| flies_a_simulator(&text)) {
        return of_simulator(arguments);
    }
    if !arguments.overrides.is_empty() {
        return Err(Failure::input("--set goes with a scenario that has [simulator]"));
    }
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

/// True for a text with a table of that name: a model of DAVE-ML has none.
fn flies_a_simulator(text: &str) -> bool {
    text.lines().any(|line| line.trim_start().starts_with("[simulator]"))
}

fn of_simulator(arguments: &Arguments) -> Result<(), Failure> {
    let study = file::load(&arguments.file, &arguments.overrides).map_err(Failure::load)?;
    let model = at_work("asking", || import_simulator(&study)).map_err(Failure::input)?;
    if let Some(path) = &arguments.out {
        output::write(path, model.toml())?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&model.text()),
        Format::Json => print(&json_text(&model.json())),
    }
}
