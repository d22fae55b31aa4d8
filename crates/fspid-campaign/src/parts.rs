//! The parts in a campaign's folder, looked at and closed again: of a hundred thousand, no process may hold all open.

use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;

use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::Plan;
use crate::range::Range;
use crate::shard::Part;
use crate::table::Schema;

/// A part that was looked at.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    pub(crate) path: PathBuf,
    pub(crate) range: Range,
    pub(crate) rows: usize,
}

/// Parts in the order of their runs, none of which another one holds.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub(crate) seen: Vec<Seen>,
    pub(crate) gaps: Vec<Range>,
}

impl Parts {
    /// Looks at all parts in a folder. Without a `schema`, all must have that of the first one.
    ///
    /// # Errors
    /// Overlaps, parts of other campaigns, damaged parts.
    pub(crate) fn of(
        folder: &Folder,
        plan: &Plan,
        schema: Option<&Arc<Schema>>,
    ) -> Result<Self, CampaignError> {
        let paths = folder.parts()?;
        let schema = match (schema, paths.first()) {
            (Some(schema), _) => Some(Arc::clone(schema)),
            (None, Some(first)) => Some(Arc::clone(opened(first)?.reader.schema())),
            (None, None) => None,
        };
        // All are looked at: which one is told must not depend on the threads.
        let looks: Vec<Result<Seen, CampaignError>> =
            paths.into_par_iter().map(|path| look(path, plan, schema.as_ref())).collect();
        let mut seen = looks.into_iter().collect::<Result<Vec<_>, _>>()?;
        seen.sort_by_key(|part| part.range);
        let gaps = gaps(&seen, plan.runs)?;
        Ok(Self { seen, gaps })
    }

    /// Refuses gaps.
    pub(crate) fn whole(self) -> Result<Vec<Seen>, CampaignError> {
        let count = self.missing_runs();
        match self.gaps.first() {
            None => Ok(self.seen),
            Some(&missing) => Err(CampaignError::Gap { missing, count }),
        }
    }

    /// How many runs are in no part.
    pub(crate) fn missing_runs(&self) -> u64 {
        self.gaps.iter().map(|gap| gap.end - gap.first).sum()
    }

    /// How many planned shards are there as a whole.
    pub(crate) fn shards(&self, plan: &Plan) -> u64 {
        let size = plan.shard_runs.max(1);
        let (mut missing, mut next) = (0, 0);
        for gap in &self.gaps {
            let first = (gap.first / size).max(next);
            next = next.max(gap.end.div_ceil(size));
            missing += next.saturating_sub(first);
        }
        plan.shards() - missing
    }
}

/// Opens a part; a table that it is not is told as one that does not belong here.
pub(crate) fn opened(path: &std::path::Path) -> Result<Part, CampaignError> {
    CampaignError::unless_apart(path)?;
    Part::open(path).map_err(|error| match error {
        CampaignError::Table(error) => {
            CampaignError::Foreign { path: path.to_owned(), reason: error.to_string() }
        }
        error => error,
    })
}

fn look(path: PathBuf, plan: &Plan, schema: Option<&Arc<Schema>>) -> Result<Seen, CampaignError> {
    let part = opened(&path)?;
    let schema = schema.unwrap_or_else(|| part.reader.schema());
    if let Some(reason) = part.refusal(plan, schema) {
        return Err(CampaignError::Foreign { path, reason });
    }
    Ok(Seen { range: part.range, rows: part.reader.rows(), path })
}

/// Runs that no part holds; refuses overlaps.
fn gaps(parts: &[Seen], runs: u64) -> Result<Vec<Range>, CampaignError> {
    let mut gaps: Vec<Range> = Vec::new();
    let mut next = 0;
    let mut before: Option<&Seen> = None;
    for part in parts {
        let range = part.range;
        if let (true, Some(before)) = (range.first < next, before) {
            return Err(CampaignError::Overlap {
                first: before.path.clone(),
                second: part.path.clone(),
                runs: Range { first: range.first, end: next.min(range.end) },
            });
        }
        if range.first > next {
            gaps.push(Range { first: next, end: range.first });
        }
        (next, before) = (range.end, Some(part));
    }
    if next < runs {
        gaps.push(Range { first: next, end: runs });
    }
    Ok(gaps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Sampling;

    fn plan(runs: u64, shard_runs: u64) -> Plan {
        Plan {
            scenario_text: String::new(),
            scenario_path: String::new(),
            scenario_folder: PathBuf::new(),
            scenario_digest: String::new(),
            overrides: Vec::new(),
            sampling: Sampling::Random,
            runs,
            seed: 1,
            shard_runs,
            program: Plan::this_program(),
        }
    }

    #[test]
    fn a_shard_that_lacks_a_run_is_not_there_and_is_counted_once() {
        let shards = |gaps: &[(u64, u64)]| {
            let gaps = gaps.iter().map(|&(first, end)| Range { first, end }).collect();
            Parts { seen: Vec::new(), gaps }.shards(&plan(100, 10))
        };
        assert_eq!(shards(&[]), 10);
        assert_eq!(shards(&[(0, 100)]), 0);
        assert_eq!(shards(&[(3, 4), (5, 6)]), 9);
        assert_eq!(shards(&[(0, 10), (19, 21), (25, 26)]), 7);
        assert_eq!(shards(&[(95, 100)]), 9);
    }
}
