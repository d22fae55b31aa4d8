//! `fspid campaign plan`: fix what is flown, and in which parts.

use clap::Args;
use serde_json::json;

use super::super::Format;
use super::{Planned, PlannedFolder, failure};
use crate::argument::InFile;
use crate::exit::Failure;
use fspid_campaign::Shards;
use fspid_diagnostics::digits::counted;

/// Plan a campaign without flying it: for machines that share the shards.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    #[command(flatten)]
    planned: Planned,
    #[command(flatten)]
    place: PlannedFolder,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.place.folder();
    let campaign = arguments.planned.campaign(&arguments.scenario, &folder, Shards::ForWorkers)?;
    folder.put_plan(campaign.plan()).map_err(failure)?;
    let plan = campaign.plan();
    let last = plan.shards().saturating_sub(1);
    let (path, shards) = (folder.plan_path(), plan.shards());
    arguments.format.print(
        || {
            format!(
                "{}: {} runs in {}, numbered 0 to {last}\ncampaign {}\n",
                path.display(),
                plan.runs,
                counted(shards as usize, "shard"),
                plan.id(),
            )
        },
        || {
            json!({
                "schema": 1, "plan": path.display().to_string(), "runs": plan.runs, "shards": shards,
                "campaign": plan.id().to_string(),
            })
        },
    )
}
