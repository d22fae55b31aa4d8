//! All parts of a campaign in one file, the same bytes whatever the parts are.

use std::path::Path;

use rayon::prelude::*;
use serde_json::json;

use crate::campaign::Campaign;
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::parts::{self, Parts};
use crate::plan::Plan;
use crate::rows::RUN;
use crate::shard::{provenance, write_whole};
use crate::table::{ColumnTable, Digest, Digester, Values, Writer};

/// Key of the metadata that holds the plan: everything but how it was cut into shards.
pub const PLAN_KEY: &str = "fspid.plan";

/// Merges the parts in a campaign's folder into `out`. Memory does not grow with their number.
///
/// # Errors
/// Gaps, overlaps, parts of other campaigns, damaged parts; a file that cannot be written.
pub fn merge(folder: &Folder, campaign: &Campaign, out: &Path) -> Result<Digest, CampaignError> {
    let plan = campaign.plan();
    let parts = Parts::of(folder, plan, Some(campaign.rows().schema()))?.whole()?;
    let mut metadata = provenance(plan);
    metadata.push((PLAN_KEY.to_owned(), plan_text(plan)));
    write_whole(out, |file| {
        let mut writer = Writer::new(file, campaign.rows().schema(), &metadata)?;
        for some in parts.chunks(AT_ONCE) {
            // Reading and checking take longest, and do not depend on each other.
            let read: Vec<Result<Vec<ColumnTable>, CampaignError>> =
                some.par_iter().map(|part| rows_of(&part.path, campaign)).collect();
            for tables in read {
                tables?.iter().try_for_each(|table| writer.write(table))?;
            }
        }
        let (_, digest) = writer.finish(&[])?;
        Ok(digest)
    })
}

/// What a merged file says of its plan; the same wherever it was flown and however it was cut.
pub(crate) fn plan_text(plan: &Plan) -> String {
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

/// Parts that are in memory together, and read side by side.
const AT_ONCE: usize = 4;

/// The rows of a part; refuses it if they are not what it says.
fn rows_of(path: &Path, campaign: &Campaign) -> Result<Vec<ColumnTable>, CampaignError> {
    let part = parts::opened(path)?;
    let foreign = |reason: String| CampaignError::Foreign { path: path.to_owned(), reason };
    let mut digester = Digester::new(part.reader.schema());
    let of_run = campaign.rows().of_run() as u64;
    let mut row = part.range.first * of_run;
    let mut tables = Vec::new();
    for table in part.reader.tables() {
        let table = table.map_err(|error| foreign(error.to_string()))?;
        check_runs(&table, &mut row, of_run).map_err(foreign)?;
        digester.update(&table);
        tables.push(table);
    }
    if row != part.range.end * of_run {
        return Err(foreign("it has too few rows".to_owned()));
    }
    if digester.finish() != part.reader.digest() {
        return Err(foreign("its rows are not those that its digest names".to_owned()));
    }
    Ok(tables)
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
