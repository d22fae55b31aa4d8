//! `fspid aircraft show`: what is known about an aircraft.

use clap::Args;

use super::Answer;
use crate::argument::Source;
use crate::exit::Failure;
use fspid_study::aircraft::show;

/// Show everything that is known about an aircraft, with its source.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// An aircraft that the program carries, or an aircraft file.
    #[arg(value_name = "NAME or FILE")]
    name: Source,
    #[command(flatten)]
    answer: Answer,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let shown = show(&arguments.name, answer.units()).map_err(Failure::input)?;
    answer.print(|| shown.text(), || shown.json())
}
