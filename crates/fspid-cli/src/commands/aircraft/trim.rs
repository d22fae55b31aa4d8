//! `fspid aircraft trim`: which angle of attack, elevator and throttle hold a flight.

use clap::Args;

use super::{Answer, Flight};
use crate::exit::Failure;
use fspid_study::aircraft::trim;

/// Find the angle of attack, elevator and throttle that hold a straight flight.
///
/// Where none do, say which limit is in the way and how far the search came; the exit code is then 2.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    flight: Flight,
    #[command(flatten)]
    answer: Answer,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let trimmed = trim(&arguments.flight.question(answer.units())).map_err(Failure::input)?;
    answer.print(|| trimmed.text(), || trimmed.json())
}
