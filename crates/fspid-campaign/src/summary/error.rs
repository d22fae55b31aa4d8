//! Why there is no summary.

use std::path::PathBuf;

use thiserror::Error;

use super::data::Shards;
use crate::error::CampaignError;
use crate::range::Range;
use crate::statistics::StatisticsError;
use crate::table::{Kind, TableError};

/// Why a file cannot be summarised.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SummaryError {
    /// The file cannot be read, is damaged, or is no table of results.
    #[error("{0}")]
    Table(#[from] TableError),
    /// The file is a table of results, but not that of a whole campaign.
    #[error("{} is not the merged file of a campaign: {reason}", path.display())]
    NotMerged {
        /// Which file.
        path: PathBuf,
        /// What is different.
        reason: NotMerged,
    },
    /// The folder is none of a campaign, or its parts do not belong together.
    #[error("{0}")]
    Folder(Box<CampaignError>),
    /// Parts are missing, which is to be told or to be allowed.
    #[error(
        "{} of {} shards are there; {missing} are missing ({runs} in all): fly them with `fspid campaign run`, or ask with --incomplete for what is there",
        shards.found, shards.of
    )]
    Incomplete {
        /// Shards that are there.
        shards: Shards,
        /// The first runs that are missing.
        missing: Range,
        /// How many runs are missing.
        runs: u64,
    },
    /// The confidence is none.
    #[error("{0}")]
    Statistics(#[from] StatisticsError),
}

/// Why a table is not that of a whole campaign.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NotMerged {
    /// It is a part of one.
    #[error("it is a part of one; merge the parts with `fspid campaign merge`")]
    Part,
    /// Metadata that a merged file has.
    #[error("its metadata has no \"{key}\"")]
    NoKey {
        /// The key.
        key: &'static str,
    },
    /// The plan in its metadata cannot be read.
    #[error("the plan in its metadata cannot be read at {place}")]
    Plan {
        /// Where in the JSON.
        place: &'static str,
    },
    /// A column that every campaign has.
    #[error("it has no column \"{name}\" that holds {kind}")]
    NoColumn {
        /// Name of the column.
        name: String,
        /// What it should hold.
        kind: Kind,
    },
    /// Another number of rows than runs times controllers.
    #[error(
        "it has {found} rows; {runs} runs of {controllers} controllers leave {runs} × {controllers}"
    )]
    Rows {
        /// Rows of the file.
        found: u64,
        /// Runs of the plan.
        runs: u64,
        /// Controllers of the first run.
        controllers: u64,
    },
    /// A row that is not of the run and controller whose turn it is.
    #[error("row {row} is not of run {run} with controller \"{controller}\"")]
    Order {
        /// Which row, from 0.
        row: u64,
        /// The run whose turn it is.
        run: u64,
        /// The controller whose turn it is.
        controller: String,
    },
    /// A row without a value that every row has.
    #[error("row {row} has no \"{column}\"")]
    Empty {
        /// Which row, from 0.
        row: u64,
        /// Which column.
        column: &'static str,
    },
}
