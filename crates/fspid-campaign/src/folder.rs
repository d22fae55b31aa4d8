//! The folder of a campaign: its plan, its parts, its lock.
//!
//! ```text
//! DIR/campaign.json           the plan
//! DIR/shards/0-8191.parquet   runs 0 to 8191
//! DIR/campaign.parquet        all runs, once merged
//! DIR/lock                    held while a process works here
//! ```

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use fspid_scenario::file::read_text;
use fspid_study::output::{self, is_unfinished};

use crate::error::CampaignError;
use crate::plan::Plan;
use crate::range::Range;
use crate::table;

/// A campaign's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    path: PathBuf,
}

/// A folder that nobody else may work in, as long as this lives.
#[derive(Debug)]
pub struct Lock {
    /// Closing it frees it, also when the process is killed.
    _file: File,
}

impl Folder {
    /// The folder at a path; nothing is read yet.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the plan.
    #[must_use]
    pub fn plan_path(&self) -> PathBuf {
        self.path.join("campaign.json")
    }

    /// Path of the merged rows.
    #[must_use]
    pub fn merged_path(&self) -> PathBuf {
        self.path.join("campaign.parquet")
    }

    /// Folder of the parts.
    #[must_use]
    pub fn shards_path(&self) -> PathBuf {
        self.path.join("shards")
    }

    /// Folder of the scores of a search for rare failures.
    #[must_use]
    pub fn flights_path(&self) -> PathBuf {
        self.path.join("flights")
    }

    /// Path of the part with these runs.
    #[must_use]
    pub fn shard_path(&self, range: Range) -> PathBuf {
        let name = format!("{:09}-{:09}.parquet", range.first, range.end.saturating_sub(1));
        self.shards_path().join(name)
    }

    /// The plan in the folder.
    ///
    /// # Errors
    /// No plan there, or one that cannot be used.
    pub fn plan(&self) -> Result<Plan, CampaignError> {
        let path = self.plan_path();
        let failed = |reason| CampaignError::Plan { path: path.clone(), reason };
        if !path.exists() {
            let reason = "there is no campaign here; begin with `fspid campaign plan` or `run`";
            return Err(failed(reason.to_owned()));
        }
        let text = read_text(&path)?;
        let plan = Plan::from_json(&text).map_err(failed)?;
        if plan.program != Plan::this_program() {
            let (theirs, ours) = (&plan.program, Plan::this_program());
            return Err(failed(format!(
                "planned by {theirs}; this is {ours}, whose numbers may differ"
            )));
        }
        Ok(plan)
    }

    /// Puts a plan into the folder; one that is the same already stays.
    ///
    /// # Errors
    /// Another campaign or another process in the folder, or a folder that cannot be written.
    pub fn put_plan(&self, plan: &Plan) -> Result<(), CampaignError> {
        table::supported()?;
        let path = self.plan_path();
        output::make_folder(&self.shards_path())?;
        // Two processes that begin at once would else each believe its own plan.
        let _lock = self.lock(true)?;
        if path.exists() {
            let found = self.plan()?;
            let difference = difference(&found, plan);
            return match difference {
                None => Ok(()),
                Some(difference) => Err(CampaignError::OtherCampaign { path, difference }),
            };
        }
        output::write(&path, format!("{:#}\n", plan.json()))?;
        Ok(())
    }

    /// Keeps other processes out, or says that one is here already. `alone` keeps out those as well
    /// that fly single shards.
    ///
    /// # Errors
    /// [`CampaignError::Busy`], or a folder that cannot be written.
    pub fn lock(&self, alone: bool) -> Result<Lock, CampaignError> {
        let path = self.path.join("lock");
        self.hold(lock_file(&path)?, alone)
    }

    /// Keeps other processes away from one shard.
    ///
    /// # Errors
    /// As [`lock`](Self::lock).
    pub fn lock_shard(&self, range: Range) -> Result<Lock, CampaignError> {
        // A plan that was sent on may have come without its empty folder.
        output::make_folder(&self.shards_path())?;
        let path = self.shard_path(range).with_extension("lock");
        self.hold(lock_file(&path)?, true)
    }

    fn hold(&self, file: File, alone: bool) -> Result<Lock, CampaignError> {
        let held = if alone { file.try_lock() } else { file.try_lock_shared() };
        match held {
            Ok(()) => Ok(Lock { _file: file }),
            Err(TryLockError::WouldBlock) => Err(CampaignError::Busy { path: self.path.clone() }),
            // A file system without locks: results are whole all the same, since parts are renamed.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                Ok(Lock { _file: file })
            }
            Err(TryLockError::Error(reason)) => {
                Err(CampaignError::Io { path: self.path.clone(), reason })
            }
        }
    }

    /// Every part in the folder, in the order of their names.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn parts(&self) -> Result<Vec<PathBuf>, CampaignError> {
        let is_part = |path: &PathBuf| path.extension().is_some_and(|end| end == "parquet");
        let mut parts: Vec<PathBuf> = self.files()?.into_iter().filter(is_part).collect();
        parts.sort();
        Ok(parts)
    }

    /// Refuses to go on where a file of the campaign was asked to be written for something else.
    ///
    /// # Errors
    /// The file; a folder that cannot be read.
    pub fn keep_apart(&self) -> Result<(), CampaignError> {
        let parts = if self.shards_path().is_dir() { self.parts()? } else { Vec::new() };
        let own = [self.plan_path(), self.merged_path(), self.path.join("lock")];
        own.iter().chain(&parts).try_for_each(|path| CampaignError::unless_apart(path))
    }

    /// Removes what interrupted processes left behind. Only for who holds the folder alone.
    ///
    /// # Errors
    /// A folder that cannot be read or written.
    pub fn remove_unfinished(&self) -> Result<(), CampaignError> {
        for path in self.files()? {
            if is_unfinished(path.file_name().unwrap_or_default()) || is_lock(&path) {
                fs::remove_file(&path).map_err(|reason| CampaignError::Io { path, reason })?;
            }
        }
        Ok(())
    }

    fn files(&self) -> Result<Vec<PathBuf>, CampaignError> {
        let folder = self.shards_path();
        let failed = |reason| CampaignError::Io { path: folder.clone(), reason };
        let entries = fs::read_dir(&folder).map_err(failed)?;
        entries.map(|entry| entry.map(|it| it.path()).map_err(failed)).collect()
    }
}

/// The file that a lock is held on; a pipe of that name would wait for somebody who reads.
fn lock_file(path: &Path) -> Result<File, CampaignError> {
    let failed = |reason| CampaignError::Io { path: path.to_owned(), reason };
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(failed(io::Error::other("it is no regular file")));
    }
    CampaignError::unless_apart(path)?;
    File::options().create(true).append(true).open(path).map_err(failed)
}

/// True for the lock of a shard; a file of a user that ends so is none.
fn is_lock(path: &Path) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit());
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let is_range =
        stem.split_once('-').is_some_and(|(one, other)| is_number(one) && is_number(other));
    let is_empty = || path.symlink_metadata().is_ok_and(|it| it.is_file() && it.len() == 0);
    is_range && path.extension().is_some_and(|end| end == "lock") && is_empty()
}

/// In what two plans differ, in words.
fn difference(one: &Plan, other: &Plan) -> Option<String> {
    let numbers = [
        ("runs", one.runs, other.runs),
        ("seed", one.seed, other.seed),
        ("runs in a shard", one.shard_runs, other.shard_runs),
    ];
    let numbers = numbers
        .into_iter()
        .filter(|(_, one, other)| one != other)
        .map(|(what, one, other)| format!("{what}: {one} there, {other} here"));
    let sampling = (one.sampling != other.sampling).then(|| {
        format!("sampling: {} there, {} here", one.sampling.name(), other.sampling.name())
    });
    let scenario = (one.scenario_digest != other.scenario_digest)
        .then(|| "the scenario or its changes differ".to_owned());
    let found: Vec<String> = numbers.chain(sampling).chain(scenario).collect();
    (!found.is_empty()).then(|| found.join("; "))
}
