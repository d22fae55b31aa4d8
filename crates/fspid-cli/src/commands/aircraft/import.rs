//! `fspid aircraft import`: a flight model in DAVE-ML, an aircraft file of JSBSim, or the linear model of an aircraft in
//! another simulator.

use clap::Args;

use super::super::progress::at_work;
use super::super::{Format, json_text};
use crate::argument::{InFile, OutFile, is_standard, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::file;
use fspid_study::aircraft::{import, import_jsbsim, import_simulator, is_jsbsim};
use fspid_study::output;

/// Read a flight model in DAVE-ML or an aircraft of JSBSim, or ask another simulator for the linear model of its aircraft, and
/// write it as TOML if asked for.
///
/// A model in DAVE-ML is held against its own check cases; problems are told with line and column, all at once, and a model
/// that fails a check case is not written. Of a scenario with `[simulator]` the linear model at its condition is found by
/// differences, and held against the simulator's own. Of an aircraft file of JSBSim the aerodynamics and the body are read as
/// far as they are tables and sums: an aircraft file and its tables beside it are written, and what is outside of that is
/// refused by name, all at once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The model: a DAVE-ML file, or a .toml file that was written from one; an aircraft file of JSBSim; or a scenario with
    /// `[simulator]`.
    #[arg(value_name = "FILE.dml")]
    file: InFile,
    /// Set a value of the scenario first, e.g. `--set simulator.mach=0.7`; of an aircraft of JSBSim hold a property at a value,
    /// e.g. `--set fcs/flap-pos-deg=10`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Largest thrust of an engine, the same everywhere, that stands for those of an aircraft of JSBSim; without it the aircraft
    /// glides.
    #[arg(long, value_name = "THRUST")]
    thrust_lbf: Option<f64>,
    /// Write the model to this file; of an aircraft of JSBSim its tables go beside it.
    #[arg(value_parser = written(&["toml"]), long, value_name = "OUT.toml")]
    out: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let text = file::read_text(&arguments.file).unwrap_or_default();
    if is_jsbsim(&text) {
        return of_jsbsim(arguments);
    }
    if arguments.thrust_lbf.is_some() {
        return Err(Failure::input("--thrust-lbf goes with an aircraft file of JSBSim"));
    }
    if flies_a_simulator(&text) {
        return of_simulator(arguments);
    }
    if !arguments.overrides.is_empty() {
        return Err(Failure::input(
            "--set goes with a scenario that has [simulator], or with an aircraft file of JSBSim",
        ));
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

fn of_jsbsim(arguments: &Arguments) -> Result<(), Failure> {
    let held = arguments.overrides.iter().map(|text| held(text)).collect::<Result<Vec<_>, _>>()?;
    let imported =
        import_jsbsim(&arguments.file, held, arguments.thrust_lbf).map_err(Failure::input)?;
    for found in imported.notes() {
        note(format_args!("note: {found}"));
    }
    if let Some(path) = &arguments.out {
        if is_standard(path) {
            let message = "an aircraft of JSBSim becomes several files; name one that they go beside: --out NAME.toml";
            return Err(Failure::input(message));
        }
        let files = imported.files(path);
        let contents: Vec<_> =
            files.iter().map(|(path, text)| (path.clone(), text.as_bytes())).collect();
        output::write_all(&contents)?;
        files.iter().for_each(|(path, _)| wrote(path));
    }
    match arguments.format {
        Format::Text => print(&imported.text()),
        Format::Json => print(&json_text(&imported.json())),
    }
}

/// A property of JSBSim and the value at which it is held.
fn held(text: &str) -> Result<(String, f64), Failure> {
    let value = text.split_once('=').and_then(|(name, value)| {
        Some((
            name.trim().to_owned(),
            value.trim().parse::<f64>().ok().filter(|it| it.is_finite())?,
        ))
    });
    value.ok_or_else(|| {
        Failure::input(format!(
            "`--set {text}`: expected PROPERTY=NUMBER, such as fcs/flap-pos-deg=10"
        ))
    })
}
