//! `fspid aircraft modes`: the natural motions of an aircraft.

use clap::Args;

use super::{Answer, Flight};
use crate::exit::Failure;
use fspid_study::aircraft::modes;

/// Name the natural motions: frequency, damping, period, and the time to half or double size.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    flight: Flight,
    #[command(flatten)]
    answer: Answer,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let modes = modes(&arguments.flight.question(answer.units())).map_err(Failure::input)?;
    answer.print(|| modes.text(), || modes.json())
}
