//! `fspid convert`: the same system in another format.

use std::path::Path;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::{Format, Loading, Tool, json_text};
use crate::argument::{OutFile, Source, is_standard, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_study::fuzzy_system::{self, Dialect, Target};
use fspid_study::output;

/// Write a fuzzy system in another format; the ending of OUT says which.
///
/// What the new format cannot say is refused with its place; --lossy writes the nearest it can say
/// and tells the error.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A file (.toml, .fis, .t2fis, .fcl, .fll, .xml), a scenario for its supervisor, or `printed`, `mirrored` or `sugeno-grid` with --range.
    #[arg(value_name = "IN")]
    system: Source,
    #[command(flatten)]
    loading: Loading,
    /// The new file: .toml (everything can be said), .fis, .t2fis, .fcl, .fll or .xml.
    #[arg(value_parser = written(&["toml", "fis", "t2fis", "fcl", "fll", "xml"]), value_name = "OUT")]
    out: OutFile,
    /// The tool that shall read an .fcl file; IEC 61131-7 if left out.
    #[arg(long, value_enum, value_name = "TOOL")]
    to: Option<Tool>,
    /// Approximate or leave out what the format cannot say, and tell the error.
    #[arg(long)]
    lossy: bool,
    /// The format of standard output, where OUT is `-`.
    #[arg(long = "as", value_enum, value_name = "FORMAT", default_value_t = Written::Toml)]
    written: Written,
    /// How it is told what was assumed and lost: as words, or as JSON on standard output.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A format of fuzzy systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Written {
    /// Our own.
    Toml,
    /// MATLAB.
    Fis,
    /// IEC 61131-7.
    Fcl,
    /// fuzzylite.
    Fll,
}

impl Written {
    /// A name with the ending that says the format.
    fn file(self) -> &'static Path {
        Path::new(match self {
            Self::Toml => "standard-output.toml",
            Self::Fis => "standard-output.fis",
            Self::Fcl => "standard-output.fcl",
            Self::Fll => "standard-output.fll",
        })
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let target = Target { dialect: arguments.to.map(Dialect::from), lossy: arguments.lossy };
    let (name, options) = (&arguments.system, arguments.loading.options());
    let out = &arguments.out;
    let named = if is_standard(out) { arguments.written.file() } else { out.as_ref() };
    let converted = fuzzy_system::convert(name, options, named, target).map_err(Failure::input)?;
    for assumed in &converted.assumed {
        note(format_args!("warning: {assumed}"));
    }
    for lost in &converted.lost {
        note(format_args!("lost: {lost}"));
    }
    output::write(out, &converted.text)?;
    wrote(out);
    match arguments.format {
        Format::Text => Ok(()),
        Format::Json => print(&json_text(&json!({
            "schema": 1, "file": out.display().to_string(), "assumed": converted.assumed,
            "lost": converted.lost,
        }))),
    }
}
