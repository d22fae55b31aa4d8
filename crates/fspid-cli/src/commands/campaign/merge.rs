//! `fspid campaign merge`: all parts in one file.

use std::path::PathBuf;

use clap::Args;

use super::{Place, failure};
use crate::exit::{Failure, print};

/// Merge the shards of a campaign: refuses gaps, overlaps, and parts of other campaigns.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    place: Place,
    /// Where to; `campaign.parquet` in the folder if left out.
    #[arg(long, value_name = "FILE.parquet")]
    to: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.place.folder();
    let campaign = arguments.place.campaign()?;
    let _lock = folder.lock(true).map_err(failure)?;
    let to = arguments.to.clone().unwrap_or_else(|| folder.merged_path());
    let digest = fspid_campaign::merge(&folder, &campaign, &to).map_err(failure)?;
    print(&format!("{}: {} runs\ndigest {digest}\n", to.display(), campaign.plan().runs))
}
