//! A campaign flown on this machine: shard after shard on all threads, then merged.

use fspid_scenario::count::THREADS;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::campaign::{Campaign, Progress};
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::merge::merge;
use crate::range::Range;
use crate::shard::{self, Done};
use crate::table::Digest;

/// What became of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flown {
    /// Shards flown now.
    pub flown: u64,
    /// Shards that were there already.
    pub found: u64,
    /// Digest of all rows.
    pub digest: Digest,
}

/// Flies what is missing of a campaign and merges it. Interrupted and called again it goes on where it
/// was; at most the shards that were being flown are flown again.
///
/// # Errors
/// Another process in the folder; parts that cannot be written or merged.
pub fn run(
    folder: &Folder,
    campaign: &Campaign,
    threads: usize,
    progress: &Progress,
) -> Result<Flown, CampaignError> {
    in_threads(threads, || run_here(folder, campaign, progress, &mut |_| Ok(())))?
}

/// As [`run`], on all threads of the pool that this is called in. `done` is told of each shard once it is there; its error ends
/// the campaign, which goes on from there when it is called again.
///
/// # Errors
/// As [`run`], and that of `done`.
pub fn run_here(
    folder: &Folder,
    campaign: &Campaign,
    progress: &Progress,
    done: &mut (dyn FnMut(Range) -> Result<(), CampaignError> + Send),
) -> Result<Flown, CampaignError> {
    let _lock = folder.lock(true)?;
    folder.remove_unfinished()?;
    let (mut flown, mut found) = (0, 0);
    for number in 0..campaign.plan().shards() {
        match shard::fly(folder, campaign, number, progress)? {
            Done::Flown => flown += 1,
            Done::Found => found += 1,
        }
        campaign.plan().shard(number).map_or(Ok(()), &mut *done)?;
    }
    let digest = merge(folder, campaign, &folder.merged_path())?;
    Ok(Flown { flown, found, digest })
}

/// Calls a function in a pool of so many threads; 0 for as many as the machine has.
///
/// # Errors
/// More than a machine can have; [`CampaignError::Threads`].
pub fn in_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> Result<T, CampaignError> {
    Ok(pool(threads)?.install(work))
}

/// A pool of so many threads; 0 for as many as the machine has.
pub(crate) fn pool(threads: usize) -> Result<ThreadPool, CampaignError> {
    THREADS.check(threads)?;
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| CampaignError::Threads(error.to_string()))
}
