//! `fspid campaign run`: fly all of it here.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::super::progress::Telling;
use super::super::{Format, interrupt};
use super::engine::{Asked, Cluster, Engine};
use super::progress::told;
use super::{Planned, PlannedFolder, failure, fits_as_a_shard, planned};
use crate::argument::{InFile, count};
use crate::exit::{Failure, note};
use fspid_campaign::table::{Digest, Reader};
use fspid_campaign::{Folder, local};
use fspid_scenario::count as counts;
use fspid_study::shell;

/// Plan, fly and merge a campaign, on this machine or on a cluster; again after an interruption, it goes on.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scenario file; left out, the campaign that is planned in the folder goes on.
    scenario: Option<InFile>,
    #[command(flatten)]
    planned: Planned,
    #[command(flatten)]
    place: PlannedFolder,
    #[command(flatten)]
    cluster: Cluster,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    /// Say nothing while flying.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.cluster.check_store()?;
    let folder = arguments.place.folder();
    let campaign = match &arguments.scenario {
        Some(scenario) => arguments.planned.campaign(scenario, &folder, arguments.cluster.cut())?,
        None => match arguments.planned.given() {
            None => planned(&folder)?,
            Some(option) => {
                return Err(Failure::input(format_args!(
                    "{option} goes with a scenario; without one the campaign in the folder goes on as it was planned"
                )));
            }
        },
    };
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let runs = campaign.plan().runs;
    if arguments.cluster.engine == Engine::Local {
        fits_as_a_shard(&campaign, arguments.threads, campaign.plan().shard_runs.min(runs))?;
    }
    if arguments.scenario.is_some() {
        folder.put_plan(campaign.plan()).map_err(failure)?;
    }
    interrupt::ends_with(format!(
        "interrupted; what is flown stays, and this goes on: fspid campaign run --out {}",
        shell::word(&folder.path().display().to_string())
    ));
    let digest = match arguments.cluster.engine {
        Engine::Local => {
            let fly = |progress: &_| local::run(&folder, &campaign, arguments.threads, progress);
            told(telling, runs, fly).map_err(failure)?.digest
        }
        _ => match arguments.cluster.ask(&folder, &campaign)? {
            Asked::Given(text, json) => return arguments.format.print(|| text, || json),
            Asked::Merged => merged_digest(&folder)?,
        },
    };
    let (merged, rows) = (folder.merged_path(), runs * campaign.rows().of_run() as u64);
    let merged = merged.display();
    arguments.format.print(
        || format!("{merged}: {runs} runs, {rows} rows\ndigest {digest}\n"),
        || {
            json!({
                "schema": 1, "file": merged.to_string(), "runs": runs, "rows": rows,
                "digest": digest.to_string(),
            })
        },
    )?;
    if !arguments.quiet && matches!(arguments.format, Format::Text) {
        note(format_args!("next: {}", reporting(folder.path())));
    }
    Ok(())
}

/// The command that tells what a campaign has found.
fn reporting(folder: &Path) -> String {
    let shown = folder.display().to_string();
    // `.` and its like have no name.
    let page = folder.file_name().map_or_else(
        || PathBuf::from("campaign.html"),
        |name| folder.with_file_name(format!("{}.html", name.to_string_lossy())),
    );
    let page = page.display().to_string();
    format!("fspid campaign report {} --out {}", shell::word(&shown), shell::word(&page))
}

/// Digest of all rows that were merged.
fn merged_digest(folder: &Folder) -> Result<Digest, Failure> {
    let reader = Reader::open(folder.merged_path()).map_err(Failure::input)?;
    reader.verify().map_err(Failure::input)
}
