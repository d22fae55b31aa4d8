//! `fspid adaptation`: whether a self-tuner adapts, or only answers the moment.

use std::sync::atomic::Ordering;

use clap::Args;
use fspid_campaign::local;

use super::progress::{Telling, alive, tell};
use super::{Format, interrupt, memory};
use crate::argument::{InFile, OutFile, count, written};
use crate::exit::{Failure, note, wrote};
use fspid_diagnostics::digits::grouped;
use fspid_scenario::count as counts;
use fspid_study::output;
use fspid_tune::adaptation::{Adaptation, Answer, Options, Watch, uncounted};
use fspid_tune::{Source, TuneError};

/// Does a self-tuner adapt to its plant, or only answer the moment? Fly it with its gains frozen, shuffled, and as they should be.
///
/// The flights are the cases of the contest, else those of the tuning, else the scenario as it is written. Each is flown
/// with the supervisor, with its gains or inputs shuffled in time, with the mean of its gains over the flight, the plant and
/// all flights, with nominal gains, and with the frozen gains that are best for the very plant; everything behind the gains
/// stays. The answer says what share of the win over the other controller each explains, and what the mean gains follow.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// The self-tuner; the first one if left out.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// The controller that it is compared with; by default that of the contest, or the first one with fixed gains.
    #[arg(long, value_name = "NAME")]
    against: Option<String>,
    /// How often time is shuffled.
    #[arg(long, value_name = "K", default_value_t = Options::default().seeds, value_parser = count::<u64>(&counts::SEEDS))]
    seeds: u64,
    /// The first seed of all random numbers.
    #[arg(long, value_name = "S", default_value_t = Options::default().seed)]
    seed: u64,
    /// How many candidates the search for the best gains of each plant flies.
    #[arg(long, value_name = "N", default_value_t = Options::default().budget, value_parser = count::<usize>(&counts::BUDGET))]
    budget: usize,
    /// How many draws of the dispersions each case has; by default as the contest or the tuning says.
    #[arg(long, value_name = "N", value_parser = count::<u64>(&counts::RUNS))]
    runs: Option<u64>,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "FILE")]
    report: Option<OutFile>,
    /// Set a value before anything is read, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    /// Say nothing of the progress.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source =
        Source { path: arguments.scenario.to_path_buf(), overrides: arguments.overrides.clone() };
    let options = Options {
        controller: arguments.controller.clone(),
        against: arguments.against.clone(),
        seeds: arguments.seeds,
        seed: arguments.seed,
        budget: arguments.budget,
        runs: arguments.runs,
    };
    let asked = Adaptation::new(&source, &options).map_err(Failure::input)?;
    asked.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
    memory::asked(asked.needed(memory::threads(arguments.threads)))?;
    let answer = measured(arguments, &asked)?;
    if let Some(path) = &arguments.report {
        output::write(path, answer.page())?;
        wrote(path);
    }
    arguments.format.print(|| answer.text(), || answer.json())
}

fn measured(arguments: &Arguments, asked: &Adaptation) -> Result<Answer, Failure> {
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    interrupt::watch();
    let flown = uncounted();
    let watch = Watch { stops: &interrupt::asked, flown: &flown };
    let measure = || local::in_threads(arguments.threads, || asked.measured(watch));
    let line = || {
        let done = grouped(flown.load(Ordering::Relaxed) as u64);
        format!("{done} of at most {} flights", grouped(asked.expected() as u64))
    };
    let answer = match telling {
        Telling::Nothing => measure(),
        Telling::Line | Telling::Lines => alive(telling, &line, measure),
    };
    if telling == Telling::Line {
        tell(telling, "");
    }
    answer.map_err(Failure::input)?.map_err(|error| match error {
        TuneError::Stopped => Failure::interrupted(
            "interrupted; nothing is kept of an experiment, so that it begins anew",
        ),
        error => Failure::of_input(&error, error.problems()),
    })
}
