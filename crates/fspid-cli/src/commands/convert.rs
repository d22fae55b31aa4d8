//! `fspid convert`: the same system in another format.

use clap::Args;
use serde_json::json;

use super::{Format, Loading, Tool, json_text};
use crate::argument::{OutFile, Source, is_standard, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::file::known_words;
use fspid_scenario::fuzzy_system;
use fspid_scenario::fuzzy_system::{Dialect, Target};
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
    /// The new file: .toml (everything can be said), .fis, .t2fis (interval sets in Sugeno systems), .fcl, .fll or .xml.
    #[arg(value_parser = written(&fuzzy_system::Format::ENDINGS), value_name = "OUT")]
    out: OutFile,
    /// The tool that shall read an .fcl file; IEC 61131-7 if left out.
    #[arg(long, value_enum, value_name = "TOOL")]
    to: Option<Tool>,
    /// Approximate or leave out what the format cannot say, and tell the error.
    #[arg(long)]
    lossy: bool,
    /// The format of standard output, where OUT is `-`, as an ending: toml, fis, t2fis, fcl, fll or xml.
    #[arg(long = "as", value_name = "FORMAT", default_value = "toml", value_parser = format)]
    written: fuzzy_system::Format,
    /// How it is told what was assumed and lost: as words, or as JSON on standard output.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// The format that is called by an ending.
fn format(ending: &str) -> Result<fuzzy_system::Format, String> {
    fuzzy_system::Format::of_ending(ending).ok_or_else(|| {
        let known = fuzzy_system::Format::ENDINGS;
        format!("unknown format{}", known_words(ending, &known))
    })
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (name, options) = (&arguments.system, arguments.loading.options());
    let out = &arguments.out;
    let target = Target {
        dialect: arguments.to.map(Dialect::from),
        lossy: arguments.lossy,
        format: is_standard(out).then_some(arguments.written),
    };
    let converted = fuzzy_system::convert(name, options, out, target).map_err(Failure::input)?;
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
