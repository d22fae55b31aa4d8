//! `fspid check`: is a scenario file right?

use std::path::PathBuf;

use clap::Args;

use crate::exit::{Failure, note, print};
use fspid_study::file;

/// Check a scenario file and tell every problem in it.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: PathBuf,
    /// Set a value before checking, e.g. `--set controller.FSPID.nominal.kp=2.5`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = file::load(&arguments.file, &arguments.overrides).map_err(Failure::input)?;
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    let scenario = &study.scenario;
    print(&format!(
        "{}: good; {} with {} controller(s), {} samples of {} s, digest {}\n",
        arguments.file.display(),
        scenario.name,
        scenario.controllers.len(),
        scenario.timing.rows(),
        scenario.timing.dt_s(),
        study.digest,
    ))
}
