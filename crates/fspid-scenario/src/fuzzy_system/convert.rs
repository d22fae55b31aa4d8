//! From one format to another.

use std::fmt;
use std::path::Path;

use fspid_formats::fcl::Dialect;
use fspid_formats::{Problems, WriteOptions, fcl, fis, fll, fml};
use fspid_fuzzy::system::Parts;

use crate::fuzzy_system::{self, Format, LoadError, Options, load};

/// Which tool a file is for, where a format has dialects, and what may be lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Target {
    /// The dialect of an `.fcl` file.
    pub dialect: Option<Dialect>,
    /// Whether what the format cannot say may be approximated or left out.
    pub lossy: bool,
    /// The format, where the name of the file does not say it.
    pub format: Option<Format>,
}

/// A file as it is to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Converted {
    /// The text.
    pub text: String,
    /// What was assumed while reading.
    pub assumed: Vec<String>,
    /// What was lost while writing, with the error that it makes.
    pub lost: Vec<String>,
}

/// Why there is nothing to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConvertError {
    /// The system could not be read.
    Load(LoadError),
    /// The ending of the new file is that of no format.
    UnknownEnding {
        /// The new file.
        path: String,
    },
    /// The format cannot say it.
    Unwritable {
        /// What, each with its place in the system.
        problems: Vec<String>,
    },
}

impl fmt::Display for ConvertError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Load(error) => error.fmt(f),
            Self::UnknownEnding { path } => {
                write!(
                    f,
                    "{path}: the ending says no format; known are {}",
                    Format::endings_in_words()
                )
            }
            Self::Unwritable { problems } => f.write_str(&problems.join("\n")),
        }
    }
}

impl std::error::Error for ConvertError {}

/// The system `name` in the format that the ending of `path` tells.
///
/// # Errors
/// [`ConvertError`]; nothing is written in any case.
pub fn convert(
    name: &str,
    options: Options<'_>,
    path: &Path,
    target: Target,
) -> Result<Converted, ConvertError> {
    format_of(path, target)?;
    let loaded = load(name, options).map_err(ConvertError::Load)?;
    let written = write_as(loaded.system.parts(), path, target)?;
    Ok(Converted { assumed: loaded.notes, ..written })
}

/// A system in the format that the ending of `path` tells.
///
/// # Errors
/// [`ConvertError`]; nothing is written in any case.
pub fn write_as(parts: &Parts, path: &Path, target: Target) -> Result<Converted, ConvertError> {
    let format = format_of(path, target)?;
    if let Some(dialect) = target.dialect
        && format != Format::Fcl
    {
        let problem = format!("--to {} goes with an .fcl file", dialect.name());
        return Err(ConvertError::Unwritable { problems: vec![problem] });
    }
    if format == Format::Toml {
        return Ok(Converted::whole(fuzzy_system::write(parts)));
    }
    if format == Format::T2fis && !parts.is_interval_type2() {
        return Err(not_type_2(path));
    }
    let written = |lossy| {
        let options = WriteOptions { lossy };
        match format {
            Format::Fis | Format::T2fis => fis::write(parts, options),
            Format::Fml => fml::write(parts, options),
            Format::Fll => fll::write(parts, options),
            _ => fcl::write(parts, target.dialect.unwrap_or_default(), options),
        }
    };
    let writing = written(target.lossy).map_err(|problems| {
        // Advised only where it helps: some of what a format cannot say has no nearest.
        let helps = !target.lossy && written(true).is_ok();
        unwritable(path, &problems, helps)
    })?;
    let lost = writing.notes.iter().map(ToString::to_string).collect();
    Ok(Converted { text: writing.text, assumed: Vec::new(), lost })
}

fn format_of(path: &Path, target: Target) -> Result<Format, ConvertError> {
    let unknown = || ConvertError::UnknownEnding { path: path.display().to_string() };
    target.format.or_else(|| Format::of(path)).ok_or_else(unknown)
}

impl Converted {
    /// A file in which everything could be said.
    fn whole(text: String) -> Self {
        Self { text, assumed: Vec::new(), lost: Vec::new() }
    }
}

/// A pair of equal functions for each would say the same, but the toolbox is not for such systems.
fn not_type_2(path: &Path) -> ConvertError {
    let path = path.display();
    let told =
        "a .t2fis file holds an interval type-2 system, and this one is type-1; write a .fis file";
    ConvertError::Unwritable { problems: vec![format!("{path}: {told}")] }
}

/// What the format cannot say, and how to go on.
fn unwritable(path: &Path, problems: &Problems, lossy_helps: bool) -> ConvertError {
    let path = path.display();
    let mut told: Vec<String> =
        problems.list.iter().map(|found| format!("{path}: {found}")).collect();
    let nearest = match lossy_helps {
        true => "--lossy writes the nearest that can be said, and ",
        false => "",
    };
    told.push(format!("nothing was written; {nearest}a .toml file holds everything"));
    ConvertError::Unwritable { problems: told }
}
