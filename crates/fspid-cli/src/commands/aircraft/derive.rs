//! `fspid aircraft derive`: from stability derivatives to polynomials.

use clap::Args;

use super::Answer;
use crate::argument::Source;
use crate::exit::Failure;
use fspid_study::aircraft::derive;

/// Derive pitch over elevator from stability derivatives, and compare with what the paper prints.
///
/// The aircraft of the paper are navion, its short-period model, and b747-cruise-low, its full model.
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
    let derived = derive(&arguments.name, answer.units()).map_err(Failure::input)?;
    answer.print(|| derived.text(), || derived.json())
}
