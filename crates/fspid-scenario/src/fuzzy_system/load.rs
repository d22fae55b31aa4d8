//! A system by the name of its file or of a shipped rule table.

use std::path::Path;

use fspid_core::fuzzy::OutOfRange;
use fspid_fuzzy::system::{Parts, Sampling, System};
use fspid_fuzzy::{LABEL_COUNT, NumberTable, Supervisor};
use sha2::{Digest as _, Sha256};

use super::scenario;
use crate::carried::rule_table_names;
use crate::supervisor::{Question, Refused};
use crate::system_text::{
    Format, LoadError, Loaded, NUMBER_GRID, Options, built, is_of_this_kind, is_rule_table,
    is_scenario_text, read, text,
};

/// True for a file that describes a fuzzy system: by its ending, and of a `.toml` file by its `kind`.
#[must_use]
pub fn is_system(path: &Path) -> bool {
    match Format::of(path) {
        None => false,
        Some(Format::Toml) => text(path).is_ok_and(|text| is_of_this_kind(&text)),
        Some(_) => true,
    }
}

/// True for a name that stands for a system of any half range.
#[must_use]
pub fn needs_range(name: &str) -> bool {
    name == NUMBER_GRID || rule_table_names().contains(&name)
}

/// True for a `.toml` file with a rule table alone.
#[must_use]
pub fn is_rule_table_file(path: &Path) -> bool {
    Format::of(path) == Some(Format::Toml) && text(path).is_ok_and(|text| is_rule_table(&text))
}

/// True for a file with a scenario.
#[must_use]
pub fn is_scenario(name: &str) -> bool {
    let path = Path::new(name);
    Format::of(path) == Some(Format::Toml) && text(path).is_ok_and(|text| is_scenario_text(&text))
}

/// SHA-256 of a system's file, in hexadecimal digits.
///
/// # Errors
/// [`LoadError::Unreadable`].
pub fn digest(path: &Path) -> Result<String, LoadError> {
    let bytes = Sha256::digest(text(path)?.as_bytes());
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// The system in a file, or that of a shipped rule table with a half range. A scenario file stands for the
/// supervisor of its self-tuning controller.
///
/// # Errors
/// [`LoadError`] with everything that is wrong.
pub fn load(name: &str, options: Options<'_>) -> Result<Loaded, LoadError> {
    if needs_range(name) {
        return shipped(name, options);
    }
    let path = Path::new(name);
    let format = Format::of(path).ok_or_else(|| LoadError::UnknownFormat { name: name.into() })?;
    if format == Format::Toml && text(path).is_ok_and(|text| is_rule_table(&text)) {
        return shipped(name, options);
    }
    let mut misplaced = Vec::new();
    if options.range.is_some() {
        misplaced.push("--range goes with a shipped rule table; a file says its own ranges".into());
    }
    if format != Format::Fcl && (options.dialect.is_some() || options.block.is_some()) {
        misplaced.push("--dialect and --block go with an .fcl file".into());
    }
    if !misplaced.is_empty() {
        return Err(LoadError::Refused(Refused::all(misplaced)));
    }
    let text = text(path)?;
    let loaded = match format == Format::Toml && is_scenario_text(&text) {
        true => scenario::read(path, &text, options.controller)?,
        false if options.controller.is_some() => return Err(no_scenario()),
        false => read(name, &text, format, options)?,
    };
    let mut notes = loaded.notes;
    // What the notes say of integrals is the file's.
    if let (Some(sampling), false) = (options.sampling, notes.is_empty()) {
        notes
            .push(format!("{name}: every integral is computed by `{sampling}` here, as was asked"));
    }
    Ok(Loaded { system: changed(loaded.system, options)?, notes })
}

fn no_scenario() -> LoadError {
    LoadError::Refused(Refused::one("--controller goes with a scenario file"))
}

fn shipped(name: &str, options: Options<'_>) -> Result<Loaded, LoadError> {
    if options.controller.is_some() {
        return Err(no_scenario());
    }
    let Some(range) = options.range else {
        let missing = format!("{name} needs --range, the half range of its inputs and outputs");
        return Err(LoadError::Refused(Refused::one(missing)));
    };
    let supervisor = if name == NUMBER_GRID {
        let zeros = [[[0.0; LABEL_COUNT]; LABEL_COUNT]; 3];
        NumberTable::new(zeros)
            // Its outermost sets are level: nothing is to be clamped, which not every format could say.
            .and_then(|table| Supervisor::of_numbers(&table, range, OutOfRange::Evaluate))
            .map_err(|error| LoadError::Refused(Refused::one(error.to_string())))?
    } else {
        let question = Question {
            table: name,
            range,
            defuzzifier: "exact",
            out_of_range: options.out_of_range.unwrap_or(OutOfRange::Clamp.name()),
        };
        question.supervisor().map_err(LoadError::Refused)?
    };
    let mut parts = Parts::try_from(&supervisor)
        .map_err(|error| LoadError::Refused(Refused::one(error.to_string())))?;
    parts.name = name.to_owned();
    let system = built(parts)?;
    Ok(Loaded { system: changed(system, options)?, notes: Vec::new() })
}

/// The same system with the options in place of what its file says.
fn changed(system: System, options: Options<'_>) -> Result<System, LoadError> {
    if options.sampling.is_none() && options.out_of_range.is_none() {
        return Ok(system);
    }
    let mut parts = system.parts().clone();
    let mut problems = Vec::new();
    if let Some(text) = options.sampling {
        match text.parse::<Sampling>() {
            Ok(sampling) => parts.outputs.iter_mut().for_each(|output| {
                output.defuzzifier = output.defuzzifier.with_sampling(sampling);
            }),
            Err(_) => {
                problems.push(format!("--defuzzifier {text}: known are {}", Sampling::NAMES));
            }
        }
    }
    if let Some(text) = options.out_of_range {
        match OutOfRange::ALL.into_iter().find(|policy| policy.name() == text) {
            Some(policy) => {
                parts.inputs.iter_mut().for_each(|input| input.out_of_range = policy);
            }
            None => {
                let known = OutOfRange::ALL.map(OutOfRange::name).join(", ");
                problems.push(format!("--out-of-range {text}: known are {known}"));
            }
        }
    }
    if problems.is_empty() { built(parts) } else { Err(LoadError::Refused(Refused::all(problems))) }
}
