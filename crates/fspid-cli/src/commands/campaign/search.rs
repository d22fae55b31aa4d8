//! `fspid campaign search`: the worst case inside the box of the dispersions.

use clap::Args;

use super::super::{Format, interrupt, json_text};
use super::{failure, fits};
use crate::argument::{InFile, count};
use crate::exit::{Failure, print};
use fspid_campaign::sample::Sampling;
use fspid_campaign::{Folder, Question, local, search};
use fspid_scenario::count as counts;

/// Look for the worst case inside the box of the dispersions, on purpose and not by chance.
///
/// Lost flights are worse than all others, those that leave the range of their aircraft's data next. A normal distribution is
/// searched within its limits, or within three standard deviations where it has none.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// What shall be as bad as can be: a measure as campaigns name it, or the id of a requirement.
    #[arg(long, value_name = "NAME")]
    measure: String,
    /// Low values of the measure are the bad ones. Without it high ones are, of a final error its size, and of the time at
    /// which the aircraft leaves its range the early ones. Requirements know themselves.
    #[arg(long)]
    lowest: bool,
    /// The controller; the first one if left out.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// How many flights may be flown.
    #[arg(long, default_value_t = 2000, value_parser = count::<usize>(&counts::FLIGHTS))]
    budget: usize,
    /// Seed of the search.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Set a value before anything is drawn, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let question = Question {
        scenario: &arguments.scenario,
        overrides: &arguments.overrides,
        runs: 1,
        seed: arguments.seed,
        sampling: Sampling::Random,
        shards: fspid_campaign::Shards::ForThreads,
    };
    interrupt::ends_with(
        "interrupted; a search for the worst case keeps nothing, so that it begins anew".to_owned(),
    );
    // Nothing is kept, so that the folder is only what paths are seen from.
    let here = Folder::new(std::path::Path::new("."));
    let campaign = fspid_campaign::plan(&question, &here).map_err(failure)?;
    let asked = search::Question {
        measure: arguments.measure.clone(),
        lowest: arguments.lowest,
        controller: arguments.controller.clone(),
        budget: arguments.budget,
        seed: arguments.seed,
    };
    fits(&campaign, arguments.threads, asked.budget as u64)?;
    let found = local::in_threads(arguments.threads, || search::search(&campaign, &asked));
    let worst = found.and_then(|found| found).map_err(failure)?;
    match arguments.format {
        Format::Text => print(&worst.text(&campaign)),
        Format::Json => print(&json_text(&worst.json(&campaign))),
    }
}
