//! `fspid schema`: what a file may hold.

use clap::{Args, ValueEnum};

use super::Format;
use crate::exit::{Failure, print};
use fspid_scenario::{file, fuzzy_system};

/// Print the JSON Schema of a scenario's, an aircraft's or a fuzzy system's file, for editors.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Which file.
    #[arg(value_enum, default_value_t = Kind::Scenario)]
    kind: Kind,
    /// A schema is JSON in any case.
    #[arg(long, value_enum, default_value_t = Format::Json)]
    format: Format,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// What `simulate` flies.
    Scenario,
    /// What a scenario names as `aircraft = { file = "…", … }`.
    Aircraft,
    /// What `infer` asks.
    FuzzySystem,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (Format::Text | Format::Json) = arguments.format;
    let schema = match arguments.kind {
        Kind::Scenario => file::schema(),
        Kind::Aircraft => file::aircraft_schema(),
        Kind::FuzzySystem => fuzzy_system::schema(),
    };
    print(&format!("{schema:#}\n"))
}
