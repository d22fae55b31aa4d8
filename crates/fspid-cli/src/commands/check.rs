//! `fspid check`: is a file right?

use std::path::{Path, PathBuf};

use clap::Args;

use crate::exit::{Failure, note, print};
use fspid_study::file::{self, Template};
use fspid_study::fuzzy_system;

/// Check a scenario or a fuzzy system and tell every problem in it.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The file: a scenario, or a fuzzy system (.toml, .fis, .t2fis, .fcl, .fll, .xml).
    file: PathBuf,
    /// Set a value of a scenario before checking, e.g. `--set controller.FSPID.nominal.kp=2.5`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.overrides.is_empty() && fuzzy_system::is_system(&arguments.file) {
        return system(&arguments.file);
    }
    let study = file::load(&arguments.file, &arguments.overrides).map_err(Failure::input)?;
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    if !study.dispersions.is_empty() {
        Template::load(&arguments.file, &arguments.overrides)
            .map_err(Failure::input)?
            .check_dispersions()
            .map_err(Failure::input)?;
    }
    for gains in &study.derived_gains {
        note(format_args!("gains of {gains}"));
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

fn system(path: &Path) -> Result<(), Failure> {
    let name = path.display().to_string();
    let loaded = fuzzy_system::load(&name, fuzzy_system::Options::default());
    let loaded = loaded.map_err(Failure::input)?;
    for found in &loaded.notes {
        note(format_args!("warning: {found}"));
    }
    let parts = loaded.system.parts();
    print(&format!(
        "{name}: good; {} with {} input(s), {} output(s), {} rule(s)\n",
        if parts.name.is_empty() { "a fuzzy system" } else { &parts.name },
        parts.inputs.len(),
        parts.outputs.len(),
        parts.blocks.iter().map(|block| block.rules.len()).sum::<usize>(),
    ))
}
