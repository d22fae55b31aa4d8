//! `fspid convert`: the same system in another format.

use std::path::PathBuf;

use clap::Args;

use super::{Loading, Tool};
use crate::exit::{Failure, note};
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
    system: String,
    #[command(flatten)]
    loading: Loading,
    /// The new file: .toml (everything can be said), .fis, .t2fis, .fcl, .fll or .xml.
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The tool that shall read an .fcl file; IEC 61131-7 if left out.
    #[arg(long, value_enum, value_name = "TOOL")]
    to: Option<Tool>,
    /// Approximate or leave out what the format cannot say, and tell the error.
    #[arg(long)]
    lossy: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let target = Target { dialect: arguments.to.map(Dialect::from), lossy: arguments.lossy };
    let (name, options) = (&arguments.system, arguments.loading.options());
    let converted =
        fuzzy_system::convert(name, options, &arguments.out, target).map_err(Failure::input)?;
    for assumed in &converted.assumed {
        note(format_args!("warning: {assumed}"));
    }
    for lost in &converted.lost {
        note(format_args!("lost: {lost}"));
    }
    output::write(&arguments.out, &converted.text)?;
    note(format_args!("wrote {}", arguments.out.display()));
    Ok(())
}
