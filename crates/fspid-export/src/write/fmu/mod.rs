//! A controller as a functional mock-up unit for co-simulation, FMI 2.0 and 3.0.
//!
//! An FMU is a zip archive: a description as XML, sources in C, a library of these for a platform, a page. What is the
//! same for every controller stands in `sources` as C; what is written here is the controller itself, `fmu-model.h`
//! with its variables, and the description.

mod description;
mod model;
mod parameter;
mod variable;

use sha2::{Digest, Sha256};

use super::{Heading, c};
use crate::file::File;
use crate::program::Program;
use crate::write::decimal;

/// The version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    /// 2.0.
    Two,
    /// 3.0.
    Three,
}

/// What an FMU is written from.
#[derive(Clone, Copy)]
pub(crate) struct Fmu<'a> {
    /// The program, with what an importer wants to look at.
    pub(crate) program: &'a Program,
    /// What every name begins with; the model identifier of the standard.
    pub(crate) prefix: &'a str,
    pub(crate) heading: &'a Heading<'a>,
    pub(crate) version: Version,
    /// Sample period of the scenario, s; `None` for a fuzzy system, which has neither that nor parameters and is asked
    /// once in each step.
    pub(crate) period_s: Option<f64>,
}

/// The parts of an FMU but for its library.
pub(crate) struct Parts {
    /// Everything in the archive that is text.
    pub(crate) texts: Vec<File>,
    /// All that the compiler needs, in one folder.
    pub(crate) to_compile: Vec<File>,
    /// Those of them that it is told.
    pub(crate) sources: Vec<String>,
}

const INSTANCE: &str = include_str!("sources/fmu-instance.h");
const LICENCE: &str = include_str!("../../../LICENSE-MIT");

impl Version {
    const fn number(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }

    /// Name and text of the source around an instance. No controller's own files have a hyphen in their names.
    const fn source(self) -> (&'static str, &'static str) {
        match self {
            Self::Two => ("fmu-2.c", include_str!("sources/fmu-2.c")),
            Self::Three => ("fmu-3.c", include_str!("sources/fmu-3.c")),
        }
    }

    /// Name and text of what an importer brings, and who compiles without one needs.
    const fn header(self) -> (&'static str, &'static str) {
        match self {
            Self::Two => ("fmi2Functions.h", include_str!("headers/fmi2Functions.h")),
            Self::Three => ("fmi3Functions.h", include_str!("headers/fmi3Functions.h")),
        }
    }

    /// The folder of a library for this machine; `None` where the version has no name for it.
    pub(crate) fn platform(self) -> Option<String> {
        let (arch, system) = (std::env::consts::ARCH, std::env::consts::OS);
        let system = match system {
            "macos" => "darwin",
            known => ["linux", "windows"].into_iter().find(|name| *name == known)?,
        };
        match (self, arch) {
            (Self::Two, "x86_64") => Some(match system {
                "windows" => "win64".to_owned(),
                system => format!("{system}64"),
            }),
            // FMI 2.0.5 takes other platforms by the names of FMI 3.0.
            (_, "x86_64" | "aarch64" | "riscv64" | "x86") => Some(format!("{arch}-{system}")),
            _ => None,
        }
    }
}

impl Fmu<'_> {
    fn is_system(&self) -> bool {
        self.period_s.is_none()
    }

    /// The period in decimal digits, s.
    fn period(&self) -> String {
        decimal(self.period_s.unwrap_or_default(), false)
    }
}

/// Everything but the library.
pub(crate) fn parts(fmu: &Fmu<'_>) -> Parts {
    let Fmu { program, prefix, heading, version, .. } = fmu;
    let variables = variable::variables(program, fmu.is_system());
    let code = c(program, prefix, heading);
    let (name, text) = version.source();
    let mut texts = vec![
        (format!("{prefix}.h"), code.header),
        (format!("{prefix}.c"), code.source),
        ("fmu-instance.h".to_owned(), INSTANCE.to_owned()),
        (name.to_owned(), text.to_owned()),
    ];
    let (token, mark) = identity(&variables, &texts);
    texts.push(("fmu-model.h".to_owned(), model::model(fmu, &variables, &token, &mark)));
    let described = description::model_description(fmu, &variables, &token);
    let file = |(name, text): (String, String)| File::text(name, text);
    let mut archived = vec![file(("modelDescription.xml".to_owned(), described))];
    archived.push(file(("documentation/index.html".to_owned(), description::page(fmu))));
    archived.push(file(("documentation/licenses/license.txt".to_owned(), LICENCE.to_owned())));
    let build = description::build_description(fmu);
    archived.push(file(("sources/buildDescription.xml".to_owned(), build)));
    let inside = |(name, text): &(String, String)| (format!("sources/{name}"), text.clone());
    archived.extend(texts.iter().map(inside).map(file));
    let (header, declared) = version.header();
    texts.push((header.to_owned(), declared.to_owned()));
    Parts {
        texts: archived,
        to_compile: texts.into_iter().map(file).collect(),
        sources: vec![format!("{prefix}.c"), name.to_owned()],
    }
}

/// A token that follows from what the FMU is, and 16 bytes that mark its states.
fn identity(variables: &[variable::Variable], texts: &[(String, String)]) -> (String, Vec<u8>) {
    let mut digest = Sha256::new();
    for variable in variables {
        digest.update(format!("{variable:?}\n"));
    }
    for (name, text) in texts {
        digest.update(format!("{name} {}\n{text}", text.len()));
    }
    let mark: Vec<u8> = digest.finalize().iter().copied().take(16).collect();
    let digits: String = mark.iter().map(|byte| format!("{byte:02x}")).collect();
    let parts = [0..8, 8..12, 12..16, 16..20, 20..32].map(|part| digits[part].to_owned());
    (format!("{{{}}}", parts.join("-")), mark)
}
