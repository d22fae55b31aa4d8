//! The files of an exported fuzzy system.

use fspid_fuzzy::system::System;
use fspid_numeric::Real;

use super::vectors::{difference, single_vectors};
use super::{SystemProgram, SystemRefusal, system_program, system_vectors};
use crate::export::{Export, identifier, renamed, written};
use crate::program::{Precision, Program};
use crate::targets::{Source, Target};
use crate::vectors::{SEED, Vector};
use crate::write::{Heading, decimal};

/// What is asked for.
#[derive(Clone, Debug)]
pub struct SystemRequest<'a> {
    /// The system's name.
    pub name: &'a str,
    /// In which language.
    pub target: Target,
    /// With which digits.
    pub precision: Precision,
    /// How many samples the vectors have.
    pub samples: usize,
    /// SHA-256 of the file, in hexadecimal digits.
    pub digest: &'a str,
}

/// Writes a fuzzy system in another language, with vectors that show that it answers alike.
///
/// # Errors
/// [`SystemRefusal`] names what cannot be exported and what would make it possible.
pub fn export_system(
    system: &System,
    request: &SystemRequest<'_>,
) -> Result<Export, SystemRefusal> {
    if !WRITTEN_TO.contains(&request.target) {
        return Err(SystemRefusal {
            place: "the target".to_owned(),
            problem: format!("{} is not written of fuzzy systems", request.target.name()),
            possible: WRITTEN.to_owned(),
        });
    }
    match request.precision {
        Precision::Double => {
            let program = system_program::<f64>(system)?;
            let vectors = system_vectors(system, SEED, request.samples);
            exported(system, request, &program, &vectors, Vec::new())
        }
        Precision::Single => {
            let program = system_program::<f32>(system)?;
            let vectors = single_vectors(system, &program, SEED, request.samples);
            let notes = measured(system, &vectors);
            exported(system, request, &program, &vectors, notes)
        }
    }
}

fn exported<R: Real>(
    system: &System,
    request: &SystemRequest<'_>,
    program: &SystemProgram,
    vectors: &[Vector<R>],
    more: Vec<String>,
) -> Result<Export, SystemRefusal> {
    let prefix = identifier(request.name);
    let mut notes = Vec::from_iter(renamed(request.name, &prefix));
    let changed = program.names.changed(system.parts());
    notes.extend(changed.filter_map(|[name, called]| renamed(name, called)));
    notes.extend(program.ways.iter().cloned());
    notes.extend(more);
    let heading = Heading {
        name: request.name,
        digest: request.digest,
        precision: request.precision,
        angles: None,
        elevator: None,
    };
    let ranged = matches!(request.target, Target::Fmu2 | Target::Fmu3)
        .then(|| with_ranges(&program.program, system));
    let source = Source {
        program: ranged.as_ref().unwrap_or(&program.program),
        prefix: &prefix,
        heading: &heading,
        vectors,
        flown: None,
    };
    let written = written(request.target, &source).map_err(|reason| SystemRefusal {
        place: "the target".to_owned(),
        problem: reason.to_string(),
        possible: WRITTEN.to_owned(),
    })?;
    notes.extend(written.notes);
    Ok(Export { prefix, files: written.files, evidence: Vec::new(), notes })
}

const WRITTEN_TO: [Target; 5] =
    [Target::C, Target::Lua, Target::StructuredText, Target::Fmu2, Target::Fmu3];
const WRITTEN: &str = "possible are c, lua, st, fmu2 and fmu3, and for MATLAB a .fis, which `fspid convert SYSTEM OUT.fis` writes and \
                       `--lossy` tells the loss of";

/// The program with what an importer of an FMU reads of a variable and no compiler asks: its range.
fn with_ranges(program: &Program, system: &System) -> Program {
    let mut program = program.clone();
    let parts = system.parts();
    let inputs = program.sample.iter_mut().zip(parts.inputs.iter().map(|it| it.universe));
    let outputs = program.answer.iter_mut().zip(parts.outputs.iter().map(|it| it.universe));
    for (member, universe) in inputs.chain(outputs) {
        if let Some(universe) = universe {
            let [lower, upper] = [universe.lower, universe.upper].map(|it| decimal(it, false));
            member.doc.push_str(&format!(" Its range is {lower} to {upper}."));
        }
    }
    program
}

/// What 32 bits make of the answers.
fn measured(system: &System, vectors: &[Vector<f32>]) -> Vec<String> {
    let (largest, elsewhere) = difference(system, vectors);
    let count = vectors.len();
    let mut notes = vec![
        "numbers of 32 bits: the vectors are what these operations answer when each is rounded to 32 bits; `fspid infer` \
         answers with 64, which --numbers double keeps"
            .to_owned(),
    ];
    for (output, largest) in system.parts().outputs.iter().zip(largest) {
        let name = &output.name;
        notes.push(format!("output `{name}`: within {largest:.2e} of 64 bits in {count} samples"));
    }
    if elsewhere > 0 {
        notes.push(format!(
            "{elsewhere} answers come from the rules with one precision and not with the other"
        ));
    }
    notes
}
