//! `fspid campaign shard`: fly one part.

use clap::Args;
use serde_json::json;

use super::super::progress::Telling;
use super::super::{Format, interrupt};
use super::progress::told;
use super::{PlannedFolder, failure, fits_as_a_shard};
use crate::argument::count;
use crate::exit::Failure;
use fspid_campaign::shard::{self, Done};
use fspid_campaign::{CampaignError, local};
use fspid_scenario::count as counts;

/// Fly one shard of a planned campaign, unless it is there whole; several machines may do so at once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Number of the shard, from 0.
    number: u64,
    #[command(flatten)]
    place: PlannedFolder,
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
    let folder = arguments.place.folder();
    let campaign = arguments.place.campaign()?;
    let number = arguments.number;
    let plan = campaign.plan();
    let most = plan.shards().saturating_sub(1);
    let range = plan.shard(number).ok_or(CampaignError::NoShard { found: number, most });
    let range = range.map_err(failure)?;
    fits_as_a_shard(&campaign, arguments.threads, range.end - range.first)?;
    let _shared = folder.lock(false).map_err(failure)?;
    let _alone = folder.lock_shard(range).map_err(failure)?;
    interrupt::ends_with(format!(
        "interrupted; whole shards stay, and this one is flown by the same command: {}",
        interrupt::command()
    ));
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let done = told(telling, range.end - range.first, |progress| {
        local::in_threads(arguments.threads, || shard::fly(&folder, &campaign, number, progress))?
    });
    let done = done.map_err(failure)?;
    let words = match done {
        Done::Flown => "flown",
        Done::Found => "there already",
    };
    let path = folder.shard_path(range);
    let path = path.display();
    arguments.format.print(
        || format!("{path}: {range}, {words}\n"),
        || {
            json!({
                "schema": 1, "file": path.to_string(), "first_run": range.first, "last_run": range.end - 1,
                "flown": matches!(done, Done::Flown),
            })
        },
    )
}
