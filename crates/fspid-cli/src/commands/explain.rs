//! `fspid explain`: why a fuzzy system answers as it does.

use clap::{ArgGroup, Args};

use super::{Format, Inputs, Which, drawings, json_text};
use crate::argument::Drawings;
use crate::exit::{Failure, print};
use fspid_study::fuzzy_system;

/// Explain an answer: rules by strength, the share of each in every output, and why not another.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("asked").required(true).multiple(true).args(["error", "change", "input"]))]
pub(crate) struct Arguments {
    #[command(flatten)]
    which: Which,
    #[command(flatten)]
    inputs: Inputs,
    /// Also say why this term was not concluded: which rules could, and what each of them lacks.
    #[arg(long, value_name = "OUTPUT=TERM")]
    why_not: Option<String>,
    /// Draw the joined sets with the part of each rule: a file, or a folder for several outputs.
    #[arg(long, value_name = "FILE.svg or FOLDER")]
    svg: Option<Drawings>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let system = arguments.which.load()?;
    let explanation =
        fuzzy_system::explain(&system, &arguments.inputs.texts(), arguments.why_not.as_deref())
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
