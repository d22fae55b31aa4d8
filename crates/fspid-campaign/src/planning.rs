//! Making a plan from what is written on a command line.

use std::path::{Component, Path, PathBuf};

use fspid_scenario::count::{self as counts, RUNS};
use fspid_scenario::file::{Extra, LoadError, Template, read_text};

use crate::campaign::Campaign;
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::{Plan, SHARD_RUNS, SLOW_SHARD_RUNS};
use crate::sample::Sampling;

/// What to plan.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The scenario file.
    pub scenario: &'a Path,
    /// Changes `path=value`.
    pub overrides: &'a [String],
    /// How many runs.
    pub runs: u64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// How points are chosen.
    pub sampling: Sampling,
    /// How runs are cut into shards.
    pub shards: Shards,
}

/// How many runs there are if nobody says.
pub const USUAL_RUNS: u64 = 1000;
/// The seed if nobody says.
pub const USUAL_SEED: u64 = 1;

/// How a campaign's runs are cut into shards, which changes nothing in its rows.
///
/// Whoever does not ask for a number goes on with the cut of the plan that is in the folder already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shards {
    /// So many runs in each but the last.
    Of(u64),
    /// For threads that fly a shard together: as many runs as take them a second or more.
    #[default]
    ForThreads,
    /// For workers that fly a shard each: the same, but small campaigns are cut finer, so that nobody waits long for
    /// the last worker.
    ForWorkers,
}

impl Shards {
    /// Runs of each shard but the last.
    fn runs(self, runs: u64, side_by_side: bool, there: Option<u64>) -> u64 {
        let usual = if side_by_side { SHARD_RUNS } else { SLOW_SHARD_RUNS };
        match self {
            Self::Of(asked) => asked,
            Self::ForThreads => there.unwrap_or(usual),
            Self::ForWorkers => there.unwrap_or_else(|| {
                let least = usual / FINEST;
                (runs / WORKERS_SHARDS).next_multiple_of(least).clamp(least, usual)
            }),
        }
    }
}

/// Into how many shards a campaign for workers is cut if its shards do not get too small.
const WORKERS_SHARDS: u64 = 64;
/// How much smaller they may get than those for threads: with 512 runs, a worker of Ray is as fast as with 8192
/// (docs/measurements.md, Python).
const FINEST: u64 = 16;

/// Plans a campaign in a folder; nothing is written yet.
///
/// # Errors
/// A scenario that is wrong, or wrong with what its dispersions draw; numbers that are not allowed.
pub fn plan(question: &Question<'_>, folder: &Folder) -> Result<Campaign, CampaignError> {
    RUNS.check(question.runs)?;
    let text = read_text(question.scenario)?;
    let path = question.scenario.display().to_string();
    let home = question.scenario.parent().unwrap_or(Path::new(""));
    let extra = Extra { overrides: question.overrides, ..Extra::default() };
    let template = Template::parse(&text, &path, Some(home), &extra)
        .map_err(|problems| CampaignError::Unreadable(LoadError::Problems(problems)))?;
    // Flights side by side are some hundred times as fast as six degrees of freedom.
    let side_by_side = template.study().scenario.flies_side_by_side()
        && template.study().scenario.externals.is_empty();
    let there = folder.plan().ok().map(|plan| plan.shard_runs);
    let shard_runs = question.shards.runs(question.runs, side_by_side, there);
    counts::SHARD_RUNS.check(shard_runs)?;
    let plan = Plan {
        scenario_digest: template.study().digest.clone(),
        scenario_text: text,
        scenario_path: path,
        scenario_folder: way(folder.path(), home),
        overrides: question.overrides.to_vec(),
        sampling: question.sampling,
        runs: question.runs,
        seed: question.seed,
        shard_runs,
        program: Plan::this_program(),
    };
    Campaign::of_template(plan, template)
}

/// The way from a folder that may not be there yet to one that is; absolute where there is none.
fn way(from: &Path, to: &Path) -> PathBuf {
    let absolute = |path: &Path| {
        std::path::absolute(if path == Path::new("") { Path::new(".") } else { path })
    };
    let (Ok(from), Ok(to)) = (absolute(from), absolute(to)) else {
        return to.to_owned();
    };
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (from.components().collect(), to.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = from.iter().skip(shared).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to.into_iter().skip(shared)).collect();
    if way == Path::new("") { PathBuf::from(".") } else { way }
}
