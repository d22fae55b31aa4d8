//! `fspid campaign`: many flights of a dispersed scenario, one file a subcommand.

mod engine;
mod merge;
mod plan;
mod progress;
mod rare;
mod replay;
mod report;
mod run;
mod search;
mod shard;

use std::path::Path;

use clap::{Args, Subcommand, ValueEnum};

use super::external_controller::Beside;
use super::memory;
use crate::argument::{self, count};
use crate::exit::{Failure, note};
use fspid_campaign::sample::Sampling;
use fspid_campaign::{Campaign, CampaignError, Folder, Question, Shards, USUAL_RUNS, USUAL_SEED};
use fspid_scenario::count as counts;
use fspid_study::memory::Needed;

/// Fly a scenario many times with numbers drawn anew, and say how often it fails.
///
/// What differs from run to run stands in the scenario as `[[dispersion]]`. Run i depends on the
/// campaign's seed and on i alone: shards, threads, machines and interruptions never show.
#[derive(Debug, Args)]
#[command(after_help = HELP, after_long_help = LONG_HELP)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Plan(plan::Arguments),
    Shard(shard::Arguments),
    Merge(merge::Arguments),
    Report(report::Arguments),
    Replay(replay::Arguments),
    Search(search::Arguments),
    Rare(rare::Arguments),
}

const HELP: &str = "Examples, after `fspid init --template campaign drawn.toml`:
  fspid campaign run drawn.toml --runs 10000 --seed 1 --out robust
  fspid campaign report robust/campaign.parquet --out robust.html
  fspid campaign replay robust --run 137 --trace run-137.csv
  fspid campaign search drawn.toml --measure overshoot_pct --controller FSPID
  fspid campaign rare drawn.toml --fails overshoot_pct
On a cluster: --engine ray, dask, slurm or command; or by hand: plan once, fly each shard anywhere, merge:
  fspid campaign plan drawn.toml --runs 1000000 --out many
  fspid campaign shard 0 --out many
  fspid campaign merge --out many
  fspid campaign report many                       # from the parts, merged or not
More, with every distribution: fspid campaign --help";

const LONG_HELP: &str = "A dispersion in the scenario:
  [[dispersion]]
  path = \"plant.preset.numerator[0]\"   # as --set names it; or paths = [...], which get one draw
  name = \"elevator_effectiveness\"      # in results; the path if left out
  distribution = \"normal\"
  mean = 1.0
  standard_deviation = 0.1
  lower = 0.7                          # nothing beyond is drawn
  upper = 1.3
  relative = true                      # draws are factors of the number in the scenario

Distributions:
  normal       mean, standard_deviation; lower, upper if it is cut
  uniform      lower, upper
  log-uniform  lower, upper
  choice       values = [...]; weights = [...] if they are not equally likely
  seed         a whole number for each run, as noise and turbulence take it
  correlated   paths, means, standard_deviations, correlation = [[1.0, 0.5], [0.5, 1.0]];
               lowers, uppers if they are cut

Sampling:
  random           independent points: what confidence intervals assume
  latin-hypercube  each range of each number evenly filled; means are surer
  sobol            evenly filled in several numbers at once; best with 2^n runs

In the folder: campaign.json (the plan), shards/ (its parts), campaign.parquet (all rows: one for each
run and controller; docs/campaigns.md says what the columns are). Interrupted, run it again: what is
whole stays, and the merged file has the same bytes as without the interruption.

Examples:
  fspid campaign run drawn.toml --runs 10000 --seed 1 --out robust
  fspid campaign run --out robust                  # go on where it was interrupted
  fspid campaign report robust/campaign.parquet --out robust.html
  fspid campaign replay robust --run 137 --trace run-137.csv
  fspid campaign search drawn.toml --measure overshoot_pct --controller FSPID --budget 5000
  fspid campaign rare drawn.toml --fails overshoot_pct --flights 100000 --most 1e-6
  python -c \"import pandas; print(pandas.read_parquet('robust/campaign.parquet').describe())\"
Exit codes: 0 done, failed flights are results; 2 the input is wrong; 4 the output could not be written.";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Run(arguments) => run::run(arguments),
        Command::Plan(arguments) => plan::run(arguments),
        Command::Shard(arguments) => shard::run(arguments),
        Command::Merge(arguments) => merge::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Replay(arguments) => replay::run(arguments),
        Command::Search(arguments) => search::run(arguments),
        Command::Rare(arguments) => rare::run(arguments),
    }
}

/// How the points of a campaign are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Spread {
    /// Independent points.
    Random,
    /// Every range of every number evenly filled.
    LatinHypercube,
    /// Evenly filled in several numbers at once.
    Sobol,
}

impl From<Spread> for Sampling {
    fn from(spread: Spread) -> Self {
        match spread {
            Spread::Random => Self::Random,
            Spread::LatinHypercube => Self::LatinHypercube,
            Spread::Sobol => Self::Sobol,
        }
    }
}

/// What is planned.
#[derive(Debug, Args)]
struct Planned {
    /// Set a value before anything is drawn, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// How many runs; 1000 if left out.
    #[arg(long, value_parser = count::<u64>(&counts::RUNS))]
    runs: Option<u64>,
    /// Seed of everything that is drawn; 1 if left out.
    #[arg(long)]
    seed: Option<u64>,
    /// How the drawn points are spread; at random if left out.
    #[arg(long, value_enum)]
    sampling: Option<Spread>,
    /// Runs of a shard, the least that an interruption can lose; by default a second or two of flights, and
    /// less of a small campaign on other engines.
    #[arg(long, value_name = "RUNS", value_parser = count::<u64>(&counts::SHARD_RUNS))]
    shard_runs: Option<u64>,
}

impl Planned {
    /// An option that says something, if one does.
    fn given(&self) -> Option<&'static str> {
        let options = [
            (!self.overrides.is_empty(), "--set"),
            (self.beside.is_given(), "--library or --fmu"),
            (self.runs.is_some(), "--runs"),
            (self.seed.is_some(), "--seed"),
            (self.sampling.is_some(), "--sampling"),
            (self.shard_runs.is_some(), "--shard-runs"),
        ];
        options.into_iter().find(|(given, _)| *given).map(|(_, option)| option)
    }

    /// Plans it for a folder, cut for whoever flies it where nobody asks for a number. Nothing is written.
    fn campaign(&self, scenario: &Path, folder: &Folder, cut: Shards) -> Result<Campaign, Failure> {
        let overrides = self.beside.overrides(&self.overrides)?;
        let question = Question {
            scenario,
            overrides: &overrides,
            runs: self.runs.unwrap_or(USUAL_RUNS),
            seed: self.seed.unwrap_or(USUAL_SEED),
            sampling: self.sampling.unwrap_or(Spread::Random).into(),
            shards: self.shard_runs.map_or(cut, Shards::Of),
        };
        let campaign = fspid_campaign::plan(&question, folder).map_err(failure)?;
        for warning in &campaign.template().study().warnings {
            note(format_args!("warning: {warning}"));
        }
        Ok(campaign)
    }
}

/// The folder of a campaign that is planned.
#[derive(Debug, Args)]
struct PlannedFolder {
    /// The campaign's folder.
    #[arg(long, value_name = "DIR")]
    out: argument::Folder,
}

impl PlannedFolder {
    fn folder(&self) -> Folder {
        Folder::new(&self.out)
    }

    /// The campaign in the folder.
    fn campaign(&self) -> Result<Campaign, Failure> {
        planned(&self.folder())
    }
}

/// The campaign that is planned in a folder.
fn planned(folder: &Folder) -> Result<Campaign, Failure> {
    let plan = folder.plan().map_err(failure)?;
    Campaign::new(plan, folder.path()).map_err(failure)
}

/// Refuses runs that take more memory than there is, so many of which are flown one after the other or at once.
fn fits(campaign: &Campaign, threads: usize, runs: u64) -> Result<(), Failure> {
    memory::asked(flights(campaign, threads, runs))
}

/// The same of runs whose rows are kept until all of them are written.
fn fits_as_a_shard(campaign: &Campaign, threads: usize, runs: u64) -> Result<(), Failure> {
    let rows = runs.saturating_mul(campaign.rows().of_run() as u64);
    memory::asked(flights(campaign, threads, runs).with_rows(rows))
}

fn flights(campaign: &Campaign, threads: usize, runs: u64) -> Needed {
    let samples = campaign.template().study().scenario.timing.rows();
    Needed::for_flights(samples, memory::threads(threads)).of_at_most(runs)
}

/// A failure with the exit code that it deserves.
fn failure(error: CampaignError) -> Failure {
    match error.is_of_output() {
        true => Failure::output(error),
        false => Failure::input(error),
    }
}
