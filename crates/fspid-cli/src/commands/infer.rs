//! `fspid infer`: ask the supervisor.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::{Format, json_text};
use crate::exit::{Failure, print};
use fspid_study::inference::{self, Question};

/// Ask the fuzzy supervisor for the increments of the gains.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("inputs").required(true).args(["error", "points"]))]
pub(crate) struct Arguments {
    /// Rule table: `printed`, `mirrored`, or a file.
    #[arg(long, default_value = "printed")]
    table: String,
    /// Half range of inputs and outputs (the paper uses 5 and 40).
    #[arg(long, allow_negative_numbers = true)]
    range: f64,
    /// Error, in the supervisor's units.
    #[arg(long, allow_negative_numbers = true, requires = "change")]
    error: Option<f64>,
    /// Change of the error, in the supervisor's units.
    #[arg(long, allow_negative_numbers = true, requires = "error")]
    change: Option<f64>,
    /// Answer every row of this CSV file (columns `e,ec`) with a row of CSV.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["error", "change", "format"])]
    points: Option<PathBuf>,
    /// Centroid: `exact`, or `endpoints:N` (MATLAB: 101), `midpoint:N`, `trapezoid:N`, `left-end:N`,
    /// `vertices:N` (scikit-fuzzy).
    #[arg(long, default_value = "exact")]
    defuzzifier: String,
    /// What to do with inputs beyond the range: `clamp`, `evaluate` or `error`.
    #[arg(long, default_value = "clamp")]
    out_of_range: String,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let question = Question {
        table: &arguments.table,
        range: arguments.range,
        defuzzifier: &arguments.defuzzifier,
        out_of_range: &arguments.out_of_range,
    };
    let supervisor = question.supervisor().map_err(Failure::input)?;
    if let Some(path) = &arguments.points {
        return print(&inference::answer_file(&supervisor, path).map_err(Failure::input)?);
    }
    let (error, change) = (arguments.error.unwrap_or(0.0), arguments.change.unwrap_or(0.0));
    let answer = supervisor.infer(error, change).map_err(Failure::input)?;
    match arguments.format {
        Format::Json => print(&json_text(&inference::json(&answer))),
        Format::Text => print(&inference::text(&answer)),
    }
}
