//! `fspid campaign plan`: fix what is flown, and in which parts.

use std::path::PathBuf;

use clap::Args;

use super::{Place, Planned};
use crate::exit::{Failure, print};

/// Plan a campaign without flying it: for machines that share the shards.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scenario file.
    scenario: PathBuf,
    #[command(flatten)]
    planned: Planned,
    #[command(flatten)]
    place: Place,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.place.folder();
    let campaign = arguments.planned.campaign(&arguments.scenario, &folder)?;
    let plan = campaign.plan();
    let last = plan.shards().saturating_sub(1);
    print(&format!(
        "{}: {} runs in {} shards, numbered 0 to {last}\ncampaign {}\n",
        folder.plan_path().display(),
        plan.runs,
        plan.shards(),
        plan.id(),
    ))
}
