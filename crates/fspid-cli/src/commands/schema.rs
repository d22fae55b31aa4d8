//! `fspid schema`: what a scenario file may hold.

use clap::Args;

use super::json_text;
use crate::exit::{Failure, print};
use fspid_study::file;

/// Print the JSON Schema of a scenario file, for editors.
#[derive(Debug, Args)]
pub(crate) struct Arguments {}

pub(crate) fn run(_: &Arguments) -> Result<(), Failure> {
    print(&json_text(&file::schema()))
}
