//! `fspid aircraft list`: the aircraft that the program carries.

use clap::Args;

use super::super::{Format, json_text};
use crate::exit::{Failure, print};
use fspid_study::aircraft::list;

/// List the aircraft that the program carries.
///
/// Those known by derivatives can be trimmed and flown at other speeds and altitudes; those known by a
/// linear model hold at one condition.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let list = list();
    match arguments.format {
        Format::Text => print(&list.text()),
        Format::Json => print(&json_text(&list.json())),
    }
}
