//! `fspid infer`: ask a fuzzy system, or the supervisor of the paper.

use std::io::{self, BufReader, BufWriter};
use std::path::Path;

use clap::{ArgGroup, Args};

use super::{Format, Inputs, Which, json_text};
use crate::argument::InFile;
use crate::exit::{Failure, note, print};
use fspid_scenario::supervisor::Question;
use fspid_study::fuzzy_system::{self, SystemTable};
use fspid_study::inference::{self, SupervisorTable};
use fspid_study::rows::{self, RowAnswers, RowsError};

/// Ask a fuzzy system: one question, or a table of them.
///
/// Without SYSTEM the supervisor of the paper is asked.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("inputs").required(true).multiple(true).args(["error", "change", "points", "input"]))]
pub(crate) struct Arguments {
    #[command(flatten)]
    which: Which,
    #[command(flatten)]
    inputs: Inputs,
    /// Answer every row of this CSV file with a row of CSV; `-` reads standard input.
    ///
    /// There is a column for each input, found by its name; without SYSTEM they are `e,ec`. A file
    /// is checked first, and nothing is written if one of its rows is wrong. Standard input is
    /// answered as it comes, up to the first row that is wrong.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["error", "change", "input", "format"])]
    points: Option<InFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.which.system.is_some() || !arguments.inputs.input.is_empty() {
        true => general(arguments),
        false => supervisor(arguments),
    }
}

fn general(arguments: &Arguments) -> Result<(), Failure> {
    let system = arguments.which.load()?;
    if let Some(path) = &arguments.points {
        return table(&mut SystemTable::new(&system), path);
    }
    let asked = fuzzy_system::ask(&system, &arguments.inputs.texts()).map_err(Failure::input)?;
    match arguments.format {
        Format::Json => print(&json_text(&asked.json())),
        Format::Text => print(&asked.text()),
    }
}

fn supervisor(arguments: &Arguments) -> Result<(), Failure> {
    let loading = &arguments.which.loading;
    let Some(range) = loading.range else {
        return Err(Failure::input(
            "add --range, the half range of inputs and outputs, or name a SYSTEM",
        ));
    };
    let question = Question {
        table: arguments.which.name(),
        range,
        defuzzifier: loading.defuzzifier.as_deref().unwrap_or("exact"),
        out_of_range: loading.out_of_range.as_deref().unwrap_or("clamp"),
    };
    let supervisor = question.supervisor().map_err(Failure::input)?;
    if let Some(path) = &arguments.points {
        return table(&mut SupervisorTable(supervisor), path);
    }
    let (Some(error), Some(change)) = (arguments.inputs.error, arguments.inputs.change) else {
        return Err(Failure::input("--error and --change are asked for together"));
    };
    let answer = supervisor.infer(error, change).map_err(Failure::input)?;
    match arguments.format {
        Format::Json => print(&json_text(&inference::json(&answer))),
        Format::Text => print(&inference::text(&answer)),
    }
}

/// Answers a table; a reader that has gone away (`| head`) is no failure.
fn table(table: &mut impl RowAnswers, path: &Path) -> Result<(), Failure> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let done = if path == Path::new("-") {
        let mut rows = BufReader::with_capacity(1 << 16, io::stdin().lock());
        rows::answer_rows(table, &mut rows, &mut out).map_err(|error| rows::named("-", error))
    } else {
        rows::answer_file(table, path, &mut out)
    };
    match done {
        Ok(_) => {
            table.remarks().iter().for_each(|remark| note(format_args!("warning: {remark}")));
            Ok(())
        }
        Err(RowsError::Writing(error)) => Failure::of_writing(&error),
        Err(error) => Err(Failure::input(error)),
    }
}
