//! What can go wrong with a campaign.

use std::io;
use std::path::{Path, PathBuf};

use fspid_scenario::apart;
use fspid_scenario::count::CountError;
use fspid_scenario::file::{LoadError, Problems};
use fspid_study::output::{OutputError, in_words};
use thiserror::Error;

use crate::range::Range;
use crate::sample::SampleError;
use crate::table::TableError;

/// Why a campaign could not go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// The scenario is wrong.
    #[error("{0}")]
    Scenario(Problems),
    /// The scenario cannot be read.
    #[error("{0}")]
    Unreadable(#[from] LoadError),
    /// An external controller cannot be started.
    #[error(transparent)]
    NotStarted(#[from] fspid_sim::SimError),
    /// It was asked to stop; shards that were written stay.
    #[error(
        "stopped; what is flown stays, and the same campaign in the same folder goes on from there"
    )]
    Stopped,
    /// Nothing differs from run to run.
    #[error(
        "{path}: nothing differs from run to run\n    add what shall, for instance:\n\n        [[dispersion]]\n        path = \"controller[0].kp\"\n        distribution = \"uniform\"\n        lower = 0.8\n        upper = 1.2\n        relative = true\n"
    )]
    NothingDispersed {
        /// The scenario.
        path: String,
    },
    /// A requirement that cannot be asked of flights.
    #[error("{reason}")]
    NotOfFlights {
        /// Which, and why.
        reason: String,
    },
    /// A count beyond its limits.
    #[error("{0}")]
    Count(#[from] CountError),
    /// The points cannot be drawn.
    #[error("{0}")]
    Sample(#[from] SampleError),
    /// The scenario or a file that it names is not what was planned.
    #[error(
        "the text of {path} in the plan, or a file that it names, has changed since the campaign was planned; put it back, or plan anew in another folder"
    )]
    Changed {
        /// The scenario.
        path: String,
    },
    /// There is no plan in the folder, or it cannot be used.
    #[error("{}: {reason}", path.display())]
    Plan {
        /// Path of the plan.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A word that is not known.
    #[error("there is no {what} `{found}`{known}")]
    Unknown {
        /// What it should be.
        what: &'static str,
        /// The word.
        found: String,
        /// The word that was probably meant, and those that are known.
        known: String,
    },
    /// Another campaign is in the folder.
    #[error(
        "{}: another campaign is there ({difference}); name another folder, or remove that one",
        path.display()
    )]
    OtherCampaign {
        /// Path of its plan.
        path: PathBuf,
        /// What differs.
        difference: String,
    },
    /// Another process works in the folder.
    #[error("{}: another process is working in this folder; wait until it has ended", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A shard that there is not.
    #[error("there is no shard {found}; allowed is 0 to {most}")]
    NoShard {
        /// What was asked for.
        found: u64,
        /// The last one.
        most: u64,
    },
    /// A run that there is not.
    #[error("there is no run {found}; allowed is 0 to {most}")]
    NoRun {
        /// What was asked for.
        found: u64,
        /// The last one.
        most: u64,
    },
    /// A run that was not flown.
    #[error("run {run} was not flown: {reason}")]
    Refused {
        /// Which run.
        run: u64,
        /// Why its numbers make no scenario, or why that cannot be flown.
        reason: String,
    },
    /// Runs that no part holds.
    #[error(
        "{missing} are missing ({count} in all); fly them with `fspid campaign run` or `fspid campaign shard`"
    )]
    Gap {
        /// The first of them that belong together.
        missing: Range,
        /// All of them.
        count: u64,
    },
    /// Runs that two parts hold.
    #[error("{} and {} both hold {runs}; remove one of them", first.display(), second.display())]
    Overlap {
        /// One part.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// The runs.
        runs: Range,
    },
    /// A part that is not of this campaign, or is damaged.
    #[error("{}: {reason}; remove it, and its runs are flown again", path.display())]
    Foreign {
        /// The part.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A table cannot be read or written.
    #[error("{0}")]
    Table(#[from] TableError),
    /// A file cannot be written.
    #[error("{0}")]
    Output(#[from] OutputError),
    /// A file of the campaign cannot be written.
    #[error("cannot write {}: {reason}; what is whole stays, so that the campaign goes on when it is run again", path.display())]
    Write {
        /// Where.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file or folder cannot be used.
    #[error("{}: {reason}", path.display())]
    Io {
        /// Where.
        path: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// No threads can be had.
    #[error("the threads cannot be started: {0}")]
    Threads(String),
}

impl CampaignError {
    /// True where something could not be written; else the input is what is wrong.
    #[must_use]
    pub fn is_of_output(&self) -> bool {
        match self {
            Self::Output(error) => !error.is_clash(),
            Self::Io { .. } | Self::Write { .. } => true,
            _ => false,
        }
    }

    /// Refuses a file that is read here and was asked to be written.
    pub(crate) fn unless_apart(path: &Path) -> Result<(), Self> {
        let clash = |reason: apart::Clash| LoadError::Unreadable {
            path: path.display().to_string(),
            reason: reason.to_string(),
        };
        Ok(apart::reading_own(path).map_err(clash)?)
    }

    /// The same, with the file that could not be written where that is what is wrong.
    pub(crate) fn of_writing(self, path: &Path) -> Self {
        let reason = match &self {
            Self::Table(error @ (TableError::Write { .. } | TableError::Failed)) => reason(error),
            Self::Output(error) if !error.is_clash() => in_words(&error.reason),
            _ => return self,
        };
        Self::Write { path: path.to_owned(), reason }
    }
}

/// The reason of the system below a table's error, in words.
fn reason(error: &TableError) -> String {
    error.of_system().map_or_else(|| error.to_string(), in_words)
}
