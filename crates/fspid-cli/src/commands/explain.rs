//! `fspid explain`: why a fuzzy system answers as it does.

use std::path::PathBuf;

use clap::Args;

use super::{Format, Loading, drawings, json_text};
use crate::exit::{Failure, print};
use fspid_study::fuzzy_system;

/// Explain an answer: rules by strength, the share of each in every output, and why not another.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A file (.toml, .fis, .t2fis, .fcl, .fll, .xml), a scenario for its supervisor, or `printed`, `mirrored` or `sugeno-grid` with --range.
    system: String,
    #[command(flatten)]
    loading: Loading,
    /// The value of an input; once for each input.
    #[arg(long, value_name = "NAME=VALUE", required = true, allow_hyphen_values = true)]
    input: Vec<String>,
    /// Also say why this term was not concluded: which rules could, and what each of them lacks.
    #[arg(long, value_name = "OUTPUT=TERM")]
    why_not: Option<String>,
    /// Draw the joined sets with the part of each rule: a file, or a folder for several outputs.
    #[arg(long, value_name = "FILE.svg or FOLDER")]
    svg: Option<PathBuf>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let system = arguments.loading.load(&arguments.system)?;
    let explanation =
        fuzzy_system::explain(&system, &arguments.input, arguments.why_not.as_deref())
            .map_err(Failure::input)?;
    if let Some(path) = &arguments.svg {
        let figures = explanation.figures();
        drawings::write(path, figures.iter().map(|(name, svg)| (*name, svg.as_str())).collect())?;
    }
    match arguments.format {
        Format::Text => print(&explanation.text()),
        Format::Json => print(&json_text(&explanation.json())),
    }
}
