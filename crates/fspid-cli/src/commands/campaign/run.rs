//! `fspid campaign run`: fly all of it here.

use clap::{Args, ValueEnum};
use serde_json::json;

use super::super::progress::Telling;
use super::super::{Format, interrupt};
use super::progress::told;
use super::{Planned, PlannedFolder, failure, planned};
use crate::argument::InFile;
use crate::exit::Failure;
use fspid_campaign::local;
use fspid_study::shell;

/// Plan, fly and merge a campaign on this machine; again after an interruption, it goes on.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scenario file; left out, the campaign that is planned in the folder goes on.
    scenario: Option<InFile>,
    #[command(flatten)]
    planned: Planned,
    #[command(flatten)]
    place: PlannedFolder,
    /// Who flies. On a cluster: `campaign plan`, `campaign shard` and `campaign merge`.
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    engine: Engine,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Say nothing while flying.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Who flies a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// This machine, on its threads.
    Local,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.place.folder();
    let campaign = match &arguments.scenario {
        Some(scenario) => arguments.planned.campaign(scenario, &folder)?,
        None => match arguments.planned.given() {
            None => planned(&folder)?,
            Some(option) => {
                return Err(Failure::input(format_args!(
                    "{option} goes with a scenario; without one the campaign in the folder goes on as it was planned"
                )));
            }
        },
    };
    let Engine::Local = arguments.engine;
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let runs = campaign.plan().runs;
    interrupt::ends_with(format!(
        "interrupted; what is flown stays, and this goes on: fspid campaign run --out {}",
        shell::word(&folder.path().display().to_string())
    ));
    let flown =
        told(telling, runs, |progress| local::run(&folder, &campaign, arguments.threads, progress));
    let flown = flown.map_err(failure)?;
    let (merged, rows) = (folder.merged_path(), runs * campaign.rows().of_run() as u64);
    let (merged, digest) = (merged.display(), &flown.digest);
    arguments.format.print(
        || format!("{merged}: {runs} runs, {rows} rows\ndigest {digest}\n"),
        || {
            json!({
                "schema": 1, "file": merged.to_string(), "runs": runs, "rows": rows,
                "digest": digest.to_string(),
            })
        },
    )
}
