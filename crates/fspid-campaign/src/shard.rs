//! Parts of a campaign: a Parquet file for a range of runs, whole or not there.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use fspid_study::output;
use rayon::prelude::*;

use crate::campaign::{Campaign, Progress};
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::Plan;
use crate::range::Range;
use crate::table::{ColumnTable, Reader, Schema, TableError, Writer};

/// Key of the metadata that names the campaign.
pub const CAMPAIGN_KEY: &str = "fspid.campaign";
/// Key of the metadata that names the program and its version.
pub const PROGRAM_KEY: &str = "fspid.program";
/// Key of the first run of a part.
const FIRST_KEY: &str = "fspid.first_run";
/// Key of the run after the last of a part.
const END_KEY: &str = "fspid.end_run";

/// What became of a shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Done {
    /// It was flown now.
    Flown,
    /// It was there already.
    Found,
}

/// Flies the shard with this number and writes its part, unless a whole one is there.
///
/// # Errors
/// No such shard; a part that cannot be written.
pub fn fly(
    folder: &Folder,
    campaign: &Campaign,
    number: u64,
    progress: &Progress,
) -> Result<Done, CampaignError> {
    let plan = campaign.plan();
    let most = plan.shards().saturating_sub(1);
    let range = plan.shard(number).ok_or(CampaignError::NoShard { found: number, most })?;
    let path = folder.shard_path(range);
    if is_whole(&path, campaign, range) {
        progress.add_found(range.end - range.first);
        return Ok(Done::Found);
    }
    let scenario = &campaign.template().study().scenario;
    scenario.start_externals()?;
    let table = campaign.fly(range, progress)?;
    // What flew last was still what the plan names.
    scenario.start_externals()?;
    write(&path, campaign, range, &table)?;
    Ok(Done::Flown)
}

/// Shards whose parts are not there, or not whole. Every cell is read, on the threads of the pool that this is called in.
#[must_use]
pub fn missing(folder: &Folder, campaign: &Campaign) -> Vec<u64> {
    let plan = campaign.plan();
    let is_there = |number: &u64| {
        plan.shard(*number)
            .is_some_and(|range| is_whole(&folder.shard_path(range), campaign, range))
    };
    (0..plan.shards()).into_par_iter().filter(|number| !is_there(number)).collect()
}

/// Takes in the part of a shard that was flown elsewhere, if it is what it should be in every byte.
///
/// # Errors
/// No such shard, another one, or one of another campaign; a part that cannot be written.
pub fn put(
    folder: &Folder,
    campaign: &Campaign,
    number: u64,
    part: &[u8],
) -> Result<(), CampaignError> {
    let plan = campaign.plan();
    let most = plan.shards().saturating_sub(1);
    let range = plan.shard(number).ok_or(CampaignError::NoShard { found: number, most })?;
    let path = folder.shard_path(range);
    // What a worker answers beside it may be damaged.
    if is_whole(&path, campaign, range) {
        return Ok(());
    }
    output::write(&path, part).map_err(|error| CampaignError::from(error).of_writing(&path))?;
    if is_whole(&path, campaign, range) && is_as_written(&path, part, campaign, range) {
        return Ok(());
    }
    let _ = std::fs::remove_file(&path);
    let reason = format!("what a worker answered is not shard {number} of this campaign");
    Err(CampaignError::Foreign { path, reason })
}

/// True for a part that holds what it should, in every cell.
fn is_whole(path: &Path, campaign: &Campaign, range: Range) -> bool {
    let Ok(part) = Part::open(path) else {
        return false;
    };
    let rows = range.end.saturating_sub(range.first) * campaign.rows().of_run() as u64;
    part.range == range
        && part.refusal(campaign.plan(), campaign.rows().schema()).is_none()
        && part.reader.rows() as u64 == rows
        && part.reader.verify().is_ok()
}

/// True for the bytes that this program would write of the part's rows. The digest of the rows says nothing of what
/// stands around them, statistics say, which others go by when they look for rows.
fn is_as_written(path: &Path, part: &[u8], campaign: &Campaign, range: Range) -> bool {
    let again = || {
        let tables = Reader::open(path)?.tables().collect::<Result<Vec<_>, _>>()?;
        written(Vec::with_capacity(part.len()), campaign, range, &tables)
    };
    again().is_ok_and(|bytes| bytes == part)
}

/// Writes a part: into a new file beside it first, flushed to the disk, then renamed.
fn write(
    path: &Path,
    campaign: &Campaign,
    range: Range,
    table: &ColumnTable,
) -> Result<(), CampaignError> {
    write_whole(path, |file| {
        written(file, campaign, range, std::slice::from_ref(table))?;
        Ok(())
    })
}

/// Writes the rows of a part, and which runs of which campaign they are of, into `sink`.
fn written<W: Write + Send>(
    sink: W,
    campaign: &Campaign,
    range: Range,
    tables: &[ColumnTable],
) -> Result<W, TableError> {
    let text = |key: &str, value: String| (key.to_owned(), value);
    let mut metadata = provenance(campaign.plan());
    metadata.push(text(FIRST_KEY, range.first.to_string()));
    metadata.push(text(END_KEY, range.end.to_string()));
    let mut writer = Writer::new(sink, campaign.rows().schema(), &metadata)?;
    tables.iter().try_for_each(|table| writer.write(table))?;
    Ok(writer.finish(&[])?.0)
}

/// What every file of a campaign says of where it is from.
pub(crate) fn provenance(plan: &Plan) -> Vec<(String, String)> {
    vec![(CAMPAIGN_KEY.to_owned(), plan.id()), (PROGRAM_KEY.to_owned(), plan.program.clone())]
}

/// Writes a file of a campaign, whole or not at all.
pub(crate) fn write_whole<T>(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<&File>) -> Result<T, CampaignError>,
) -> Result<T, CampaignError> {
    output::write_by(path, contents).map_err(|error| error.of_writing(path))
}

/// A part of a campaign, opened.
#[derive(Debug)]
pub(crate) struct Part {
    pub(crate) reader: Reader,
    pub(crate) range: Range,
}

impl Part {
    /// Opens a part; its rows are not read yet.
    pub(crate) fn open(path: &Path) -> Result<Self, CampaignError> {
        let reader = Reader::open(path)?;
        let run = |key: &str| reader.metadata_value(key).and_then(|text| text.parse().ok());
        match (run(FIRST_KEY), run(END_KEY)) {
            (Some(first), Some(end)) if first < end => {
                Ok(Self { range: Range { first, end }, reader })
            }
            _ => {
                let reason = "it does not say which runs it holds".to_owned();
                Err(CampaignError::Foreign { path: path.to_owned(), reason })
            }
        }
    }

    /// Why this is no part of a campaign, if it is none.
    pub(crate) fn refusal(&self, plan: &Plan, schema: &Schema) -> Option<String> {
        for (key, value) in provenance(plan) {
            let found = self.reader.metadata_value(&key).unwrap_or("nothing");
            if found != value {
                return Some(format!("{key} is {found}; this campaign's is {value}"));
            }
        }
        if **self.reader.schema() != *schema {
            return Some("its columns are others".to_owned());
        }
        if self.range.end > plan.runs {
            return Some(format!("it holds {} of {} runs", self.range, plan.runs));
        }
        None
    }
}
