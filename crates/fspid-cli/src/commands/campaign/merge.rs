//! `fspid campaign merge`: all parts in one file.

use clap::Args;
use serde_json::json;

use super::super::Format;
use super::{PlannedFolder, failure};
use crate::argument::{OutFile, written};
use crate::exit::Failure;

/// Merge the shards of a campaign: refuses gaps, overlaps, and parts of other campaigns.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    place: PlannedFolder,
    /// Where to; `campaign.parquet` in the folder if left out.
    #[arg(value_parser = written(&["parquet"]), long, value_name = "FILE.parquet")]
    to: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.place.folder();
    let campaign = arguments.place.campaign()?;
    let _lock = folder.lock(true).map_err(failure)?;
    let to = arguments.to.as_ref().map_or_else(|| folder.merged_path(), |to| to.to_path_buf());
    let digest = fspid_campaign::merge(&folder, &campaign, &to).map_err(failure)?;
    let (to, runs) = (to.display(), campaign.plan().runs);
    arguments.format.print(
        || format!("{to}: {runs} runs\ndigest {digest}\n"),
        || json!({ "schema": 1, "file": to.to_string(), "runs": runs, "digest": digest.to_string() }),
    )
}
