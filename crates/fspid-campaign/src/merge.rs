//! All parts of a campaign in one file, the same bytes whatever the parts are.

use std::path::Path;

use serde_json::json;

use crate::campaign::Campaign;
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::Plan;
use crate::range::Range;
use crate::rows::RUN;
use crate::shard::{Part, provenance, write_whole};
use crate::table::{ColumnTable, Digest, Digester, Values, Writer};

/// Key of the metadata that holds the plan: everything but how it was cut into shards.
pub const PLAN_KEY: &str = "fspid.plan";

/// Merges the parts in a campaign's folder into `out`. Memory does not grow with their number.
///
/// # Errors
/// Gaps, overlaps, parts of other campaigns, damaged parts; a file that cannot be written.
pub fn merge(folder: &Folder, campaign: &Campaign, out: &Path) -> Result<Digest, CampaignError> {
    let parts = parts(folder, campaign)?;
    let plan = campaign.plan();
    let mut metadata = provenance(plan);
    metadata.push((PLAN_KEY.to_owned(), plan_text(plan)));
    write_whole(out, |file| {
        let mut writer = Writer::new(file, campaign.rows().schema(), &metadata)?;
        for part in &parts {
            copy(part, campaign, &mut writer)?;
        }
        let (_, digest) = writer.finish(&[])?;
        Ok(digest)
    })
}

/// What a merged file says of its plan; the same wherever it was flown and however it was cut.
fn plan_text(plan: &Plan) -> String {
    json!({
        "runs": plan.runs,
        "seed": plan.seed.to_string(),
        "sampling": plan.sampling.name(),
        "scenario_digest": plan.scenario_digest,
        "changes": plan.overrides,
        "scenario": plan.scenario_text,
    })
    .to_string()
}

/// The parts in order of their runs, after they were found to be all, and of this campaign.
fn parts(folder: &Folder, campaign: &Campaign) -> Result<Vec<Part>, CampaignError> {
    let mut parts = Vec::new();
    for path in folder.parts()? {
        let foreign = |reason| CampaignError::Foreign { path: path.clone(), reason };
        let part = Part::open(&path).map_err(|error| match error {
            CampaignError::Table(error) => foreign(error.to_string()),
            error => error,
        })?;
        if let Some(reason) = part.refusal(campaign) {
            return Err(foreign(reason));
        }
        parts.push(part);
    }
    parts.sort_by_key(|part| part.range);
    check_coverage(&parts, campaign.plan().runs)?;
    Ok(parts)
}

/// Refuses overlaps and gaps.
fn check_coverage(parts: &[Part], runs: u64) -> Result<(), CampaignError> {
    let mut gaps: Vec<Range> = Vec::new();
    let mut next = 0;
    for (index, part) in parts.iter().enumerate() {
        let range = part.range;
        if range.first < next
            && let Some(before) = index.checked_sub(1).and_then(|index| parts.get(index))
        {
            return Err(CampaignError::Overlap {
                first: before.reader.path().to_owned(),
                second: part.reader.path().to_owned(),
                runs: Range { first: range.first, end: next.min(range.end) },
            });
        }
        if range.first > next {
            gaps.push(Range { first: next, end: range.first });
        }
        next = range.end;
    }
    if next < runs {
        gaps.push(Range { first: next, end: runs });
    }
    let count = gaps.iter().map(|gap| gap.end - gap.first).sum();
    gaps.first().map_or(Ok(()), |&missing| Err(CampaignError::Gap { missing, count }))
}

/// Copies the rows of a part, and refuses it if they are not what it says.
fn copy<W: std::io::Write + Send>(
    part: &Part,
    campaign: &Campaign,
    writer: &mut Writer<W>,
) -> Result<(), CampaignError> {
    let path = part.reader.path();
    let foreign = |reason: String| CampaignError::Foreign { path: path.to_owned(), reason };
    let mut digester = Digester::new(part.reader.schema());
    let of_run = campaign.rows().of_run() as u64;
    let mut row = part.range.first * of_run;
    for table in part.reader.tables() {
        let table = table.map_err(|error| foreign(error.to_string()))?;
        check_runs(&table, &mut row, of_run).map_err(foreign)?;
        digester.update(&table);
        writer.write(&table)?;
    }
    if row != part.range.end * of_run {
        return Err(foreign("it has too few rows".to_owned()));
    }
    if digester.finish() != part.reader.digest() {
        return Err(foreign("its rows are not those that its digest names".to_owned()));
    }
    Ok(())
}

/// Checks that the rows are those of the next runs.
fn check_runs(table: &ColumnTable, row: &mut u64, of_run: u64) -> Result<(), String> {
    let Ok(Values::Integer(runs)) = table.column(RUN) else {
        return Err("it has no runs".to_owned());
    };
    for run in runs {
        let expected = *row / of_run;
        if run.and_then(|run| u64::try_from(run).ok()) != Some(expected) {
            return Err(format!("a row is of run {run:?} where run {expected} should be"));
        }
        *row += 1;
    }
    Ok(())
}
