//! Many flights of a dispersed scenario: planned, flown in parts, merged.

use std::path::PathBuf;
use std::sync::Arc;

use fspid::campaign::report;
use fspid::campaign::sample::Sampling;
use fspid::campaign::shard::{self, Done};
use fspid::campaign::summary::{self, Summary, SummaryError, SummarySettings};
use fspid::campaign::table::{Reader, TableError};
use fspid::campaign::{self, CampaignError, Folder, Progress, Question, Shards, local, merge};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::origin::Origin;
use crate::scenario::Scenario;
use crate::table::Table;
use crate::{error, interrupt};

/// A campaign that is planned in a folder.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Campaign {
    folder: Folder,
    campaign: Arc<campaign::Campaign>,
    progress: Arc<Progress>,
    /// What it is drawn from.
    origin: Origin,
}

impl Campaign {
    fn new(folder: Folder, campaign: campaign::Campaign, origin: &Origin) -> Self {
        let plan = campaign.plan();
        let named = folder.path().join(&plan.scenario_folder);
        let files = campaign.template().study().files.iter().map(|file| named.join(file));
        let origin = origin.with(files);
        Self { folder, campaign: Arc::new(campaign), progress: Arc::default(), origin }
    }
}

fn sampling(py: Python<'_>, name: &str) -> PyResult<Sampling> {
    match name {
        "random" => Ok(Sampling::Random),
        "latin-hypercube" => Ok(Sampling::LatinHypercube),
        "sobol" => Ok(Sampling::Sobol),
        _ => {
            let allowed = "random, latin-hypercube or sobol";
            Err(error::input(py, format_args!("sampling is `{name}`; allowed is {allowed}")))
        }
    }
}

#[pymethods]
impl Campaign {
    /// Plans a campaign in a folder, or finds it there; it is cut into shards of so many runs, or for workers or threads.
    #[staticmethod]
    fn plan(
        py: Python<'_>,
        scenario: &Scenario,
        out: PathBuf,
        runs: u64,
        seed: u64,
        sampling: &str,
        cut: (Option<u64>, bool),
    ) -> PyResult<Self> {
        let (path, sampling) = (scenario.file(py)?, self::sampling(py, sampling)?);
        let overrides = scenario.overrides();
        let folder = Folder::new(&out);
        let (shard_runs, for_workers) = cut;
        let cut = if for_workers { Shards::ForWorkers } else { Shards::ForThreads };
        let shards = shard_runs.map_or(cut, Shards::Of);
        let question = Question { scenario: &path, overrides, runs, seed, sampling, shards };
        let origin = scenario.made_of();
        let planned = py.detach(|| {
            let _protected = origin.protected();
            let planned = campaign::plan(&question, &folder)?;
            folder.put_plan(planned.plan())?;
            Ok(planned)
        });
        let planned = planned.map_err(|found: CampaignError| error::campaign(py, &found))?;
        Ok(Self::new(folder, planned, &origin))
    }

    /// The campaign that is planned in a folder.
    #[staticmethod]
    fn planned(py: Python<'_>, out: PathBuf) -> PyResult<Self> {
        let folder = Folder::new(&out);
        let planned = py.detach(|| campaign::Campaign::new(folder.plan()?, folder.path()));
        let planned = planned.map_err(|found| error::campaign(py, &found))?;
        Ok(Self::new(folder, planned, &Origin::default()))
    }

    /// How many runs it has.
    #[getter]
    fn runs(&self) -> u64 {
        self.campaign.plan().runs
    }

    /// How many shards it has.
    #[getter]
    fn shards(&self) -> u64 {
        self.campaign.plan().shards()
    }

    /// What tells it from every other campaign.
    #[getter]
    fn id(&self) -> String {
        self.campaign.plan().id()
    }

    /// Runs that are flown, that were there, and flights that failed, so far.
    #[getter]
    fn progress(&self) -> (u64, u64, u64) {
        (self.progress.flown(), self.progress.found(), self.progress.failed())
    }

    /// Where the rows of all runs lie once it is merged.
    #[getter]
    fn file(&self) -> PathBuf {
        self.folder.merged_path()
    }

    /// Flies what is missing and merges it; the digest of all rows.
    fn run(&self, py: Python<'_>, threads: usize) -> PyResult<String> {
        let (folder, campaign) = (self.folder.clone(), Arc::clone(&self.campaign));
        let (progress, origin) = (Arc::clone(&self.progress), self.origin.clone());
        let flown = interrupt::run_until(
            py,
            || self.progress.stop(),
            move || {
                let _protected = origin.protected();
                local::run(&folder, &campaign, threads, &progress)
            },
        )?;
        let flown = flown.map_err(|found| error::campaign(py, &found))?;
        Ok(flown.digest.to_string())
    }

    /// Flies one shard unless it is there; true where it was flown now.
    fn shard(&self, py: Python<'_>, number: u64, threads: usize) -> PyResult<bool> {
        let (folder, campaign) = (self.folder.clone(), Arc::clone(&self.campaign));
        let (progress, origin) = (Arc::clone(&self.progress), self.origin.clone());
        let done = interrupt::run_until(
            py,
            || self.progress.stop(),
            move || {
                let _protected = origin.protected();
                let plan = campaign.plan();
                let most = plan.shards().saturating_sub(1);
                let range =
                    plan.shard(number).ok_or(CampaignError::NoShard { found: number, most })?;
                let _shared = folder.lock(false)?;
                let _alone = folder.lock_shard(range)?;
                local::in_threads(threads, || shard::fly(&folder, &campaign, number, &progress))?
            },
        )?;
        let done: Result<Done, CampaignError> = done;
        done.map(|done| done == Done::Flown).map_err(|found| error::campaign(py, &found))
    }

    /// Shards whose parts are not there, or not whole.
    fn missing(&self, py: Python<'_>) -> PyResult<Vec<u64>> {
        let (folder, campaign) = (self.folder.clone(), Arc::clone(&self.campaign));
        interrupt::run(py, move || shard::missing(&folder, &campaign))
    }

    /// Takes in the part of a shard that was flown elsewhere.
    fn put(&self, py: Python<'_>, number: u64, part: &[u8]) -> PyResult<()> {
        let put = py.detach(|| {
            let _protected = self.origin.protected();
            let _lock = self.folder.lock(false)?;
            shard::put(&self.folder, &self.campaign, number, part)
        });
        put.map_err(|found: CampaignError| error::campaign(py, &found))
    }

    /// Where the part of a shard lies once it is flown.
    fn part(&self, py: Python<'_>, number: u64) -> PyResult<PathBuf> {
        let plan = self.campaign.plan();
        let most = plan.shards().saturating_sub(1);
        let none = || error::campaign(py, &CampaignError::NoShard { found: number, most });
        plan.shard(number).map(|range| self.folder.shard_path(range)).ok_or_else(none)
    }

    /// The plan, as its file has it.
    #[getter]
    fn plan_text(&self) -> String {
        format!("{:#}\n", self.campaign.plan().json())
    }

    /// From where the scenario names files.
    #[getter]
    fn scenario_folder(&self) -> PathBuf {
        self.folder.path().join(&self.campaign.plan().scenario_folder)
    }

    /// Files that the scenario names, as it names them.
    #[getter]
    fn files(&self) -> Vec<String> {
        self.campaign.template().study().files.clone()
    }

    /// Merges all shards; the digest of all rows.
    fn merge(&self, py: Python<'_>) -> PyResult<String> {
        let (folder, campaign) = (self.folder.clone(), Arc::clone(&self.campaign));
        let origin = self.origin.clone();
        let digest = interrupt::run(py, move || {
            let _protected = origin.protected();
            let _lock = folder.lock(true)?;
            merge(&folder, &campaign, &folder.merged_path())
        })?;
        digest.map(|digest| digest.to_string()).map_err(|found| error::campaign(py, &found))
    }

    /// All rows of the merged file.
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        let path = self.folder.merged_path();
        let read = interrupt::run(py, move || {
            let mut batches = Vec::new();
            for rows in Reader::open(&path)?.tables() {
                batches.push(rows?);
            }
            Ok(batches)
        })?;
        let rows = read.map_err(|found: TableError| error::input(py, found))?;
        Table::of_rows(self.campaign.rows().schema(), rows).map_err(|it| error::input(py, it))
    }

    /// How often it failed, and by how much, with a report: of the merged file, or of the parts where there is none.
    fn summary(&self, py: Python<'_>, confidence: f64, incomplete: bool) -> PyResult<Answer> {
        let path = self.folder.path().to_owned();
        let settings = SummarySettings { confidence, incomplete, ..SummarySettings::default() };
        let answer = interrupt::run(py, move || {
            let summary = Summary::of(&path, settings)?;
            let folder = Some(path.display().to_string());
            let page_settings = report::Settings { summary: settings, folder };
            let page = report::page_of(&path, &summary, &page_settings)?;
            let answer = Answer::new(summary::text(&summary), &summary::json(&summary), true);
            Ok::<_, SummaryError>(answer.with_page(page))
        })?;
        let answer = answer.map_err(|found| error::input(py, found))?;
        let own = [self.folder.plan_path(), self.folder.merged_path()];
        let parts = self.folder.parts().unwrap_or_default();
        Ok(answer.from(self.origin.with(own.into_iter().chain(parts))))
    }
}
