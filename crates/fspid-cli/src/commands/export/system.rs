//! `fspid export` of a fuzzy system.

use super::{Arguments, Numbers, Unit, answer, file_stem, folders};
use crate::exit::{Failure, note};
use fspid_export::program::Precision;
use fspid_export::{SystemRequest, export_system};
use fspid_scenario::fuzzy_system;

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    misplaced(arguments)?;
    let path = arguments.file.display().to_string();
    let options = fuzzy_system::Options {
        sampling: arguments.defuzzifier.as_deref(),
        ..fuzzy_system::Options::default()
    };
    let loaded = fuzzy_system::load(&path, options).map_err(Failure::input)?;
    for assumed in &loaded.notes {
        note(format_args!("warning: {assumed}"));
    }
    let digest = fuzzy_system::digest(&arguments.file).map_err(Failure::input)?;
    let called = &loaded.system.parts().name;
    let name = if called.is_empty() { file_stem(&arguments.file) } else { called.clone() };
    let request = SystemRequest {
        name: arguments.prefix.as_deref().unwrap_or(&name),
        target: arguments.to,
        precision: match arguments.numbers {
            Some(Numbers::Single) => Precision::Single,
            Some(Numbers::Double) | None => Precision::Double,
        },
        samples: arguments.samples as usize,
        digest: &digest,
    };
    folders::check(arguments)?;
    let exported = export_system(&loaded.system, &request)
        .map_err(|refused| Failure::input(format_args!("{path}: {refused}")))?;
    answer(arguments, ["system", &name], &exported)
}

/// Refuses options that a system has no use for.
fn misplaced(arguments: &Arguments) -> Result<(), Failure> {
    let reason = if arguments.controller.is_some() {
        "--controller goes with a scenario or design"
    } else if !arguments.overrides.is_empty() {
        "--set goes with a scenario or design"
    } else if arguments.evidence.is_some() {
        "--evidence goes with a scenario or design; a fuzzy system has vectors.csv and its check"
    } else if arguments.points.is_some() {
        "--points goes with --to table, which a scenario or design has"
    } else if matches!(arguments.angles, Unit::Degrees) {
        "--angles goes with a scenario or design; inputs and outputs of a fuzzy system have the units of its file"
    } else {
        return Ok(());
    };
    Err(Failure::input(reason))
}
